"""`dbcspec compare`: what changed between two protocols, and whom it breaks."""

from __future__ import annotations

import argparse
from pathlib import Path

from dbcspec.commands import HELP
from dbcspec.commands.common import Commands, print_report, report_options
from dbcspec.compare.approvals import APPROVAL_USED, apply_approvals, read_approvals
from dbcspec.compare.pairing import pair
from dbcspec.compare.promise import Class
from dbcspec.compare.run import RULES, findings, worst
from dbcspec.read.doors import open_side
from typedcan.report.item import LEVELS, Report

_BY_PLACE = (
    "Most names differ: signals are matched by their bits, alike changes summed up (--no-by-place)."
)


def add(commands: Commands) -> None:
    """Declare the command."""
    text = HELP["compare"]
    parser = commands.add_parser("compare", help=text, description=f"{text.capitalize()}.")
    parser.set_defaults(run=_compare)
    side = "a spec folder, DBC, matrix (.xlsx), KCD, SYM or ARXML, or REVISION:PATH of git"
    parser.add_argument("old", metavar="OLD", help=side)
    parser.add_argument("new", metavar="NEW", help="the same")
    parser.add_argument(
        "--fail-on",
        choices=tuple(each.word for each in reversed(Class)),
        default=Class.COSMETIC.word,
        help="exit 1 from this class on (default: cosmetic, so on any change)",
    )
    parser.add_argument(
        "--by-place",
        action=argparse.BooleanOptionalAction,
        help="match signals by their bits before their names (default: where most names differ)",
    )
    parser.add_argument("--approvals", type=Path, help="TOML file of accepted findings")
    parser.add_argument("--encoding", help="of text files, where it is not to be found out")
    report_options(parser)


def _compare(options: argparse.Namespace) -> int:
    old = open_side(options.old, encoding=options.encoding)
    new = open_side(options.new, encoding=options.encoding)
    pairing = pair(old.protocol, new.protocol, by_place=options.by_place)
    items = findings(pairing)
    if options.approvals:
        items = apply_approvals(items, read_approvals(options.approvals))
    title = f"{options.old} → {options.new}"
    notes = [_BY_PLACE] if pairing.by_place and options.by_place is None else []
    report = Report(title=title, items=items, rules=(*RULES, APPROVAL_USED), notes=notes)
    print_report(options, report)
    gravest = worst(items)
    return 1 if gravest and LEVELS.index(gravest) <= LEVELS.index(options.fail_on) else 0
