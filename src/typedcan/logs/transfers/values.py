"""Texts and numbered blocks of a log, complete values with the time, by the rules of live nodes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import Column, MessageColumns, State
from typedcan.logs.transfers.cycles import Channel, channels_of, on_channel
from typedcan.logs.transfers.readings import ColumnsError
from typedcan.model.signal_state import SignalState
from typedcan.model.transfers.kind import Problem, Rules
from typedcan.model.transfers.parts import Part, Parts
from typedcan.model.transfers.registry import KINDS

_STATES = {State.INVALID: SignalState.INVALID, State.ABNORMAL: SignalState.ABNORMAL}

_Frame = tuple[int, float, str, tuple[Any, ...]]
"""A frame: its place in the log, when it came, its message, and what its signals hold."""


@dataclass(frozen=True, slots=True)
class Complete:
    """A value that is complete, on a channel as python-can gives it."""

    parts: Parts
    channel: Channel
    value: Any


class ValueColumns:
    """Takes the decoded blocks of one log in their order.

    Parameters
    ----------
    transfers
        What to put together.
    """

    def __init__(self, transfers: Iterable[Parts]) -> None:
        self._transfers = tuple(transfers)
        self._wanted = [self._new_rules(parts).wanted for parts in self._transfers]
        self._rules: dict[tuple[str, Channel], Rules] = {}
        self._end = -math.inf
        self.problems: list[Problem] = []
        """What was wrong, in the order in which it was found."""

    def add(self, messages: Mapping[str, MessageColumns]) -> Iterator[Complete]:
        """The values that are complete with a block of physical values.

        Raises
        ------
        ColumnsError
            A signal was not decoded, or to raw values.
        """
        for parts, wanted in zip(self._transfers, self._wanted, strict=True):
            there = [messages[name] for name in wanted if name in messages]
            for channel in channels_of(*there):
                key = parts.transfer.name, channel
                if key not in self._rules:
                    self._rules[key] = self._new_rules(parts)
                frames = _frames(there, channel, wanted)
                yield from self._feed(parts, channel, self._rules[key], frames)
        for columns in messages.values():
            self._end = max(self._end, float(columns.block.timestamp.max(initial=-math.inf)))

    def finish(self) -> None:
        """Note what is overdue at the end of the log."""
        for rules in self._rules.values():
            self._expire(rules, self._end)

    @staticmethod
    def _new_rules(parts: Parts) -> Rules:
        return KINDS[parts.transfer.kind].rules(parts)

    def _feed(
        self, parts: Parts, channel: Channel, rules: Rules, frames: Iterable[_Frame]
    ) -> Iterator[Complete]:
        for _, at, message, values in frames:
            self._expire(rules, at)
            for outcome in rules.feed(message, values, at):
                if isinstance(outcome, Problem):
                    self.problems.append(outcome)
                else:
                    yield Complete(parts, channel, outcome)

    def _expire(self, rules: Rules, now: float) -> None:
        """Let time pass as it does for a live node, from one deadline to the next."""
        while (due := rules.deadline) <= now:
            self.problems += rules.expire(due)


def _frames(
    there: Iterable[MessageColumns], channel: Channel, wanted: Mapping[str, tuple[Part, ...]]
) -> list[_Frame]:
    """The frames of some messages on a channel, in the order in which they came."""
    frames: list[_Frame] = []
    for columns in there:
        own = on_channel(columns, channel)
        for part in wanted[columns.name]:
            if part.signal.name not in columns.columns:
                raise ColumnsError(f"{columns.name}: decode {part.signal.name} too")
        held = (columns.columns[part.signal.name] for part in wanted[columns.name])
        values = zip(*(_values(column, own) for column in held), strict=True)
        rows, times = columns.rows[own].tolist(), columns.timestamp[own].tolist()
        names = [columns.name] * len(rows)
        frames += zip(rows, times, names, values, strict=True)
    frames.sort(key=itemgetter(0))
    return frames


def _values(column: Column, own: slice | NDArray[np.int64]) -> list[Any]:
    """What a signal holds: numbers, states, None where a frame has it not."""
    if not column.signal.scaled:
        raise ColumnsError(f"{column.signal.name}: values are made of physical ones, not of raw")
    values: list[Any] = column.values[own].tolist()
    if column.valid is not None:
        state = np.zeros(len(column.values), np.uint8) if column.state is None else column.state
        for row in np.flatnonzero(~column.valid[own]).tolist():
            values[row] = _STATES.get(State(int(state[own][row])))
    return values
