"""The frames that carry readings by group, as columns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import Column, MessageColumns, State
from typedcan.logs.grouped import Readings
from typedcan.model.errors import TypedcanError
from typedcan.model.transfers.cycle import NUMBER_BITS
from typedcan.model.transfers.reading_rules import fills_of


class TransferError(TypedcanError, ValueError):
    """What was decoded is not what the values of a transfer are made of."""


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
    TransferError
        A signal was not decoded, or to raw values.
    """
    for name in (readings.group, readings.number, *readings.items):
        if name not in columns.columns:
            raise TransferError(
                f"{readings.name} need all signals of {readings.message}: decode {name}"
            )
    items = [columns.columns[name] for name in readings.items]
    if not all(item.signal.scaled for item in items):
        raise TransferError(f"{readings.name} are made of physical values, not of raw ones")
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
