"""`swapcan send`: one message onto a bus."""

from __future__ import annotations

import argparse

from swapcan.bus import Link
from swapcan.codec import decode, encode
from swapcan.commands.bus_options import add_bus_options, open_bus
from swapcan.commands.transcript import values_text
from swapcan.commands.values import message_named, message_of
from swapcan.console import Command, say

_TIMEOUT = 1.0
"""Seconds for the bus to accept the frame."""


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("message", metavar="MESSAGE", help="such as B2V_ST2 or V2B_CMD")
    parser.add_argument(
        "fields",
        nargs="*",
        metavar="FIELD=VALUE",
        help="field or DBC signal; a number, label, character, 'invalid' or 'abnormal'",
    )
    add_bus_options(parser)


def _run(options: argparse.Namespace) -> int:
    message = message_of(message_named(options.message), options.fields)
    encode(message)  # refuses a wrong value before a bus is opened
    with open_bus(options) as bus:
        frame = Link(bus).send(message, timeout=_TIMEOUT)
    sent = decode(frame.arbitration_id, bytes(frame.data))
    data = frame.data.hex(" ").upper()
    say("  ".join((f"0x{frame.arbitration_id:08X}", f"[{data}]", sent.NAME, *values_text(sent))))
    return 0


COMMAND = Command(
    name="send",
    help="send one message; what is not given goes out as invalid, or 0 if that commands nothing",
    examples="""  swapcan send B2V_ST2 soc=80 current=-120.5 -i socketcan -c can0
  swapcan send B2V_ST1 'bms=HV closed' -i pcan -c PCAN_USBBUS1 -b 250000
  swapcan send V2B_CMD V2B_CMD_HV_OnOff=hv_on -i udp_multicast -c 239.74.163.2""",
    add_arguments=_add_arguments,
    run=_run,
)
