"""Titles and comments stay."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

from dbcspec.compare.languages import Text
from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import (
    Breaks,
    Change,
    Class,
    Promise,
    message_change,
    protocol_change,
    signal_change,
)
from dbcspec.compare.spec_only import both_are_specs
from dbcspec.compare.transfers import transfer_pairs
from typedcan.model.protocol import Aspect, Bus, Message, Node, Protocol, Signal


def _check(pairing: Pairing) -> Iterator[Change]:
    yield from _of_protocol(pairing)
    for message in pairing.messages:
        if not _same_message(pairing, message.old, message.new):
            shown = _shown(_texts_of(message.old), _texts_of(message.new))
            yield message_change(message, "comment", *shown)
        for signal in message.signals:
            before, after = _texts(signal.old), _texts(signal.new)
            if before != after and not pairing.languages.same(before, after):
                yield signal_change(signal, "comment", *_shown(before, after))


def _of_protocol(pairing: Pairing) -> Iterator[Change]:
    """Of the protocol itself, its nodes, and what only a spec says of buses and transfers."""
    old, new = pairing.old, pairing.new
    if _texts(old) != _texts(new) and not pairing.languages.same(
        _texts(old), _texts(new), _numbered(old), _numbered(new)
    ):
        yield protocol_change("protocol", "comment", *_shown(_texts(old), _texts(new)))
    pairs: list[tuple[str, Text, Text]] = [
        (after.name, _texts(before), _texts(after)) for before, after in pairing.nodes
    ]
    if both_are_specs(pairing):
        pairs += [(after.name, _texts(before), _texts(after)) for before, after in pairing.buses]
        pairs += [
            (after.name, ("", before.english), ("", after.english))
            for before, after in transfer_pairs(pairing)
            if before and after
        ]
    for subject, before, after in pairs:
        if before != after and not pairing.languages.same(before, after):
            yield protocol_change(subject, "comment", *_shown(before, after))


def _same_message(pairing: Pairing, old: Message, new: Message) -> bool:
    if (_texts(old), old.condition) == (_texts(new), new.condition):
        return True
    if pairing.languages.both_bilingual:
        return False
    # The comment repeats the period, which is a promise of its own.
    told = dataclasses.replace(new, period=old.period).comment() if new.condition else ""
    return pairing.languages.same(_texts_of(old), _texts_of(new), (), (told,) if told else ())


def _texts(item: Protocol | Message | Signal | Node | Bus) -> Text:
    return item.title, item.english


def _numbered(protocol: Protocol) -> tuple[str, ...]:
    """A DBC has the number of the standard after its title."""
    return tuple(f"{text}, {protocol.number}" for text in _texts(protocol) if text)


def _texts_of(message: Message) -> Text:
    return message.title, message.comment()


def _shown(old: Text, new: Text) -> tuple[str, str]:
    """English first; which language a text is in only where nothing else is different."""
    before, after = (" / ".join(dict.fromkeys(filter(None, text[::-1]))) for text in (old, new))
    if before == after:
        return str(old), str(new)
    return before, after


PROMISE = Promise(
    "comment-same",
    "What a message, signal, node or bus is said to be stays, to the letter.",
    Class.COSMETIC,
    Breaks.NOBODY,
    _check,
    needs=Aspect.COMMENTS,
)
