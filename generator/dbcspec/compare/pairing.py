"""Which message, signal and node of the new protocol continues which of the old; done once.

A message continues the one with the same identifier, else the one with the same name. Within a
message a signal continues the one with the same name; within one identifier also the one on
identical bits, so that renames are recognised. Matched by place, bits go before names: so two
spellings of one protocol are compared, and that is chosen where most names differ. Only signals
that differ are kept: what is equal breaks no promise, and is most of any real pair.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from operator import attrgetter

from dbcspec.compare.languages import Languages
from dbcspec.compare.matching import is_reordered, matched, roles
from typedcan.model.layout import bits
from typedcan.model.protocol import Bus, Code, Message, Node, Protocol, Signal, ValueTable

_FEWEST_RENAMED = 5
"""Signals with other names that make another spelling of a protocol, not an edit of it."""

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
    by_place: bool = False
    """Whether signals were matched by their bits before their names."""

    @cached_property
    def signals(self) -> tuple[SignalPair, ...]:
        """Every signal that is in both and differs in anything."""
        return tuple(signal for message in self.messages for signal in message.signals)

    @cached_property
    def signals_by_tables(self) -> tuple[tuple[SignalPair, ...], ...]:
        """Signals whose codes differ, those together that have the same two value tables."""
        users: dict[tuple[ValueTable | None, ValueTable | None], list[SignalPair]] = {}
        same: dict[tuple[int, int], bool] = {}
        for signal in self.signals:
            old, new = signal.old.value_table, signal.new.value_table
            if old is not new:
                key = id(old), id(new)
                if key not in same:
                    same[key] = _codes(old) == _codes(new)
                if not same[key]:
                    users.setdefault((old, new), []).append(signal)
        return tuple(map(tuple, users.values()))

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


def pair(old: Protocol, new: Protocol, *, by_place: bool | None = None) -> Pairing:
    """Match two protocols, in a time that grows with their size, not with its square.

    ``by_place`` tells whether bits go before names within one identifier; None: where most of the
    signals on the same bits are called otherwise.
    """
    messages, removed, added = matched(
        old.messages, new.messages, attrgetter("frame_id", "extended"), attrgetter("name")
    )
    nodes, removed_nodes, added_nodes = matched(
        old.nodes, new.nodes, attrgetter("name"), *roles(old, new)
    )
    buses, removed_buses, added_buses = matched(
        old.buses, new.buses, attrgetter("name"), lambda bus: frozenset(bus.nodes)
    )
    if by_place is None:
        by_place = _most_are_renamed(messages)
    matcher = _SignalMatcher(by_place=by_place)
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
        by_place=by_place,
    )


def _codes(table: ValueTable | None) -> tuple[Code, ...]:
    return table.codes if table else ()


def _most_are_renamed(messages: Iterable[tuple[Message, Message]]) -> bool:
    """Whether more signals of one identifier share their bits alone than share their names."""
    same_name = same_place = 0
    for old, new in messages:
        before, after = ({signal.name for signal in side.signals} for side in (old, new))
        same_name += len(before & after)
        if before != after and _same_identifier(old, new):
            by_bits = {_place(signal) for signal in old.signals if signal.name not in after}
            rest = (signal for signal in new.signals if signal.name not in before)
            same_place += sum(_place(signal) in by_bits for signal in rest)
    return same_place > same_name and same_place >= _FEWEST_RENAMED


class _SignalMatcher:
    """Matches the signals of messages; remembers which value tables are the same."""

    def __init__(self, *, by_place: bool) -> None:
        self._by_place = by_place
        self._tables: dict[tuple[int, int], bool] = {}

    def message(self, old: Message, new: Message) -> MessagePair:
        names = ([signal.name for signal in side.signals] for side in (old, new))
        if not self._by_place and next(names) == next(names):
            both: Iterable[tuple[Signal, Signal]] = zip(old.signals, new.signals, strict=True)
            removed: tuple[Signal, ...] = ()
            added: tuple[Signal, ...] = ()
            reordered = False
        else:
            keys: tuple[Callable[[Signal], Hashable], ...] = (attrgetter("name"),)
            if _same_identifier(old, new):
                by_bits = (_place, *keys, _first_bit)
                keys = by_bits if self._by_place else (*keys, _place)
            both, removed, added = matched(old.signals, new.signals, *keys)
            reordered = is_reordered(both, new.signals)
        different = [pair for pair in both if not self._same(*pair)]
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


def _same_identifier(old: Message, new: Message) -> bool:
    return (old.frame_id, old.extended) == (new.frame_id, new.extended)


def _place(signal: Signal) -> Hashable:
    return bits(signal), signal.selectors


def _first_bit(signal: Signal) -> Hashable:
    return signal.start, signal.byte_order, signal.selectors
