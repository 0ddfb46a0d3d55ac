"""Rule branches-overlap: multiplexed signals with a common selector have no common bit."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.soundness import overlaps


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message in subject.protocol.messages:
        for first, second, bit in overlaps(message):
            if not first.multiplexer or first.multiplexer != second.multiplexer:
                continue
            common = min({*first.selectors} & {*second.selectors})
            text = (
                f"{second.name} overlaps {first.name} at bit {bit} of {message.name} while "
                f"{first.multiplexer} is {common}: correct a start bit, a length or a selector"
            )
            yield Found(places.layout(second, "start"), second.name, text, message.name)


RULE = Rule(
    "branches-overlap",
    "multiplexed signals with a common selector have no common bit",
    _check,
    foreign=True,
)
