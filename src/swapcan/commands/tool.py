"""What this standard hands to the commands for any protocol: itself, and examples in its words."""

from __future__ import annotations

import argparse

from swapcan._generated.protocol import PROTOCOL
from swapcan.commands import HELP
from swapcan.wire import codec_for
from typedcan.commands.tool import Tool, chosen_model, reading_tables
from typedcan.monitor.glance import Glance
from typedcan.shell.algorithms import algorithms_of
from typedcan.wire.codec import Codec
from typedcan.wire.protocol import Protocol

_LOG_STATUS = "exit status: 0 all is well, 2 the command could not do its work, 3"

_EXAMPLES = {
    "decode": """  swapcan decode drive.blf
  swapcan decode drive.asc --json | jq -c '.signals.B2V_ST2_SOC // empty'""",
    "convert": f"""  swapcan convert drive.blf -o drive.parquet  # drive/B2V_ST2.parquet and more
  swapcan convert drive.blf -o st2.csv --messages B2V_ST2
  swapcan convert day-*.asc -o day.parquet --raster 100ms --signals SOC,Current
  swapcan convert drive.blf -o drive.mf4 --from 60 --to 120

{_LOG_STATUS} a log is damaged: what comes
before the damage is written, 130 interrupted: nothing is written""",
    "plot": f"""  swapcan plot drive.blf --signals SOC,Current -o drive.html
  swapcan plot drive.blf --cells --probes -o cells.html
  swapcan plot drive.blf --signals 'B2V_ST0_ST_*' --from 60 --to 120 -o relays.png

{_LOG_STATUS} the log is damaged: what can be
read of it is drawn""",
    "listen": """  swapcan listen -i socketcan -c can0
  swapcan listen -i pcan -c PCAN_USBBUS1 -b 250000 --json --seconds 10
  swapcan listen -i udp_multicast -c 239.74.163.2 --count 1""",
    "monitor": """  swapcan monitor -i socketcan -c can0
  swapcan monitor -i pcan -c PCAN_USBBUS1 -b 250000 --record drive.blf
  swapcan monitor -i socketcan -c can0 --plain --seconds 60 > watch.txt
  swapcan monitor -i udp_multicast -c 239.74.163.2 --json --interval 5""",
    "send": """  swapcan send B2V_ST2 soc=80 current=-120.5 -i socketcan -c can0
  swapcan send B2V_ST1 'bms=HV closed' -i pcan -c PCAN_USBBUS1 -b 250000
  swapcan send V2B_CMD V2B_CMD_HV_OnOff=hv_off -i udp_multicast -c 239.74.163.2
  swapcan send V2B_CMD hv_on_off=hv_on -i socketcan -c can0 --yes-drive-the-bus

A code that closes contactors, charges, heats, cools or pumps is not sent without the last option,
and not where somebody else sends that message within two seconds. Nothing ends it here: it holds
until its receiver's own timeout, which the standard does not give, or the next message. Switching
high voltage off at speed opens contactors under load.""",
}


def _glance(protocol: Protocol) -> Glance | None:
    from swapcan.glance.look import glance_of  # the monitor alone needs it

    return glance_of(protocol)


def codec_of(options: argparse.Namespace) -> Codec:
    """What speaks as the options say, with the classes of this standard.

    Raises `CommandError`, `ReadError` and `AlgorithmError` for what there is not.
    """
    chosen_model(PROTOCOL.model, options)
    return codec_for(options.edition or "", options.reading, algorithms_of(options))


TOOL = Tool(
    program="swapcan",
    own=lambda _: PROTOCOL,
    help=HELP,
    examples=_EXAMPLES,
    tables=reading_tables(PROTOCOL),
    glance=_glance,
)
"""The `swapcan` command line."""
