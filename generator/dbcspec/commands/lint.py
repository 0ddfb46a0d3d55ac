"""`dbcspec lint` and `rules`: faults in a spec, a DBC or a matrix, and what is looked for."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

from dbcspec.commands import HELP
from dbcspec.commands.common import (
    Commands,
    choice_options,
    choice_text,
    given_algorithms,
    load_project,
    print_report,
    project_option,
    report_options,
)
from dbcspec.compare.run import RULES as PROMISES
from dbcspec.config import find_config, read_lint_config, selected
from dbcspec.fix import fix_bytes, raw_text
from dbcspec.lint.items import rule_infos, to_items
from dbcspec.lint.options import FOREIGN, HOUSE, Options
from dbcspec.lint.rule import Subject
from dbcspec.lint.run import lint_with
from dbcspec.lint.waiver_used import RULE as WAIVER_USED
from dbcspec.read.doors import MATRIX, open_side
from dbcspec.spec.rows import Spec
from typedcan.databases.encoding import read_encoded
from typedcan.model.errors import ReadError
from typedcan.report.item import LINT_LEVELS, Report
from typedcan.report.rules import print_rules
from typedcan.shell.algorithms import add_algorithm_option
from typedcan.shell.console import say_text
from typedcan.shell.files import put_in_place
from typedcan.shell.printing import print_remark


def add(commands: Commands) -> None:
    """Declare both commands."""
    text = HELP["lint"]
    lint = commands.add_parser("lint", help=text, description=f"{text.capitalize()}.")
    lint.set_defaults(run=_lint)
    project_option(lint)
    lint.add_argument("target", nargs="?", help="what to lint (default: the project's spec)")
    lint.add_argument("--config", type=Path, help="TOML file with select, ignore and waivers")
    lint.add_argument(
        "--select", metavar="RULES", help="rules to run, with commas between; ALL, DEFAULT"
    )
    lint.add_argument(
        "--profile",
        choices=(HOUSE, FOREIGN),
        help="house: what we ask of our own files; foreign: what is wrong in anybody's (default: "
        "foreign for files that are not a project's)",
    )
    lint.add_argument(
        "--fail-on",
        choices=LINT_LEVELS,
        default="warning",
        help="exit 1 from this level on (default: warning)",
    )
    lint.add_argument("--encoding", help="of TARGET, where it is not to be found out")
    lint.add_argument("--fix", action="store_true", help="mend a DBC file where that is certain")
    choice_options(lint)
    add_algorithm_option(lint)
    report_options(lint)

    text = HELP["rules"]
    rules = commands.add_parser("rules", help=text, description=f"{text.capitalize()}.")
    rules.set_defaults(run=_rules)
    rules.add_argument("--format", choices=("text", "json", "markdown"), default="text")
    rules.add_argument("--json", dest="format", action="store_const", const="json")


def _lint(options: argparse.Namespace) -> int:
    if options.fix:
        _fix(options)
    if options.target:
        side = open_side(options.target, encoding=options.encoding, wide=True)
        found = _usual(Path(options.target), side.spec)
        subject = Subject(
            protocol=side.protocol,
            spec=side.spec,
            errata_faults=side.errata_faults,
            dbc_text=_dbc_text(Path(options.target), options.encoding),
            source=options.target,
            algorithms=given_algorithms(options, side.protocol),
        )
        title = options.target
    else:
        project = load_project(options, choice_text(options))
        found = project.lint
        subject = project.subject(given_algorithms(options, project.protocol))
        title = project.config.spec
    if options.config:
        found = read_lint_config(options.config)
    if options.profile:
        found = found.under(options.profile)
    if options.select:
        found = selected(found, options.select.split(","))
    items = to_items(lint_with(subject, found))
    print_report(options, Report(title=title, items=items, rules=rule_infos()))
    failing = LINT_LEVELS[: LINT_LEVELS.index(options.fail_on) + 1]
    return 1 if any(item.level in failing for item in items) else 0


def _usual(target: Path, spec: Spec | None) -> Options:
    """What is asked of a file unless the user says: of what a project generates, what it asks."""
    if spec:
        return Options().of_spec(spec.standard.profile)
    if target.suffix.lower() == MATRIX:
        return Options()
    try:
        config = find_config(target.resolve().parent)
    except (OSError, ReadError):
        return Options().under(FOREIGN)
    if not target.resolve().is_relative_to((config.root / config.dbc).resolve()):
        return Options().under(FOREIGN)
    # Most of the waivers are for the spec.
    return dataclasses.replace(config.lint, ignore=(*config.lint.ignore, WAIVER_USED.id))


def _dbc_text(path: Path, encoding: str | None) -> str | None:
    """The text of a DBC file on disk, breaks as they are; None for anything else."""
    return raw_text(*read_encoded(path, encoding)) if _is_dbc(path) else None


def _is_dbc(path: Path) -> bool:
    return path.suffix.lower() == ".dbc" and path.is_file()


def _fix(options: argparse.Namespace) -> None:
    """Mend the target file in place, and say on stderr what was done."""
    path = Path(options.target or "")
    if not _is_dbc(path):
        raise ReadError("--fix mends a DBC file: name one")
    fixed, done = fix_bytes(*read_encoded(path, options.encoding))
    if done:
        put_in_place({path: fixed})
    for each in done:
        print_remark(f"{path}: {each}")


def _rules(options: argparse.Namespace) -> int:
    say_text(print_rules([*rule_infos(), *PROMISES], options.format))
    return 0
