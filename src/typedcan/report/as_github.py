"""Findings as workflow commands, which GitHub Actions shows beside the lines they are about."""

from __future__ import annotations

from typedcan.report.item import LEVELS, Item, Report
from typedcan.report.paths import slashed
from typedcan.report.texts import sentence
from typedcan.shell.printing import printable

COMMANDS = {
    "error": "error",
    "warning": "warning",
    "note": "notice",
    "wire": "error",
    "source": "warning",
    "additive": "notice",
    "cosmetic": "notice",
}
_LONGEST = 1000
_DATA = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_PROPERTY = _DATA | str.maketrans({":": "%3A", ",": "%2C"})


def to_github(report: Report) -> str:
    """A command a line, gravest first, for only the first few of each kind are shown."""
    items = sorted(report.items, key=lambda item: LEVELS.index(item.level))
    return "".join(f"{_command(item)}\n" for item in items)


def _command(item: Item) -> str:
    where = item.where
    place = {"file": slashed(where.path), "line": str(where.line), "col": str(where.column)}
    properties = {**(place if where.path else {}), "title": item.rule}
    written = ",".join(
        f"{key}={printable(value).translate(_PROPERTY)}" for key, value in properties.items()
    )
    return (
        f"::{COMMANDS[item.level]} {written}::{sentence(item, longest=_LONGEST).translate(_DATA)}"
    )
