"""`swapcan send`: one message onto a bus."""

from __future__ import annotations

import argparse

from swapcan.commands import HELP
from swapcan.commands.bus_options import add_bus_options, is_virtual, open_bus
from swapcan.commands.driving import add_consent
from swapcan.commands.transcript import values_text
from swapcan.commands.values import message_named, message_of
from swapcan.drive.driving import LOOK_OUT, Driving
from swapcan.drive.noting_bus import NotingBus
from swapcan.wire import Link, decode, encode
from typedcan.shell.command_line import Command
from typedcan.shell.console import CommandError, note, say
from typedcan.wire.acting import what_acts
from typedcan.wire.clock import SystemClock

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
    add_consent(
        parser,
        "send it also where it makes its receiver act: contactors close, chargers start; not needed"
        " on the virtual interface",
    )
    add_bus_options(parser)


def _run(options: argparse.Namespace) -> int:
    message = message_of(message_named(options.message), options.fields)
    encode(message)  # refuses a wrong value before a bus is opened
    acting = what_acts(message)
    virtual = bool(acting) and is_virtual(options)
    looks_out = bool(acting) and not virtual
    if looks_out and not options.yes_drive_the_bus:
        raise CommandError(
            f"{message.NAME} {', '.join(acting)} makes its receiver act:"
            " not sent without --yes-drive-the-bus"
        )
    with open_bus(options, virtual=virtual) as bus:
        if looks_out:
            note(f"looking for another {message.SENDER} for {LOOK_OUT:g} s")
            with NotingBus(bus, lambda _: None, played=[message.FRAME_ID]) as noting:
                Driving([noting], clock=SystemClock()).look_out()
        frame = Link(bus).send(message, timeout=_TIMEOUT)
    sent = decode(frame.arbitration_id, bytes(frame.data))
    data = frame.data.hex(" ").upper()
    say("  ".join((f"0x{frame.arbitration_id:08X}", f"[{data}]", sent.NAME, *values_text(sent))))
    return 0


COMMAND = Command(
    name="send",
    help=HELP["send"],
    examples="""  swapcan send B2V_ST2 soc=80 current=-120.5 -i socketcan -c can0
  swapcan send B2V_ST1 'bms=HV closed' -i pcan -c PCAN_USBBUS1 -b 250000
  swapcan send V2B_CMD V2B_CMD_HV_OnOff=hv_off -i udp_multicast -c 239.74.163.2
  swapcan send V2B_CMD hv_on_off=hv_on -i socketcan -c can0 --yes-drive-the-bus

A code that closes contactors, charges, heats, cools or pumps is not sent without the last option,
and not where somebody else sends that message within two seconds. Nothing ends it here: it holds
until its receiver's own timeout, which the standard does not give, or the next message. Switching
high voltage off at speed opens contactors under load.""",
    add_arguments=_add_arguments,
    run=_run,
)
