"""`dbcspec show` and `dbcspec textconv`: one message for people, a whole protocol for git diff."""

from __future__ import annotations

import argparse

from dbcspec.commands import HELP
from dbcspec.commands.common import Commands, project_option, source_protocol
from dbcspec.read.doors import open_side
from dbcspec.show import find_message, show
from dbcspec.textconv import textconv
from typedcan.shell.console import say_text


def add(commands: Commands) -> None:
    """Declare both commands."""
    text = HELP["show"]
    one = commands.add_parser("show", help=text, description=f"{text.capitalize()}.")
    one.set_defaults(run=_show)
    project_option(one)
    one.add_argument("name", metavar="MESSAGE", help="a message, or one of its signals")
    one.add_argument("--in", dest="source", help="a DBC, matrix or spec (default: the project)")
    one.add_argument("--encoding", help="of that file, where it is not to be found out")

    text = HELP["textconv"]
    whole = commands.add_parser("textconv", help=text, description=f"{text.capitalize()}.")
    whole.set_defaults(run=_textconv)
    whole.add_argument("source", metavar="FILE", help="a DBC, matrix or spec folder")
    whole.add_argument("--encoding", help="of FILE, where it is not to be found out")


def _show(options: argparse.Namespace) -> int:
    protocol = source_protocol(options)
    say_text(show(protocol, find_message(protocol, options.name)))
    return 0


def _textconv(options: argparse.Namespace) -> int:
    say_text(textconv(open_side(options.source, encoding=options.encoding).protocol))
    return 0
