"""Attributes of other tools keep their values: of the database, nodes, messages and signals."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

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
from typedcan.model.protocol import Aspect, Message, Node, Protocol, Signal

_Values = Mapping[str, str]


def _check(pairing: Pairing) -> Iterator[Change]:
    for name, was, now in _different(_values(pairing.old), _values(pairing.new)):
        yield protocol_change(name, f"attribute {name}", was, now)
    for before, after in pairing.nodes:
        for name, was, now in _different(_values(before), _values(after)):
            yield protocol_change(after.name, f"attribute {name} of node", was, now)
    for message in pairing.messages:
        shown = _different(_values(message.old), _values(message.new))
        if message.old.send_type is not message.new.send_type:  # another promise tells of it
            shown = [each for each in shown if each[0] != "GenMsgSendType"]
        for name, was, now in [*shown, *_different(*_relations(pairing, message.old, message.new))]:
            yield message_change(message, f"attribute {name}", was, now)
    for signal in pairing.signals:
        for name, was, now in _different(_values(signal.old), _values(signal.new)):
            yield signal_change(signal, f"attribute {name}", was, now)


def _values(of: Protocol | Node | Message | Signal) -> _Values:
    return {each.name: f'"{each.value}"' for each in of.attributes}


def _relations(pairing: Pairing, old: Message, new: Message) -> tuple[_Values, _Values]:
    """Attributes that nodes have for a message, by attribute, node and signal of the new side."""
    names = pairing.names
    before = {
        f"{each.name} for {pairing.continued([each.node])[0]}"
        f"{_of(names.get(each.signal, each.signal))}": f'"{each.value}"'
        for each in old.relations
    }
    after = {
        f"{each.name} for {each.node}{_of(each.signal)}": f'"{each.value}"'
        for each in new.relations
    }
    return before, after


def _of(signal: str) -> str:
    return f" of {signal}" if signal else ""


def _different(old: _Values, new: _Values) -> list[tuple[str, str, str]]:
    every = dict.fromkeys([*old, *new])
    return [
        (name, old.get(name, ""), new.get(name, ""))
        for name in every
        if old.get(name) != new.get(name)
    ]


PROMISE = Promise(
    "attribute-same",
    "Attributes of other tools have the same values.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
    needs=Aspect.ATTRIBUTES,
)
