"""Rule acting-code-in-range: a signal's bits and range hold its safe code and what acts."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import Signal
from typedcan.model.soundness import has_room


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        if signal.acting is None or signal.is_float or not has_room(message, signal):
            continue
        low, high = _held(signal)
        for key, codes in (("codes", signal.acting.codes), ("safe", (signal.acting.safe,))):
            outside = [str(code) for code in codes if not low <= code <= high]
            if outside:
                text = (
                    f"{signal.name}: {', '.join(outside)} is not within raw {low}~{high}, its bits "
                    f"and range: correct {key}, or the range"
                )
                yield Found(places.acts(message, signal, key), signal.name, text, message.name)


def _held(signal: Signal) -> tuple[int, int]:
    """The raw values that the bits hold and the range has; a range without sense counts not."""
    least, most = signal.raw_limits
    if signal.minimum >= signal.maximum or not signal.factor:
        return least, most  # range-fits-bits says so
    low, high = signal.raw_range
    return max(low, least), min(high, most)


RULE = Rule(
    "acting-code-in-range", "a signal's bits and range hold its safe code and what acts", _check
)
