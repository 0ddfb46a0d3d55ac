"""What is measured by group: the signals that carry it, and their frames as columns."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import Column, MessageColumns, State
from typedcan.model.errors import TypedcanError
from typedcan.model.protocol import Protocol
from typedcan.model.transfers.cycle import NUMBER_BITS, WINDOW
from typedcan.model.transfers.parts import Part, Parts
from typedcan.model.transfers.reading_rules import fills_of
from typedcan.model.transfers.readings import ReadingsByGroup
from typedcan.model.transfers.registry import KINDS, problems


class ColumnsError(TypedcanError, ValueError):
    """What was decoded is not what the values of a transfer are made of."""


@dataclass(frozen=True, slots=True)
class Readings:
    """Readings of one kind, and the signals that carry them.

    Parameters
    ----------
    name
        Of the table.
    item
        What one reading is called, the begin of the names of columns.
    message, period
        The message, and seconds between its cycles.
    group, number
        Signals: the group of a frame, and its number.
    no_group
        Codes that are no group.
    items
        Signals: the readings of a frame in order.
    unit
        Of the readings.
    totals, total_signals
        The message that tells how many there are, and its signals for that, of groups and of
        readings in all. Where the protocol fixes them, the message itself and no signals.
    word
        What a group is called in metadata.
    parts
        All that the protocol says of the transfer.
    """

    name: str
    item: str
    message: str
    period: float
    group: str
    number: str
    no_group: tuple[int, ...]
    items: tuple[str, ...]
    unit: str
    totals: str
    total_signals: tuple[str, ...]
    word: str
    parts: Parts = field(repr=False, compare=False)

    @property
    def window(self) -> float:
        """Seconds that a reading in a cycle may be old."""
        return self.parts.seconds(WINDOW)

    def column(self, group: int, number: int) -> str:
        """Name of the column of a reading; the number counts from 1."""
        return f"{self.item}_{group}_{number}"


def readings_of(protocol: Protocol) -> tuple[Readings, ...]:
    """What the transfers of a protocol carry by groups; those that do not fit are passed over."""
    return tuple(
        _readings(parts, parts.group, parts.number)
        for parts in (Parts(transfer, protocol) for transfer in protocol.transfers)
        if parts.transfer.kind == ReadingsByGroup.name
        and not problems(parts.transfer, protocol)
        and parts.group
        and parts.number
    )


def values_of(protocol: Protocol) -> tuple[Parts, ...]:
    """The texts and blocks of a protocol; those that do not fit are passed over."""
    return tuple(
        Parts(transfer, protocol)
        for transfer in protocol.transfers
        if not problems(transfer, protocol)
        and KINDS[transfer.kind].columns(Parts(transfer, protocol))
    )


def _readings(parts: Parts, group: Part, number: Part) -> Readings:
    total_signals = [part for part in (parts.groups, parts.count) if part]
    return Readings(
        name=parts.table,
        item=parts.column,
        message=parts.messages[0].name,
        period=parts.period or 0,
        group=group.signal.name,
        number=number.signal.name,
        no_group=tuple(group.signal.states),
        items=tuple(part.signal.name for part in parts.items),
        unit=parts.items[0].signal.unit,
        totals=total_signals[0].message.name if total_signals else parts.messages[0].name,
        total_signals=tuple(part.signal.name for part in total_signals),
        word=re.sub(r"\W+", "_", parts.word.lower()),
        parts=parts,
    )


@dataclass(frozen=True, slots=True)
class ReadingFrames:
    """Frames of one message on one channel, in their order; n rows.

    Parameters
    ----------
    time
        Seconds.
    key
        Group and frame number in one, both from 1; the group is 0 where the frame has none.
    within
        The last reading of the frame that has a value, from 1; 0 for none.
    values, state
        The readings and their `State`, shape (n, readings in a frame).
    """

    time: NDArray[np.float64]
    key: NDArray[np.int64]
    within: NDArray[np.uint8]
    values: NDArray[np.float64]
    state: NDArray[np.uint8]

    def __len__(self) -> int:
        """How many frames."""
        return len(self.time)

    def rows(self, rows: NDArray[np.int64]) -> ReadingFrames:
        """Some of the frames."""
        return ReadingFrames(
            self.time[rows], self.key[rows], self.within[rows], self.values[rows], self.state[rows]
        )

    def followed_by(self, other: ReadingFrames) -> ReadingFrames:
        """These frames and those."""
        return ReadingFrames(
            np.concatenate([self.time, other.time]),
            np.concatenate([self.key, other.key]),
            np.concatenate([self.within, other.within]),
            np.concatenate([self.values, other.values]),
            np.concatenate([self.state, other.state]),
        )


def no_frames(width: int) -> ReadingFrames:
    """No frames, of so many readings each."""
    return ReadingFrames(
        np.empty(0),
        np.empty(0, np.int64),
        np.empty(0, np.uint8),
        np.empty((0, width)),
        np.empty((0, width), np.uint8),
    )


def frames_of(
    readings: Readings, columns: MessageColumns, own: NDArray[np.int64] | slice
) -> ReadingFrames:
    """The frames of a block, or some of them; all is copied.

    Raises
    ------
    ColumnsError
        A signal was not decoded, or to raw values.
    """
    for name in (readings.group, readings.number, *readings.items):
        if name not in columns.columns:
            raise ColumnsError(
                f"{readings.name} need all signals of {readings.message}: decode {name}"
            )
    items = [columns.columns[name] for name in readings.items]
    if not all(item.signal.scaled for item in items):
        raise ColumnsError(f"{readings.name} are made of physical values, not of raw ones")
    values = np.stack([item.values[own] for item in items], axis=1, dtype=np.float64)
    state = np.stack([_state(item)[own] for item in items], axis=1)
    values[state != State.VALUE] = np.nan
    transfer = readings.parts.transfer
    number = columns.columns[readings.number].values[own].astype(np.int64)
    group_column = columns.columns[readings.group]
    raw = group_column.values[own].astype(np.int64)
    group = raw + (1 - transfer.first_group)
    group[np.isin(raw, readings.no_group)] = 0
    if group_column.valid is not None:
        group[~group_column.valid[own]] = 0
    number += 1 - transfer.first_number
    number[number >= 1 << NUMBER_BITS] = 0
    key = (group << NUMBER_BITS) | number
    return ReadingFrames(
        columns.timestamp[own], key, _within(readings, values, state), values, state
    )


def _state(column: Column) -> NDArray[np.uint8]:
    if column.state is None:
        return np.zeros(len(column.values), np.uint8)
    return column.state


def _within(
    readings: Readings, values: NDArray[np.float64], state: NDArray[np.uint8]
) -> NDArray[np.uint8]:
    """The last reading of each frame that has a value; one that is abnormal is there."""
    there = state != State.INVALID
    for position, (low, high) in enumerate(fills_of(readings.parts)):
        there[:, position] &= ~((low < values[:, position]) & (values[:, position] < high))
    within = np.zeros(len(state), np.uint8)
    for position in range(state.shape[1]):
        within[there[:, position]] = position + 1
    return within
