"""Findings for a terminal."""

from __future__ import annotations

from collections.abc import Iterator

from typedcan.report.item import Item, Report
from typedcan.report.summary import has_summary, summary_lines
from typedcan.report.texts import WHOLE, broken, casualties, counted, grouped, named, told
from typedcan.shell.printing import printable

_STYLES = {
    "error": "1;31",
    "warning": "33",
    "note": "36",
    "wire": "1;31",
    "source": "33",
    "additive": "32",
    "cosmetic": "36",
}
_BOLD = "1"
_DIM = "2"
_LONGEST = 400
_WIDEST_LEVEL = 10


def to_text(report: Report, *, colour: bool = False, ascii_only: bool = False) -> str:
    """The findings message by message, their counts at the end.

    ``colour`` adds ANSI sequences; ``ascii_only`` makes arrows of ASCII, for terminals without
    an arrow. A long value is cut; the formats for machines have the whole of it.
    """
    lines = [_painted(printable(report.title), _BOLD, colour=colour), ""]
    lines[1:1] = [printable(note) for note in report.notes]
    if has_summary(report):
        lines[-1:] = [_totals(report)]
        for level, told_of in summary_lines(report):
            shown = _painted(level.ljust(_WIDEST_LEVEL), _STYLES.get(level, _DIM), colour=colour)
            lines.append(f"{shown}{told_of}" if level else f"    {told_of}")
        lines.append("")
    groups = grouped(report.items)
    for group, items in groups.items():
        if len(groups) > 1 or group:
            lines.append(_painted(printable(group) or WHOLE.capitalize(), _BOLD, colour=colour))
        for item in items:
            lines += _finding(item, colour=colour)
        lines.append("")
    lines.append(_totals(report))
    text = "\n".join(lines) + "\n"
    return text.replace("→", "->") if ascii_only else text


def _totals(report: Report) -> str:
    return "; ".join(filter(None, (counted(report), casualties(report))))


def _finding(item: Item, *, colour: bool) -> Iterator[str]:
    level = _painted(item.level.ljust(_WIDEST_LEVEL), _STYLES[item.level], colour=colour)
    yield f"  {level}{named(item)}{told(item, longest=_LONGEST)}"
    whom = broken(item)
    below = (
        printable(str(item.where)) if item.where.path else "",
        printable(item.rule),
        f"breaks {whom}" if whom else "",
        f"[{item.fingerprint}]",
    )
    yield " " * (2 + _WIDEST_LEVEL) + _painted("  ".join(filter(None, below)), _DIM, colour=colour)


def _painted(text: str, style: str, *, colour: bool) -> str:
    return f"\x1b[{style}m{text}\x1b[0m" if colour else text
