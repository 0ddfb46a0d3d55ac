"""Findings as Markdown for a pull or merge request."""

from __future__ import annotations

import re
from collections.abc import Sequence

from typedcan.report.item import LINT_LEVELS, Item, Report
from typedcan.report.summary import has_summary, summary_lines
from typedcan.report.texts import (
    WHOLE,
    broken,
    casualties,
    counted,
    grouped,
    plural,
    shortened,
    told,
)
from typedcan.shell.printing import printable

_LONGEST_CELL = 300
_MOST_OPEN = 10
"""A table of more findings than this, or any table of a report of many, is folded."""
_LONGEST_REPORT = 60_000
"""Comments on the large hosts end at 65,536 characters."""

# References survive every Markdown reader, also inside tables, where backslashes are read twice.
_ESCAPES = str.maketrans(
    {
        "&": "&amp;",
        "<": "&lt;",
        ">": "&gt;",
        **{character: f"&#{ord(character)};" for character in "\\`|*[]~$"},
    }
)

_LOOSE_UNDERSCORE = re.compile(r"(?<![A-Za-z0-9])_|_(?![A-Za-z0-9])")
"""Within a name an underscore is harmless, and names stay readable in the source."""

_MARKS = re.compile(r"&#\d+;|[@#!%](?=[\w(&])")
"""What would call a person or link to an issue; references, left alone, have such a mark too."""


def to_markdown(report: Report) -> str:
    """A summary line, then a table for each message; tables are folded where there are many."""
    summary = ". ".join(
        f"{part[0].upper()}{part[1:]}" for part in (counted(report), casualties(report)) if part
    )
    text = f"### {escaped(report.title)}\n\n**{summary}.**\n"
    text += "".join(f"\n{escaped(note)}\n" for note in report.notes)
    if has_summary(report):
        text += _summary(report)
    groups = grouped(report.items)
    compared = any(item.level not in LINT_LEVELS for item in report.items)
    shown = 0
    for group, items in groups.items():
        folded = len(report.items) > _MOST_OPEN
        table = _section(
            escaped(group) or WHOLE.capitalize(),
            _table(items, compared=compared),
            items,
            folded=folded,
        )
        if len(text) + len(table) > _LONGEST_REPORT:
            break
        text += table
        shown += len(items)
    if left := len(report.items) - shown:
        text += f"\n{plural(left, 'more finding')} would not fit here; other formats have all.\n"
    return text


def _summary(report: Report) -> str:
    lines = []
    for level, told_of in summary_lines(report):
        lines.append(f"- **{level}** {escaped(told_of)}" if level else f"  - {escaped(told_of)}")
    return "\n" + "\n".join(lines) + "\n"


def escaped(text: str) -> str:
    """The text as one line that Markdown shows as it is, fit for a table cell."""
    plain = shortened(printable(text), _LONGEST_CELL).translate(_ESCAPES)
    return _MARKS.sub(_disarmed, _LOOSE_UNDERSCORE.sub("&#95;", plain))


def _disarmed(found: re.Match[str]) -> str:
    return found[0] if found[0].startswith("&") else f"{found[0]}<!-- -->"


def _section(heading: str, table: str, items: Sequence[Item], *, folded: bool) -> str:
    if not folded:
        return f"\n#### {heading}\n\n{table}"
    count = plural(len(items), "finding")
    summary = f"<summary><b>{heading}</b>: {count}</summary>"
    return f"\n<details>{summary}\n\n{table}\n</details>\n"


def _table(items: Sequence[Item], *, compared: bool) -> str:
    if compared:
        heads = ["class", "what", "change", "breaks", "promise", "where", "fingerprint"]
        rows = [_compared(item) for item in items]
    else:
        heads = ["where", "finding", "rule"]
        rows = [[_where(item), escaped(item.text), escaped(item.rule)] for item in items]
    lines = [heads, ["---"] * len(heads), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _compared(item: Item) -> list[str]:
    return [
        f"**{item.level}**" if item.level in ("error", "wire") else item.level,
        escaped(item.subject),
        escaped(told(item)),
        broken(item),
        escaped(item.rule),
        _where(item),
        item.fingerprint,
    ]


def _where(item: Item) -> str:
    return escaped(str(item.where)) if item.where.path else ""
