"""Which message, signal and node of the new protocol continues which of the old; done once.

A message continues the one with the same identifier, else the one with the same name. Within a
message a signal continues the one with the same name, else the one on identical bits: renames are
recognised within one identifier only.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

from dbcspec.layout import bits
from dbcspec.model import Message, Node, Protocol, Signal

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class SignalPair:
    """A signal before and after, with the messages it is in."""

    old_message: Message
    new_message: Message
    old: Signal
    new: Signal


@dataclass(frozen=True, slots=True)
class MessagePair:
    """A message before and after, and what became of its signals."""

    old: Message
    new: Message
    signals: tuple[SignalPair, ...]
    removed: tuple[Signal, ...]
    added: tuple[Signal, ...]


@dataclass(frozen=True, slots=True)
class Pairing:
    """Two protocols, matched."""

    old: Protocol
    new: Protocol
    messages: tuple[MessagePair, ...]
    removed: tuple[Message, ...]
    added: tuple[Message, ...]
    nodes: tuple[tuple[Node, Node], ...]
    removed_nodes: tuple[Node, ...]
    added_nodes: tuple[Node, ...]

    def signals(self) -> Iterable[SignalPair]:
        """Every signal that is in both."""
        for message in self.messages:
            yield from message.signals

    def continued(self, node: str) -> str:
        """What a node of the old protocol is called in the new one."""
        return next((new.name for old, new in self.nodes if old.name == node), node)


def pair(old: Protocol, new: Protocol) -> Pairing:
    """Match two protocols."""
    messages, removed, added = _matched(
        old.messages,
        new.messages,
        lambda message: (message.frame_id, message.extended),
        lambda message: message.name,
    )
    nodes, removed_nodes, added_nodes = _matched(
        old.nodes, new.nodes, lambda node: node.name, _role(old, new)
    )
    return Pairing(
        old=old,
        new=new,
        messages=tuple(_message_pair(before, after) for before, after in messages),
        removed=removed,
        added=added,
        nodes=nodes,
        removed_nodes=removed_nodes,
        added_nodes=added_nodes,
    )


def _message_pair(old: Message, new: Message) -> MessagePair:
    signals, removed, added = _matched(old.signals, new.signals, lambda signal: signal.name, _place)
    return MessagePair(
        old=old,
        new=new,
        signals=tuple(SignalPair(old, new, before, after) for before, after in signals),
        removed=removed,
        added=added,
    )


def _place(signal: Signal) -> Hashable:
    return bits(signal), signal.multiplexer, signal.selectors


def _role(old: Protocol, new: Protocol) -> Callable[[Node], Hashable]:
    """A renamed node still sends the same identifiers; one that sends none is not recognised."""
    sent: dict[int, frozenset[int]] = {
        id(node): frozenset(
            message.frame_id for message in side.messages if message.sender == node.name
        )
        for side in (old, new)
        for node in side.nodes
    }
    return lambda node: sent[id(node)] or id(node)


def _matched(
    old: Sequence[T], new: Sequence[T], *keys: Callable[[T], Hashable]
) -> tuple[tuple[tuple[T, T], ...], tuple[T, ...], tuple[T, ...]]:
    """Pairs by the first key, the rest by the second, and so on; then what is left of each."""
    found: dict[int, int] = {}
    for key in keys:
        waiting: dict[Hashable, list[int]] = {}
        taken = set(found.values())
        for index, item in enumerate(new):
            if index not in taken:
                waiting.setdefault(key(item), []).append(index)
        for index, item in enumerate(old):
            if index not in found and (candidates := waiting.get(key(item))):
                found[index] = candidates.pop(0)
    taken = set(found.values())
    return (
        tuple((old[index], new[found[index]]) for index in sorted(found)),
        tuple(item for index, item in enumerate(old) if index not in found),
        tuple(item for index, item in enumerate(new) if index not in taken),
    )
