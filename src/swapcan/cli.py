"""The `swapcan` command line: its commands and examples."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from swapcan.commands import HELP
from typedcan.shell import command_line
from typedcan.shell.command_line import Parser, Program, Subcommands

_FOR_ANY_PROTOCOL = ("convert", "decode", "listen", "monitor", "plot", "send")

_EXAMPLES = """examples:
  swapcan demo                                        a pack and a truck on a virtual bus
  swapcan decode drive.blf                            the messages in a log
  swapcan convert drive.blf -o drive.parquet          hours of a log as columns
  swapcan plot drive.blf --signals SOC -o soc.html    signals and cells over time
  swapcan conform drive.blf                           does it keep to the standard?
  swapcan listen -i socketcan -c can0                 the messages on a bus
  swapcan monitor -i socketcan -c can0                the same, as a view
  swapcan send B2V_ST2 soc=80 -i socketcan -c can0    one message onto a bus
  swapcan simulate BMU CHG -i socketcan -c can0       a pack and a charger that behave

exit status: 0 all is well, 1 the demo missed something or a log does not conform, 2 the command
could not do its work, 3 a log is damaged: what could be read was used"""


def run(arguments: Sequence[str]) -> int:
    """Run the command line with its arguments and return the exit status."""
    return command_line.run(PROGRAM, arguments)


def _add(commands: Subcommands[Parser], name: str) -> None:
    if name in _FOR_ANY_PROTOCOL:
        from swapcan.commands.tool import TOOL

        import_module(f"typedcan.commands.{name}").command(TOOL).add(commands)
    else:
        import_module(f"swapcan.commands.{name}").COMMAND.add(commands)


PROGRAM = Program(
    name="swapcan",
    description="The CAN protocol of battery-swap heavy trucks: watch it, decode it, send it.",
    epilog=_EXAMPLES,
    commands=HELP,
    add=_add,
)
