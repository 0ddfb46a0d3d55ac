"""The frames of a chunk that no message's frames hold, in groups by their identifiers."""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.wire.message import Message

EXTENDED = 1 << 31
"""Set in a key beside the identifier where that has 29 bits."""

_MESSAGES = {message.FRAME_ID | EXTENDED: message for message in PROTOCOL.messages}
KEYS = np.array(list(_MESSAGES), np.uint32)
"""Those of the protocol, as `LeftOver` has them."""


@dataclass(frozen=True, slots=True)
class LeftOver:
    """Frames of unknown identifiers, and those of a wrong kind, length or channel.

    Parameters
    ----------
    errors
        int64, rows of the block that are error frames; they are in none of the rest.
    keys
        uint32, the different identifiers with `EXTENDED`, ascending.
    rows
        int64, rows of the block, in the order of ``keys`` and ascending for each.
    bounds
        int64, where in ``rows`` each of ``keys`` begins, and where the last ends.
    """

    errors: NDArray[np.int64]
    keys: NDArray[np.uint32]
    rows: NDArray[np.int64]
    bounds: NDArray[np.int64]

    def of(self, places: NDArray[np.int64]) -> list[tuple[int, NDArray[np.int64]]]:
        """The keys at some places, and the rows of each."""
        return [
            (int(self.keys[place]), self.rows[self.bounds[place] : self.bounds[place + 1]])
            for place in places.tolist()
        ]

    def by_message(self) -> list[tuple[type[Message], NDArray[np.int64]]]:
        """Where identifiers of the protocol are left over, their messages and rows."""
        known = np.flatnonzero(np.isin(self.keys, KEYS))
        return [(_MESSAGES[key], rows) for key, rows in self.of(known)]


_NONE = np.empty(0, np.int64)
_NOTHING = LeftOver(_NONE, np.empty(0, np.uint32), _NONE, np.zeros(1, np.int64))
_made: WeakKeyDictionary[Chunk, LeftOver] = WeakKeyDictionary()


def left_over(chunk: Chunk) -> LeftOver:
    """What is left of a chunk; made once for all rules that ask."""
    found = _made.get(chunk)
    if found is None:
        found = _made[chunk] = _left_over(chunk)
    return found


def _left_over(chunk: Chunk) -> LeftOver:
    block = chunk.block
    every = [chunk.frames(message) for message in PROTOCOL.messages]
    if sum(series.fresh for series in every) == len(block):
        return _NOTHING
    others = np.ones(len(block), np.bool_)
    for series in every:
        others[series.order[series.first :] - chunk.first_order] = False
    errors = others & ((block.flags & FrameFlag.ERROR) != 0)
    return _grouped(block, np.flatnonzero(errors), np.flatnonzero(others & ~errors))


def _grouped(block: FrameBlock, errors: NDArray[np.int64], rows: NDArray[np.int64]) -> LeftOver:
    extended = (block.flags[rows] & np.uint8(FrameFlag.EXTENDED)).astype(np.uint32)
    keys = block.frame_id[rows] | (extended << np.uint32(31))
    # Numbers of 16 bits are sorted by their digits: two rounds of it are faster than one sort.
    order = np.argsort(keys.astype(np.uint16), kind="stable")
    order = order[np.argsort((keys[order] >> np.uint32(16)).astype(np.uint16), kind="stable")]
    keys = keys[order]
    begins = np.flatnonzero(np.diff(keys, prepend=~keys[:1]))
    return LeftOver(errors, keys[begins], rows[order], np.append(begins, len(rows)))
