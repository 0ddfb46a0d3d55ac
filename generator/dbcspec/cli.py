"""The `dbcspec` command line: its commands and examples, and its own errors."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from dbcspec.commands import HELP, MODULES
from dbcspec.errors import FindingsError, SpecError, StaleArtifactError
from typedcan.shell import command_line
from typedcan.shell.command_line import Parser, Program, Subcommands
from typedcan.shell.console import note
from typedcan.shell.printing import print_remark

_EXAMPLES = """examples:
  dbcspec generate                       write the DBC files, stubs and schemas of the spec
  dbcspec check                          in CI: exit 1 where a generated file is not current
  dbcspec lint supplier.dbc              faults in a file, whoever wrote it
  dbcspec explain signals-overlap        what a rule looks for, with an example
  dbcspec compare spec dbc/vehicle.dbc   does the DBC say what the spec says
  dbcspec compare HEAD~3:spec spec --fail-on wire --format markdown
  dbcspec matrix export                  the Excel CAN matrix
  dbcspec load --groups 18               bus load and worst-case response times
  dbcspec show ECU1_Status               one message: bits, signals, codes, errata

exit status: 0 all is well, 1 findings or stale files, 2 the command could not do its work"""


def run(arguments: Sequence[str]) -> int:
    """Run the command line with its arguments and return the exit status."""
    return command_line.run(PROGRAM, arguments, _failed)


def _failed(error: Exception) -> int | None:
    if isinstance(error, FindingsError | StaleArtifactError | SpecError):
        for line in error.lines:
            print_remark(line)
        return 2 if isinstance(error, SpecError) else 1
    if isinstance(error, ModuleNotFoundError) and error.name in (
        "yaml",
        "jinja2",
        "openpyxl",
        "pint",
    ):
        note(f"{error.name} is not installed; pip install 'swapcan[generator]' brings it")
        return 2
    return None


def _add(commands: Subcommands[Parser], name: str) -> None:
    import_module(f"dbcspec.commands.{MODULES[name]}").add(commands)


PROGRAM = Program(
    name="dbcspec",
    description="A CAN protocol as data: tables in YAML in, DBC files and Python stubs out.",
    epilog=_EXAMPLES,
    commands=HELP,
    add=_add,
)
