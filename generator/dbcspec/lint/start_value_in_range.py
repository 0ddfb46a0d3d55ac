"""Rule start-value-in-range: a signal can have the value that it starts with.

It fits the bits, and is in the range or has a code of its own. Raw 0 is also what stands where no
start value is given, so it may be outside the range.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import Signal
from typedcan.model.soundness import has_room


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        if has_room(message, signal) and not signal.is_float and (fault := _fault(signal, subject)):
            text = f"{signal.name} starts with raw {signal.start_value}, but {fault}: correct it"
            yield Found(places.meaning(signal, "range"), signal.name, text, message.name)


def _fault(signal: Signal, subject: Subject) -> str | None:
    start, (least, most) = signal.start_value, signal.raw_limits
    if not least <= start <= most:
        return f"its {signal.length} bits hold {least}~{most}"
    if not subject.settings.house:
        return None  # a value outside of the range, such as 255, often says that there is none
    coded = {code.value for code in signal.value_table.codes} if signal.value_table else set[int]()
    if not start or start in coded | set(signal.states):
        return None
    if signal.minimum >= signal.maximum or not signal.factor:
        return None  # range-fits-bits says so
    low, high = signal.raw_range
    return None if low <= start <= high else f"its range is raw {low}~{high}"


RULE = Rule(
    "start-value-in-range", "a signal can have the value that it starts with", _check, foreign=True
)
