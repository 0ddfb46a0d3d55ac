"""Rule text-length: labels and value lines are not longer than DBC readers read them."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places, value_tables
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.lint.texts import Use, texts
from typedcan.model.protocol import ValueTable

_LONGEST_LABEL = 63
_LONGEST_LINE = 5999
_LINE_START = f"VAL_ {2**32 - 1} {'n' * 32} "
"""The longest there can be."""


def _check(subject: Subject) -> Iterator[Found]:
    for text in texts(subject):
        length = len(text.text.encode())
        if text.use is Use.LABEL and length > _LONGEST_LABEL:
            fault = f"takes {length} bytes: shorten it to at most {_LONGEST_LABEL}"
            yield Found(text.where, text.subject, f"{text.what} {fault}", text.message)
    places = Places(subject)
    for table in value_tables(subject.protocol):
        length = _line_length(table)
        if length > _LONGEST_LINE:
            fault = (
                f"the value line of {table.name} may take {length} bytes: shorten its labels to at "
                f"most {_LONGEST_LINE}"
            )
            yield Found(places.codes(table), table.name, fault)


def _line_length(table: ValueTable) -> int:
    """The bytes of the longest VAL_ line with the table's codes, in any of the DBC files."""
    return max(
        len(f"{_LINE_START}{' '.join(_pairs(table.labels(english=english)))} ;".encode())
        for english in (True, False)
    )


def _pairs(labels: dict[int, str]) -> list[str]:
    return [f'{value} "{label}"' for value, label in labels.items()]


RULE = Rule(
    "text-length",
    "labels and value lines are as short as DBC readers want them",
    _check,
    level="warning",
)
