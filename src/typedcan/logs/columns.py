"""What the vectorised decoder gives: columns by message and signal, and what was left out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock
from typedcan.model import j1939


class State(IntEnum):
    """What a raw code says: a value, or in place of one that there is none."""

    VALUE = 0
    INVALID = 1
    ABNORMAL = 2


@dataclass(frozen=True, slots=True)
class SignalInfo:
    """What is known of a column beside its values.

    Parameters
    ----------
    name, unit
        As in the database; the unit is empty where there is none.
    factor, offset
        Physical value = raw value x factor + offset, whichever of the two the column holds.
    scaled
        Whether the column holds physical values; else it holds raw ones.
    labels
        Raw codes with a label, as in the database.
    encoded
        Whether the values are to be shown by their labels (``Mode.LABELS``).
    """

    name: str
    unit: str
    factor: float
    offset: float
    scaled: bool
    labels: Mapping[int, str]
    encoded: bool


@dataclass(slots=True)
class Column:
    """The values of one signal, one per frame of its message.

    Parameters
    ----------
    signal
        Name, unit, labels, scaling.
    values
        One-dimensional and contiguous. An integer type, a float type, or Python integers
        (``object``) where 64 bits do not hold them. Where ``valid`` is False a value means nothing.
    valid
        False where there is no value: a reserved code, or a branch of a multiplexed message that
        the frame has not. None: all are valid.
    state
        `State` of each value as uint8, 0 where the frame has not the signal. None: no code of
        the signal is reserved.
    """

    signal: SignalInfo
    values: NDArray[Any]
    valid: NDArray[np.bool_] | None
    state: NDArray[np.uint8] | None


@dataclass(slots=True)
class MessageColumns:
    """All frames of one message in one block, in their order.

    Parameters
    ----------
    name, frame_id, is_extended
        The message's.
    block
        The frames that were decoded.
    rows
        int64, which of them are this message's, ascending.
    columns
        The signals by name, in the order of the database.
    by_pgn
        Whether its frames are found by their PGN: then they differ in their addresses.
    """

    name: str
    frame_id: int
    is_extended: bool
    block: FrameBlock
    rows: NDArray[np.int64]
    columns: dict[str, Column]
    by_pgn: bool = False

    @property
    def timestamp(self) -> NDArray[np.float64]:
        """Seconds, one per row."""
        return self.block.timestamp[self.rows]

    @property
    def channel(self) -> NDArray[np.int16]:
        """Index into ``block.channels``, one per row."""
        return self.block.channel[self.rows]

    @property
    def addresses(self) -> tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[np.uint8]]:
        """The J1939 source addresses, destinations (255 for all) and priorities, one per row."""
        return addresses_of(self.block.frame_id[self.rows])

    def __len__(self) -> int:
        """How many frames."""
        return len(self.rows)


def addresses_of(
    frame_id: NDArray[np.uint32],
) -> tuple[NDArray[np.uint8], NDArray[np.uint8], NDArray[np.uint8]]:
    """What SAE J1939 reads in identifiers: source addresses, destinations and priorities."""
    numbers = np.unique(frame_id)
    at = np.searchsorted(numbers, frame_id)
    listed = numbers.tolist()
    source, receiver, priority = (
        np.array([read(number) for number in listed], np.uint8)[at]
        for read in (j1939.source_address, j1939.destination, j1939.priority)
    )
    return source, receiver, priority


@dataclass(slots=True)
class Counts:
    """What became of the frames; each is counted once beside ``frames`` and ``without_branch``.

    Parameters
    ----------
    frames
        All that came in.
    decoded
        By name of the message.
    remote, error
        Remote frames and error frames.
    unknown
        By identifier and whether it is extended: no message of the database.
    unwanted
        Frames of messages that were not asked for.
    too_short
        By name of the message: fewer bytes than it has.
    without_branch
        By name of the message, decoded frames with a multiplexer whose value selects nothing and
        has no label: signals of its branches are not there.
    """

    frames: int = 0
    decoded: Counter[str] = field(default_factory=Counter[str])
    remote: int = 0
    error: int = 0
    unknown: Counter[tuple[int, bool]] = field(default_factory=Counter[tuple[int, bool]])
    unwanted: int = 0
    too_short: Counter[str] = field(default_factory=Counter[str])
    without_branch: Counter[str] = field(default_factory=Counter[str])

    def add(self, other: Counts) -> None:
        """Add the counts of another block."""
        self.frames += other.frames
        self.remote += other.remote
        self.error += other.error
        self.unwanted += other.unwanted
        self.decoded.update(other.decoded)
        self.unknown.update(other.unknown)
        self.too_short.update(other.too_short)
        self.without_branch.update(other.without_branch)


@dataclass(slots=True)
class DecodedBlock:
    """One block decoded: the messages that occur in it, by name, and what became of its frames."""

    messages: dict[str, MessageColumns]
    counts: Counts
