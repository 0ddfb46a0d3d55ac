"""Rule value-table-named: where standard.yaml names value tables, every one has a name there.

A label that is spelt differently in one row makes a value table of its own: this finds it.
"""

from __future__ import annotations

from collections.abc import Iterator
from difflib import SequenceMatcher

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import ValueTable

_ALIKE = 0.5


def _check(subject: Subject) -> Iterator[Found]:
    names = subject.spec.standard.value_tables if subject.spec else {}
    places = Places(subject)
    tables = subject.protocol.value_tables
    named = [table for table in tables if table.name in names]
    for table in tables if names else ():
        if table.name in names:
            continue
        text = f"the codes of {table.name} have no name in standard.yaml: give them one"
        closest = max(named, key=lambda other: _likeness(table, other), default=table)
        if closest is not table and _likeness(table, closest) >= _ALIKE:
            text = (
                f"the codes of {table.name} are not quite {closest.name} at "
                f"{places.codes(closest)}: {_difference(table, closest)}: correct one of them, or "
                f"name these in standard.yaml"
            )
        yield Found(places.codes(table), table.name, text)


def _likeness(one: ValueTable, other: ValueTable) -> float:
    """0 where no code has a similar label, 1 where all have the same."""
    here, there = one.labels(english=False), other.labels(english=False)
    both = here.keys() & there.keys()
    alike = sum(SequenceMatcher(None, here[code], there[code]).ratio() for code in both)
    return alike / len(here.keys() | there.keys())


def _difference(one: ValueTable, other: ValueTable) -> str:
    here, there = one.labels(english=False), other.labels(english=False)
    codes = sorted(code for code in here.keys() | there.keys() if here.get(code) != there.get(code))
    rest = f" and {len(codes) - 1} more" if len(codes) > 1 else ""
    return f"code {codes[0]} is {_shown(here, codes[0])}, not {_shown(there, codes[0])}{rest}"


def _shown(labels: dict[int, str], code: int) -> str:
    return repr(labels[code]) if code in labels else "unlabelled"


RULE = Rule(
    "value-table-named", "every value table has a name in standard.yaml", _check, level="warning"
)
