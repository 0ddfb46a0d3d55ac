"""What several commands share: the project they work in, where reports go, exit statuses."""

from __future__ import annotations

import argparse
import os
import sys
import typing
from pathlib import Path

from dbcspec.config import find_config
from dbcspec.emit.foreign import refuse_unwritable
from dbcspec.errors import FindingsError
from dbcspec.lint.options import FOREIGN
from dbcspec.project import Project, load
from dbcspec.read.doors import open_side
from typedcan.model.checksums.registry import Given
from typedcan.model.protocol import Protocol
from typedcan.model.seal import seals_of
from typedcan.report.formats import FORMATS, render
from typedcan.report.item import Report
from typedcan.shell.algorithms import algorithms_of
from typedcan.shell.console import note, say_text
from typedcan.shell.files import put_in_place


class Commands(typing.Protocol):
    """The part of argparse's subparsers that commands need."""

    def add_parser(self, name: str, *, help: str, description: str) -> argparse.ArgumentParser:
        """Declare a command."""
        ...


def project_option(parser: argparse.ArgumentParser) -> None:
    """Declare -C."""
    parser.add_argument(
        "-C", "--project", type=Path, default=Path(), help="folder to work in (default: this)"
    )


def report_options(parser: argparse.ArgumentParser) -> None:
    """Declare --format, --json and --output."""
    parser.add_argument("--format", choices=tuple(FORMATS), default="text", help="(default: text)")
    parser.add_argument(
        "--json", dest="format", action="store_const", const="json", help="as --format json"
    )
    parser.add_argument("-o", "--output", type=Path, help="write the report here, not to stdout")


def choice_options(parser: argparse.ArgumentParser) -> None:
    """Declare --edition and --reading."""
    parser.add_argument("--edition", metavar="NAME", help="an edition that the spec has")
    parser.add_argument(
        "--reading",
        metavar="ID",
        action="append",
        default=[],
        help="a reading that the spec lists beside its usual one; may be repeated",
    )


def choice_text(options: argparse.Namespace) -> str:
    """What --edition and --reading choose, as ``v4.6+E50b``; "" for the usual readings."""
    return "+".join(filter(None, (options.edition, *options.reading)))


def load_project(options: argparse.Namespace, choice: str = "") -> Project:
    """The project that -C names, in an edition and readings."""
    return load(find_config(options.project.resolve()), choice)


def given_algorithms(options: argparse.Namespace, protocol: Protocol) -> Given:
    """What --algorithm says; raises `AlgorithmError` where the protocol has none of a name."""
    given = algorithms_of(options)
    if given:
        seals_of(protocol.messages, given)
    return given


def load_sound_project(options: argparse.Namespace, choice: str = "") -> Project:
    """The project, if the linter has nothing against it; raises as `sound`."""
    return sound(options, load_project(options, choice))


def sound(options: argparse.Namespace, project: Project) -> Project:
    """The project, if the linter has nothing against it; raises `FindingsError`.

    A spec of the profile foreign, as `dbcspec import` makes it, may have what its file has: that is
    noted, as long as a DBC can say it; else raises `ReadError`.
    """
    every = project.findings(given_algorithms(options, project.protocol))
    findings = [each for each in every if each.level != "note"]
    if findings and project.spec.standard.profile != FOREIGN:
        raise FindingsError(findings)
    if findings:
        note(f"{len(findings)} findings: dbcspec lint names them")
        refuse_unwritable(project.protocol)
    return project


def print_report(options: argparse.Namespace, report: Report) -> None:
    """Write a report where the options say, whole or not at all."""
    if options.output:
        text = render(report, options.format)
        put_in_place({options.output: text.encode("utf-8")})
        return
    colour = sys.stdout.isatty() and "NO_COLOR" not in os.environ
    encoding = (sys.stdout.encoding or "ascii").lower().replace("-", "")
    text = render(report, options.format, colour=colour, ascii_only=not encoding.startswith("utf"))
    say_text(text, coloured=colour)


def source_protocol(options: argparse.Namespace) -> Protocol:
    """The protocol of the file that the options name, else the project's."""
    if options.source:
        return open_side(options.source, encoding=options.encoding).protocol
    return load_project(options).protocol
