"""Which message, signal and node of the new protocol continues which of the old; done once.

A message continues the one with the same identifier, else the one with the same name. Within a
message a signal continues the one with the same name; within one identifier also the one on
identical bits, so that renames are recognised. Only signals that differ are kept: what is equal
breaks no promise, and is most of any real pair.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from operator import attrgetter
from typing import TypeVar

from dbcspec.compare.languages import Languages
from typedcan.model.layout import bits
from typedcan.model.protocol import Bus, Message, Node, Protocol, Signal, ValueTable

T = TypeVar("T")

_apart_from_codes: Callable[[Signal], tuple[object, ...]] = attrgetter(
    *(part.name for part in fields(Signal) if part.compare and part.name != "value_table")
)


@dataclass(frozen=True, slots=True)
class SignalPair:
    """A signal before and after, with the messages it is in.

    ``renamed`` has the signals of the message whose name changed, old name to new.
    """

    old_message: Message
    new_message: Message
    old: Signal
    new: Signal
    renamed: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class MessagePair:
    """A message before and after, and what became of its signals.

    ``signals`` has the pairs that differ in anything; ``renamed`` as in `SignalPair`;
    ``reordered`` tells that the signals in both stand in another order.
    """

    old: Message
    new: Message
    signals: tuple[SignalPair, ...]
    removed: tuple[Signal, ...]
    added: tuple[Signal, ...]
    renamed: Mapping[str, str]
    reordered: bool


@dataclass(frozen=True)
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
    buses: tuple[tuple[Bus, Bus], ...]
    removed_buses: tuple[Bus, ...]
    added_buses: tuple[Bus, ...]

    @cached_property
    def signals(self) -> tuple[SignalPair, ...]:
        """Every signal that is in both and differs in anything."""
        return tuple(signal for message in self.messages for signal in message.signals)

    @cached_property
    def languages(self) -> Languages:
        """In which languages both sides speak."""
        return Languages(self.old, self.new)

    @cached_property
    def names(self) -> Mapping[str, str]:
        """Messages and signals that are called otherwise now, old name to new."""
        changed = {
            message.old.name: message.new.name
            for message in self.messages
            if message.old.name != message.new.name
        }
        for message in self.messages:
            changed.update(message.renamed)
        return changed

    @cached_property
    def gone(self) -> frozenset[str]:
        """Names of messages and signals of the old protocol that nothing continues."""
        return frozenset(
            [
                *(message.name for message in self.removed),
                *(signal.name for message in self.removed for signal in message.signals),
                *(signal.name for message in self.messages for signal in message.removed),
            ]
        )

    @cached_property
    def fresh(self) -> frozenset[str]:
        """Names of messages and signals of the new protocol that continue nothing."""
        return frozenset(
            [
                *(message.name for message in self.added),
                *(signal.name for message in self.added for signal in message.signals),
                *(signal.name for message in self.messages for signal in message.added),
            ]
        )

    @cached_property
    def signal_names(self) -> tuple[frozenset[str], frozenset[str]]:
        """The names of all signals of the old and of the new protocol."""
        old, new = (
            frozenset(signal.name for _, signal in side.signals()) for side in (self.old, self.new)
        )
        return old, new

    @cached_property
    def table_names(self) -> tuple[frozenset[str], frozenset[str]]:
        """The names of all value tables of the old and of the new protocol."""
        old, new = (
            frozenset(table.name for table in side.value_tables) for side in (self.old, self.new)
        )
        return old, new

    @cached_property
    def _node_names(self) -> Mapping[str, str]:
        return {old.name: new.name for old, new in self.nodes}

    def continued(self, nodes: Iterable[str]) -> tuple[str, ...]:
        """What nodes of the old protocol are called in the new one."""
        return tuple(self._node_names.get(node, node) for node in nodes)


def pair(old: Protocol, new: Protocol) -> Pairing:
    """Match two protocols, in a time that grows with their size, not with its square."""
    messages, removed, added = _matched(
        old.messages, new.messages, attrgetter("frame_id", "extended"), attrgetter("name")
    )
    nodes, removed_nodes, added_nodes = _matched(
        old.nodes, new.nodes, attrgetter("name"), *_roles(old, new)
    )
    buses, removed_buses, added_buses = _matched(
        old.buses, new.buses, attrgetter("name"), lambda bus: frozenset(bus.nodes)
    )
    matcher = _SignalMatcher()
    return Pairing(
        old=old,
        new=new,
        messages=tuple(matcher.message(before, after) for before, after in messages),
        removed=removed,
        added=added,
        nodes=nodes,
        removed_nodes=removed_nodes,
        added_nodes=added_nodes,
        buses=buses,
        removed_buses=removed_buses,
        added_buses=added_buses,
    )


class _SignalMatcher:
    """Matches the signals of messages; remembers which value tables are the same."""

    def __init__(self) -> None:
        self._tables: dict[tuple[int, int], bool] = {}

    def message(self, old: Message, new: Message) -> MessagePair:
        if [signal.name for signal in old.signals] == [signal.name for signal in new.signals]:
            matched: Iterable[tuple[Signal, Signal]] = zip(old.signals, new.signals, strict=True)
            removed: tuple[Signal, ...] = ()
            added: tuple[Signal, ...] = ()
            reordered = False
        else:
            same_identifier = (old.frame_id, old.extended) == (new.frame_id, new.extended)
            keys = (attrgetter("name"), _place) if same_identifier else (attrgetter("name"),)
            matched, removed, added = _matched(old.signals, new.signals, *keys)
            reordered = is_reordered(matched, new.signals)
        different = [pair for pair in matched if not self._same(*pair)]
        renamed = {
            before.name: after.name for before, after in different if before.name != after.name
        }
        return MessagePair(
            old=old,
            new=new,
            signals=tuple(
                SignalPair(old, new, before, after, renamed) for before, after in different
            ),
            removed=removed,
            added=added,
            renamed=renamed,
            reordered=reordered,
        )

    def _same(self, old: Signal, new: Signal) -> bool:
        return _apart_from_codes(old) == _apart_from_codes(new) and self._same_table(
            old.value_table, new.value_table
        )

    def _same_table(self, old: ValueTable | None, new: ValueTable | None) -> bool:
        if old is new or old is None or new is None:
            return old is new
        key = id(old), id(new)
        if key not in self._tables:
            self._tables[key] = old == new
        return self._tables[key]


def is_reordered(matched: Sequence[tuple[T, T]], new: Sequence[T]) -> bool:
    """Whether things that are in both stand in another order than before."""
    position = {id(item): index for index, item in enumerate(new)}
    indexes = [position[id(after)] for _, after in matched]
    return indexes != sorted(indexes)


def _place(signal: Signal) -> Hashable:
    return bits(signal), signal.selectors


def _roles(old: Protocol, new: Protocol) -> tuple[Callable[[Node], Hashable], ...]:
    """What a renamed node is known by: what it sends, its address, what it receives.

    A node without the one or the other is not recognised by it.
    """
    sent: dict[int, frozenset[int]] = {}
    heard: dict[int, frozenset[int]] = {}
    for side in (old, new):
        sends: dict[str, set[int]] = {}
        hears: dict[str, set[int]] = {}
        for message in side.messages:
            for sender in message.senders or ("",):
                sends.setdefault(sender, set()).add(message.frame_id)
            for receiver in message.receivers:
                hears.setdefault(receiver, set()).add(message.frame_id)
        for node in side.nodes:
            sent[id(node)] = frozenset(sends.get(node.name, ()))
            heard[id(node)] = frozenset(hears.get(node.name, ()))
    return (
        lambda node: sent[id(node)] or id(node),
        lambda node: ("address", node.address) if node.address is not None else id(node),
        lambda node: heard[id(node)] or id(node),
    )


def _matched(
    old: Sequence[T], new: Sequence[T], *keys: Callable[[T], Hashable]
) -> tuple[tuple[tuple[T, T], ...], tuple[T, ...], tuple[T, ...]]:
    """Pairs by the first key, the rest by the second, and so on; then what is left of each."""
    found: dict[int, int] = {}
    taken: set[int] = set()
    for key in keys:
        if len(found) == len(old) or len(taken) == len(new):
            break
        waiting: dict[Hashable, list[int]] = {}
        for index in reversed(range(len(new))):
            if index not in taken:
                waiting.setdefault(key(new[index]), []).append(index)
        for index, item in enumerate(old):
            if index not in found and (candidates := waiting.get(key(item))):
                found[index] = candidates.pop()
                taken.add(found[index])
    return (
        tuple((old[index], new[found[index]]) for index in sorted(found)),
        tuple(item for index, item in enumerate(old) if index not in found),
        tuple(item for index, item in enumerate(new) if index not in taken),
    )
