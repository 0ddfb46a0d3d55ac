"""Rule code-labelled: an enumeration labels every raw value of its printed range.

Not meant are codes that only mark a value invalid or abnormal, that number things (CSC1, CSC2, …),
or that label less than half of the range, nor fields of more than 4 bits: those have no room for
characters either.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places, has_room
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.model import Code, Signal

_MOST_BITS = 4


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        if not has_room(message, signal) or signal.length > _MOST_BITS or not signal.factor:
            continue
        if missing := _unlabelled(signal):
            text = (
                f"{signal.name}: no label for raw {', '.join(map(str, missing))}, though it is in "
                f"the range and the others have one: label it, or waive it"
            )
            yield places.meaning(signal, "codes"), signal.name, text


def _unlabelled(signal: Signal) -> list[int]:
    """The raw values in range that lack a label, where the codes are an enumeration."""
    codes = signal.value_table.codes if signal.value_table else ()
    states = (signal.invalid_code, signal.abnormal_code)
    values = [code for code in codes if code.value not in states]
    if not values or _numbers(values):
        return []
    (low, high), (least, most) = signal.raw_range, signal.raw_limits
    in_range = range(max(low, least), min(high, most) + 1)
    labelled = {code.value for code in codes}
    missing = [raw for raw in in_range if raw not in labelled]
    return missing if 2 * len(missing) <= len(in_range) else []


def _numbers(codes: list[Code]) -> bool:
    """Whether every label is the same word with its code, as CSC1, CSC2."""
    words = {code.english.removesuffix(str(code.value)) for code in codes}
    return len(words) == 1 and all(code.english.endswith(str(code.value)) for code in codes)


RULE = Rule("code-labelled", "an enumeration labels every raw value of its range", _check)
