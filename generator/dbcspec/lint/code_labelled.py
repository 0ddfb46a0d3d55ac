"""Rule code-labelled: an enumeration labels every raw value of its range.

Not meant are codes that only mark a value invalid or abnormal, that number things (CSC1, CSC2, …),
or that label less than half of the range, nor ranges of more than 16 values: those are measured
values with some special ones, or characters.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.codes import is_numbering, value_codes
from typedcan.model.protocol import Signal
from typedcan.model.soundness import has_room

_MOST_VALUES = 16


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        if not has_room(message, signal) or signal.is_float or not signal.factor:
            continue
        if missing := _unlabelled(signal):
            text = (
                f"{signal.name}: no label for raw {', '.join(map(str, missing))}, though it is in "
                f"the range and the others have one: label it, or waive it"
            )
            yield Found(places.meaning(signal, "codes"), signal.name, text, message.name)


def _unlabelled(signal: Signal) -> list[int]:
    """The raw values in range that lack a label, where the codes are an enumeration."""
    values = value_codes(signal)
    if not values or is_numbering(values) or signal.value_table is None:
        return []
    (low, high), (least, most) = signal.raw_range, signal.raw_limits
    first, last = max(low, least), min(high, most)
    if last - first >= _MOST_VALUES:
        return []
    in_range = range(first, last + 1)
    labelled = {code.value for code in signal.value_table.codes}
    missing = [raw for raw in in_range if raw not in labelled]
    return missing if 2 * len(missing) <= len(in_range) else []


RULE = Rule(
    "code-labelled", "an enumeration labels every raw value of its range", _check, level="warning"
)
