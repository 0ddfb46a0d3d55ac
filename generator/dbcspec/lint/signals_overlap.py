"""Rule signals-overlap: no bit of a frame belongs to two signals.

Signals under different values of one multiplexer share bits rightly; those under a common value
are for branches-overlap. In files of others a signal that covers two or more others wholly is no
more than a note: some describe a group of signals beside the signals themselves.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.layout import bits
from typedcan.model.protocol import Message, Signal
from typedcan.model.soundness import overlaps

_NAMED = 3
"""Parts of a group that are named."""


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message in subject.protocol.messages:
        pairs = [
            (first, second, bit)
            for first, second, bit in overlaps(message)
            if not first.multiplexer or first.multiplexer != second.multiplexer
        ]
        groups = {} if subject.settings.house else _groups(pairs)
        yield from _covering(message, groups, places)
        for first, second, bit in pairs:
            if second.name in groups.get(first.name, ()) or first.name in groups.get(
                second.name, ()
            ):
                continue
            text = (
                f"{second.name} overlaps {first.name} at bit {bit} of {message.name}: "
                f"correct a start bit or a length"
            )
            yield Found(places.layout(second, "start"), second.name, text, message.name)


def _groups(pairs: list[tuple[Signal, Signal, int]]) -> dict[str, list[str]]:
    """By the name of each signal that covers two or more others wholly, the names of these."""
    taken = {each.name: {*bits(each)} for pair in pairs for each in pair[:2]}
    parts: dict[str, list[str]] = {}
    for first, second, _ in pairs:
        for whole, part in ((first.name, second.name), (second.name, first.name)):
            if taken[part] < taken[whole]:
                parts.setdefault(whole, []).append(part)
    return {whole: names for whole, names in parts.items() if len(names) > 1}


def _covering(message: Message, groups: dict[str, list[str]], places: Places) -> Iterator[Found]:
    for signal in message.signals:
        if names := groups.get(signal.name):
            more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
            text = (
                f"{signal.name} covers {', '.join(names[:_NAMED])}{more} of {message.name}: "
                f"a group of signals, or a wrong length"
            )
            where = places.layout(signal, "start")
            yield Found(where, signal.name, text, message.name, level="note")


RULE = Rule("signals-overlap", "no bit of a frame belongs to two signals", _check, foreign=True)
