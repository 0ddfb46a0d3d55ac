"""What of a protocol cannot be had as it stands: that is named, and the sound rest is had."""

from __future__ import annotations

import dataclasses
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import islice

from typedcan.model.layout import bits, unreadable
from typedcan.model.naming import unused
from typedcan.model.protocol import Message, Protocol, Signal

_NAMED = 3
"""Remarks that are written out where one line has to do."""

_MOST_OVERLAPS = 1000

_Condition = Mapping[str, frozenset[int]]
"""Each multiplexer above a signal, with the values under which the signal is there."""


def remarks(protocol: Protocol) -> Iterator[str]:
    """What is odd, a line each: names that are taken, messages that hide, signals left out."""
    yield from renames(protocol)
    yield from hidden_how(protocol)
    for message in protocol.messages:
        for signal, reason in unreadable(message):
            yield f"{message.name}.{signal.name} is left out: {reason}"
        for first, second, _ in overlaps(message):
            yield f"{message.name}: {second.name} shares bits with {first.name}"


def renames(protocol: Protocol) -> Iterator[str]:
    """What `with_unique_names` changes, a line each."""
    unique = with_unique_names(protocol)
    for name, count in Counter(node.name for node in protocol.nodes).items():
        if count > 1:
            yield f"the node {name} stands there {count} times: once is kept"
    for message, other in zip(protocol.messages, unique.messages, strict=True):
        if message.name != other.name:
            yield f"a second message {message.name} is called {other.name}"
        for signal, renamed in zip(message.signals, other.signals, strict=True):
            if signal.name != renamed.name:
                yield f"{message.name}: a second signal {signal.name} is called {renamed.name}"


def hidden_how(protocol: Protocol) -> Iterator[str]:
    """Which messages no frame is, a line each."""
    for name, later in hidden(protocol).items():
        yield f"{name} has the identifier of {later}: frames are taken for {later}"


def remark(protocol: Protocol) -> str:
    """The remarks in one printable line, as far as one has room; "" where there are none."""
    found = [*remarks(protocol)]
    if not found:
        return ""
    more = len(found) - _NAMED
    rest = [f"and {more} more: dbcspec lint names them"] if more > 0 else []
    text = f"{protocol.name}: {'; '.join((*found[:_NAMED], *rest))}"
    return "".join(each if each.isprintable() else ascii(each)[1:-1] for each in text)


def hidden(protocol: Protocol) -> dict[str, str]:
    """Messages that no frame is, since a later one, named here, has their identifier."""
    last = {(each.frame_id, each.extended): each.name for each in protocol.messages}
    pairs = ((each.name, last[each.frame_id, each.extended]) for each in protocol.messages)
    return {name: later for name, later in pairs if name != later}


def with_unique_names(protocol: Protocol) -> Protocol:
    """The protocol, each later message or signal of one name with a number behind it.

    Of several nodes of one name the first is left.
    """
    first = {node.name: node for node in reversed(protocol.nodes)}
    if len(first) < len(protocol.nodes):
        left = tuple(node for node in protocol.nodes if first[node.name] is node)
        return with_unique_names(dataclasses.replace(protocol, nodes=left))
    names = [message.name for message in protocol.messages]
    unique = len(set(names)) == len(names)
    if unique and all(_unique(each.signals) is each.signals for each in protocol.messages):
        return protocol
    taken: set[str] = {message.name for message in protocol.messages}
    seen: set[str] = set()
    messages: list[Message] = []
    for message in protocol.messages:
        name = unused(message.name, taken) if message.name in seen else message.name
        seen.add(message.name)
        taken.add(name)
        messages.append(dataclasses.replace(message, name=name, signals=_unique(message.signals)))
    return dataclasses.replace(protocol, messages=tuple(messages))


def _unique(signals: tuple[Signal, ...]) -> tuple[Signal, ...]:
    taken: set[str] = {signal.name for signal in signals}
    if len(taken) == len(signals):
        return signals
    seen: set[str] = set()
    renamed: list[Signal] = []
    for signal in signals:
        name = unused(signal.name, taken) if signal.name in seen else signal.name
        seen.add(signal.name)
        taken.add(name)
        renamed.append(dataclasses.replace(signal, name=name))
    return tuple(renamed)


def overlaps(message: Message) -> Iterator[tuple[Signal, Signal, int]]:
    """Each pair that one frame can have together, with its first common bit.

    They come in the order of the second. Of a message with thousands of them the first thousand do.
    """
    return islice(_overlaps(message), _MOST_OVERLAPS)


def _overlaps(message: Message) -> Iterator[tuple[Signal, Signal, int]]:
    selectors = {signal.name: signal for signal in message.signals if signal.is_selector}
    signals = [signal for signal in message.signals if has_room(message, signal)]
    taken = [sum(1 << bit for bit in bits(signal) if bit >= 0) for signal in signals]
    conditions = [_condition(signal, selectors) for signal in signals]
    selected = [frozenset(signal.selectors) for signal in signals]
    before = _Taken()
    for there, second in enumerate(signals):
        # First the quick answer: some messages have thousands of branches.
        meets = before.meets(second, taken[there])
        before.add(second, taken[there])
        for here in range(there) if meets else ():
            shared = taken[here] & taken[there]
            if not shared:
                continue
            same = signals[here].multiplexer == second.multiplexer != ""
            if same and selected[here].isdisjoint(selected[there]):
                continue
            if _together(conditions[here], conditions[there]):
                yield signals[here], second, (shared & -shared).bit_length() - 1


class _Taken:
    """The bits that signals have, by their multiplexer, and by the values that select them."""

    def __init__(self) -> None:
        self._by_multiplexer: dict[str, int] = {}
        self._by_selector: dict[tuple[str, int], int] = {}

    def add(self, signal: Signal, taken: int) -> None:
        name = signal.multiplexer
        self._by_multiplexer[name] = self._by_multiplexer.get(name, 0) | taken
        for selector in signal.selectors if name else ():
            self._by_selector[name, selector] = self._by_selector.get((name, selector), 0) | taken

    def meets(self, signal: Signal, taken: int) -> bool:
        """Whether one of them may be in a frame with this signal, and share bits with it."""
        own = signal.multiplexer
        if any(
            mask & taken for name, mask in self._by_multiplexer.items() if name != own or not own
        ):
            return True
        return bool(own) and any(
            self._by_selector.get((own, selector), 0) & taken for selector in signal.selectors
        )


def has_room(message: Message, signal: Signal) -> bool:
    """Whether a signal has a length that its message can hold."""
    return 1 <= signal.length <= 8 * message.length


def _condition(signal: Signal, selectors: Mapping[str, Signal]) -> _Condition:
    """The multiplexer of a signal, that of this one, and so on."""
    found: dict[str, frozenset[int]] = {}
    above: Signal | None = signal
    while above and above.multiplexer and above.multiplexer not in found:
        found[above.multiplexer] = frozenset(above.selectors)
        above = selectors.get(above.multiplexer)
    return found


def _together(here: _Condition, there: _Condition) -> bool:
    """Whether no multiplexer selects only one of the two."""
    return all(here[name] & there[name] for name in here.keys() & there.keys())
