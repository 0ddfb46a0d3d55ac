"""The `dbcspec` command line: generate, check, lint, show, rules."""

from __future__ import annotations

import argparse
import io
import json
import os
import sys
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path

from dbcspec.artifacts import artifacts, verify, write
from dbcspec.config import find_config
from dbcspec.errors import FindingsError, ReadError, SpecError, StaleArtifactError
from dbcspec.lint.registry import ALL_RULES
from dbcspec.project import Project, load
from dbcspec.show import find_message, show

_EXAMPLES = """examples:
  dbcspec generate              write the DBC files, stubs and schemas that the spec makes
  dbcspec check                 in CI: exit 1 where a generated file is not current
  dbcspec lint --json           findings as JSON
  dbcspec show B2V_ST2          one message: bits, signals, codes, errata

exit status: 0 all is well, 1 findings or stale files, 2 the command could not do its work"""


def run(arguments: Sequence[str]) -> int:
    """Run the command line with its arguments and return the exit status."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a code page without Chinese shows ? instead
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        command: Callable[[argparse.Namespace], int] = options.run
        return command(options)
    except (FindingsError, StaleArtifactError) as error:
        print(error, file=sys.stderr)
        return 1
    except SpecError as error:
        print(error, file=sys.stderr)
        return 2
    except ReadError as error:
        print(f"dbcspec: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # The reader went away: leave quietly, and keep the interpreter from flushing into it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="dbcspec",
        description="A CAN protocol as data: tables in YAML in, DBC files and Python stubs out.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"dbcspec {version('swapcan')}")
    parser.add_argument(
        "--print-completion",
        choices=("bash", "zsh", "tcsh"),
        help="print a completion script for a shell",
    )
    parser.set_defaults(run=lambda options: _no_command(parser, options.print_completion))
    commands = parser.add_subparsers(title="commands", metavar="")
    for name, function, text in (
        ("generate", _generate, "write all generated files"),
        ("check", _check, "exit 1 and name each generated file that is not current"),
        ("lint", _lint, "find faults in the spec"),
        ("rules", _rules, "list the lint rules"),
        ("show", _show, "show one message in the terminal"),
    ):
        command = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
        command.set_defaults(run=function)
        command.add_argument(
            "-C", "--project", type=Path, default=Path(), help="folder to work in (default: this)"
        )
        if name == "show":
            command.add_argument("name", metavar="MESSAGE", help="a message, or one of its signals")
        else:
            command.add_argument("--json", action="store_true", help="print JSON")
    return parser


def _load(options: argparse.Namespace) -> Project:
    return load(find_config(options.project.resolve()))


def _load_sound(options: argparse.Namespace) -> Project:
    """The project, if the linter has nothing against it."""
    project = _load(options)
    if findings := project.findings():
        raise FindingsError(findings)
    return project


def _generate(options: argparse.Namespace) -> int:
    project = _load_sound(options)
    files = artifacts(project.protocol, project.config)
    changed = write(project.config.root, files)
    protocol = project.protocol
    counts = {
        "messages": len(protocol.messages),
        "signals": sum(1 for _ in protocol.signals()),
        "value_tables": len(protocol.value_tables),
        "errata": len(protocol.errata),
    }
    if options.json:
        print(json.dumps({**counts, "digest": protocol.digest, "changed": changed}))
        return 0
    print(
        f"{protocol.name}: {counts['messages']} messages, {counts['signals']} signals,"
        f" {counts['value_tables']} value tables, {counts['errata']} errata applied,"
        f" digest {protocol.digest}"
    )
    for name in changed:
        print(f"wrote {name}")
    print(f"{len(files) - len(changed)} of {len(files)} files were current")
    return 0


def _check(options: argparse.Namespace) -> int:
    project = _load_sound(options)
    files = artifacts(project.protocol, project.config)
    stale = verify(project.config.root, files, project.protocol, project.config)
    if options.json:
        print(
            json.dumps(
                [{"path": each.path, "why": each.why, "diff": list(each.diff)} for each in stale],
                ensure_ascii=False,
            )
        )
        return 1 if stale else 0
    if stale:
        raise StaleArtifactError(
            "\n    ".join((f"{each.path}: {each.why}", *each.diff)) for each in stale
        )
    print(f"{len(files)} files are current, digest {project.protocol.digest}")
    return 0


def _lint(options: argparse.Namespace) -> int:
    findings = _load(options).findings()
    if options.json:
        print(
            json.dumps(
                [
                    {
                        "rule": finding.rule,
                        "path": finding.where.path,
                        "line": finding.where.line,
                        "column": finding.where.column,
                        "subject": finding.subject,
                        "text": finding.text,
                    }
                    for finding in findings
                ],
                ensure_ascii=False,
            )
        )
    else:
        for finding in findings:
            print(finding)
        print(f"{len(findings)} findings", file=sys.stderr)
    return 1 if findings else 0


def _rules(options: argparse.Namespace) -> int:
    if options.json:
        print(json.dumps([{"id": rule.id, "purpose": rule.purpose} for rule in ALL_RULES]))
        return 0
    width = max(len(rule.id) for rule in ALL_RULES)
    for rule in ALL_RULES:
        print(f"{rule.id:<{width}}  {rule.purpose}")
    return 0


def _show(options: argparse.Namespace) -> int:
    project = _load(options)
    print(show(project.protocol, find_message(project.protocol, options.name)), end="")
    return 0


def _no_command(parser: argparse.ArgumentParser, shell: str | None) -> int:
    """Print a completion script, or help where none is asked for either."""
    if shell is None:
        parser.print_help(sys.stderr)
        return 2
    try:
        import shtab
    except ModuleNotFoundError:
        raise ReadError("completion needs shtab: pip install 'swapcan[completion]'") from None
    print(shtab.complete(parser, shell))
    return 0
