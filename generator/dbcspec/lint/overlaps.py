"""Signals of a message that take the same bits of one frame."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations

from dbcspec.lint.places import has_room
from typedcan.model.layout import bits
from typedcan.model.protocol import Message, Signal

_Condition = Mapping[str, frozenset[int]]
"""Each multiplexer above a signal, with the values under which the signal is there."""


def overlaps(message: Message) -> Iterator[tuple[Signal, Signal, int]]:
    """Each pair that one frame can have together, in order, with its first common bit."""
    selectors = {signal.name: signal for signal in message.signals if signal.is_selector}
    signals = [signal for signal in message.signals if has_room(message, signal)]
    taken = [sum(1 << bit for bit in bits(signal) if bit >= 0) for signal in signals]
    conditions = [_condition(signal, selectors) for signal in signals]
    selected = [frozenset(signal.selectors) for signal in signals]
    for here, there in combinations(range(len(signals)), 2):
        shared = taken[here] & taken[there]
        if not shared:
            continue
        # First the quick answer: some messages have thousands of branches.
        same = signals[here].multiplexer == signals[there].multiplexer != ""
        if same and selected[here].isdisjoint(selected[there]):
            continue
        if _together(conditions[here], conditions[there]):
            yield signals[here], signals[there], (shared & -shared).bit_length() - 1


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
