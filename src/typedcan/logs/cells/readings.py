"""The frames that carry what is measured by CSC, as columns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import Column, MessageColumns, State
from typedcan.logs.grouped import KEY_BITS, Readings
from typedcan.model.errors import TypedcanError


class CellsError(TypedcanError, ValueError):
    """What was decoded is not what cells and probes are made of."""


@dataclass(frozen=True, slots=True)
class ReadingFrames:
    """Frames of one message on one channel, in their order; n rows.

    Parameters
    ----------
    time
        Seconds.
    key
        CSC and frame number in one; the CSC is 0 where the frame has none.
    highest
        The last reading of the CSC that has a value in this frame, from 1; 0 for none.
    values, state
        The readings and their `State`, shape (n, readings in a frame).
    """

    time: NDArray[np.float64]
    key: NDArray[np.int32]
    highest: NDArray[np.int32]
    values: NDArray[np.float64]
    state: NDArray[np.uint8]

    def __len__(self) -> int:
        """How many frames."""
        return len(self.time)

    def rows(self, rows: NDArray[np.int64]) -> ReadingFrames:
        """Some of the frames."""
        return ReadingFrames(
            self.time[rows], self.key[rows], self.highest[rows], self.values[rows], self.state[rows]
        )

    def followed_by(self, other: ReadingFrames) -> ReadingFrames:
        """These frames and those."""
        return ReadingFrames(
            np.concatenate([self.time, other.time]),
            np.concatenate([self.key, other.key]),
            np.concatenate([self.highest, other.highest]),
            np.concatenate([self.values, other.values]),
            np.concatenate([self.state, other.state]),
        )


def no_frames(width: int) -> ReadingFrames:
    """No frames, of so many readings each."""
    return ReadingFrames(
        np.empty(0),
        np.empty(0, np.int32),
        np.empty(0, np.int32),
        np.empty((0, width)),
        np.empty((0, width), np.uint8),
    )


def frames_of(
    readings: Readings, columns: MessageColumns, own: NDArray[np.int64] | slice
) -> ReadingFrames:
    """The frames of a block, or some of them; all is copied.

    Raises
    ------
    CellsError
        A signal was not decoded, or to raw values.
    """
    for name in (readings.csc, readings.number, *readings.items):
        if name not in columns.columns:
            raise CellsError(
                f"{readings.name} need all signals of {readings.message}: decode {name}"
            )
    items = [columns.columns[name] for name in readings.items]
    if not all(item.signal.scaled for item in items):
        raise CellsError(f"{readings.name} are made of physical values, not of raw ones")
    values = np.stack([item.values[own] for item in items], axis=1, dtype=np.float64)
    state = np.stack([_state(item)[own] for item in items], axis=1)
    values[state != State.VALUE] = np.nan
    number = columns.columns[readings.number].values[own].astype(np.int32)
    csc_column = columns.columns[readings.csc]
    csc = csc_column.values[own].astype(np.int32)
    csc[np.isin(csc, readings.no_csc)] = 0
    if csc_column.valid is not None:
        csc[~csc_column.valid[own]] = 0
    return ReadingFrames(
        columns.timestamp[own], (csc << KEY_BITS) | number, _highest(state, number), values, state
    )


def _state(column: Column) -> NDArray[np.uint8]:
    if column.state is None:
        return np.zeros(len(column.values), np.uint8)
    return column.state


def _highest(state: NDArray[np.uint8], number: NDArray[np.int32]) -> NDArray[np.int32]:
    """Counted over the frames of the CSC; a reading that is abnormal is there."""
    width = state.shape[1]
    within = np.zeros(len(state), np.int32)
    for position in range(width):
        within[state[:, position] != State.INVALID] = position + 1
    return np.where(within > 0, (number - 1) * width + within, 0).astype(np.int32)
