"""`dbcspec explain`: what a rule looks for, and an example of what it finds."""

from __future__ import annotations

import argparse
import inspect
import re
from collections.abc import Iterator
from difflib import get_close_matches
from itertools import chain
from pathlib import Path

import dbcspec.lint
from dbcspec.commands import HELP
from dbcspec.commands.common import Commands
from dbcspec.compare.run import RULES as PROMISES
from dbcspec.lint.registry import ALL_RULES
from dbcspec.lint.rule import Rule
from typedcan.model.errors import ReadError
from typedcan.report.item import RuleInfo
from typedcan.report.texts import MEANINGS
from typedcan.shell.console import say_text

_ABOUT = 3
"""Lines of a file that are shown before and after the one that a finding names."""

_EXAMPLES = 3
"""Findings of a case that are shown."""

_FINDING = re.compile(r"(?P<path>.+?):(?P<line>\d+):(?P<column>\d+): ")


def add(commands: Commands) -> None:
    """Declare the command."""
    text = HELP["explain"]
    explain = commands.add_parser("explain", help=text, description=f"{text.capitalize()}.")
    explain.set_defaults(run=_explain)
    explain.add_argument("rule", metavar="RULE", help="the id of a rule or of a promise")


def _explain(options: argparse.Namespace) -> int:
    rules = {rule.id: rule for rule in ALL_RULES}
    promises = {promise.id: promise for promise in PROMISES}
    if options.rule in rules:
        lines = _rule(rules[options.rule])
    elif options.rule in promises:
        lines = _promise(promises[options.rule])
    else:
        close = get_close_matches(options.rule, chain(rules, promises), n=1)
        hint = f"did you mean {close[0]}?" if close else "`dbcspec rules` lists them"
        raise ReadError(f"there is no rule {options.rule!r}; {hint}")
    say_text("\n".join(lines) + "\n")
    return 0


def _promise(promise: RuleInfo) -> Iterator[str]:
    yield f"{promise.id}: {promise.purpose}"
    yield ""
    yield f"A promise of `dbcspec compare`, class {promise.level}: {MEANINGS[promise.level]}."


def _rule(rule: Rule) -> Iterator[str]:
    yield f"{rule.id}: {rule.purpose}"
    yield ""
    profiles = "house and foreign" if rule.foreign else "house"
    unasked = "" if rule.default else "; it runs only where it is selected"
    yield f"Level {rule.level}: {MEANINGS[rule.level]}. Profile {profiles}{unasked}."
    told = (inspect.getmodule(rule.check).__doc__ or "").partition("\n\n")[2].strip()
    if told:
        yield ""
        yield told
    folder = _cases() / rule.id
    try:
        found = (folder / "expected.txt").read_text("utf-8").splitlines()
    except OSError:
        return  # an installation that has left the examples out
    for line in found[:_EXAMPLES]:
        yield ""
        yield from _example(folder, line)


def _example(folder: Path, finding: str) -> Iterator[str]:
    """A finding of the case below the lines that it is about, the very one marked."""
    place = _FINDING.match(finding)
    if place is None:
        return
    number = int(place["line"])
    try:
        text = (folder / place["path"]).read_text("utf-8").splitlines()
    except OSError:
        text = []
    first = max(number - _ABOUT, 1)
    for at, line in enumerate(text[first - 1 : number + _ABOUT], start=first):
        yield f"  {'>' if at == number else ' '} {at:4} | {line}"
    yield f"  {finding}"


def _cases() -> Path:
    """The folder of the cases: beside the rules where installed, among the tests in a checkout."""
    lint = Path(dbcspec.lint.__path__[0])
    installed = lint / "cases"
    return installed if installed.is_dir() else lint.parents[2] / "tests" / "lint" / "cases"
