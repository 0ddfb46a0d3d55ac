"""Rule code-in-raw-range: the bits of a signal can hold every code of its value table."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.soundness import has_room


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        if signal.value_table is None or signal.is_float or not has_room(message, signal):
            continue
        lowest, highest = signal.raw_limits
        if subject.settings.house:
            lowest = 0  # readers differ on negative codes
        outside = [
            code.value for code in signal.value_table.codes if not lowest <= code.value <= highest
        ]
        if outside:
            text = (
                f"{signal.name}: no code of {signal.length} bits can be "
                f"{', '.join(map(str, outside))}, only {lowest}~{highest}: correct the codes or "
                f"the length"
            )
            yield Found(places.meaning(signal, "codes"), signal.name, text, message.name)


RULE = Rule(
    "code-in-raw-range",
    "a signal's bits can hold every code of its value table",
    _check,
    foreign=True,
)
