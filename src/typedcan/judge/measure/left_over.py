"""The frames of a chunk that no message's frames hold, in groups by their identifiers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.decoded import DecodedChunk
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.model.j1939 import ByPgn
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

EXTENDED = 1 << 31
"""Set in a key beside the identifier where that has 29 bits."""


def keys_of(protocol: Protocol) -> dict[int, type[Message]]:
    """The messages of a protocol by their identifiers, as `LeftOver` has them."""
    return {
        message.FRAME_ID | (EXTENDED if message.EXTENDED else 0): message
        for message in protocol.messages
    }


def by_pgn_of(protocol: Protocol) -> ByPgn[int]:
    """Finds the keys of messages by the PGN of other identifiers."""
    return ByPgn((message.MODEL, key) for key, message in keys_of(protocol).items())


@dataclass(frozen=True, slots=True)
class LeftOver:
    """Frames of unknown identifiers, and those of a wrong kind, length or channel.

    Parameters
    ----------
    errors
        int64, rows of the block that are error frames; they are in none of the rest.
    keys
        uint32, the different identifiers with `EXTENDED`, ascending; where a message is found by
        its PGN, that of the message.
    rows
        int64, rows of the block, in the order of ``keys`` and ascending for each.
    bounds
        int64, where in ``rows`` each of ``keys`` begins, and where the last ends.
    messages
        The messages of the protocol by their keys.
    """

    errors: NDArray[np.int64]
    keys: NDArray[np.uint32]
    rows: NDArray[np.int64]
    bounds: NDArray[np.int64]
    messages: Mapping[int, type[Message]]

    def of(self, places: NDArray[np.int64]) -> list[tuple[int, NDArray[np.int64]]]:
        """The keys at some places, and the rows of each."""
        return [
            (int(self.keys[place]), self.rows[self.bounds[place] : self.bounds[place + 1]])
            for place in places.tolist()
        ]

    def of_messages(self) -> list[tuple[type[Message], NDArray[np.int64]]]:
        """Where identifiers of the protocol are left over, their messages and rows."""
        known = np.isin(self.keys, np.fromiter(self.messages, np.uint32))
        return [(self.messages[key], rows) for key, rows in self.of(np.flatnonzero(known))]


_NONE = np.empty(0, np.int64)


def left_over(
    chunk: DecodedChunk, messages: Mapping[int, type[Message]], by_pgn: ByPgn[int]
) -> LeftOver:
    """What is left of a chunk; ``messages`` as `keys_of` gives them, ``by_pgn`` as `by_pgn_of`."""
    block = chunk.block
    every = [chunk.frames(message) for message in messages.values()]
    known = sum(series.fresh for series in every)
    known += 0 if chunk.others is None else len(chunk.others)
    if known == len(block):
        return LeftOver(_NONE, np.empty(0, np.uint32), _NONE, np.zeros(1, np.int64), messages)
    others = np.ones(len(block), np.bool_)
    for series in every:
        others[series.order[series.first :] - chunk.first_order] = False
    if chunk.others is not None:
        others[chunk.others] = False
    errors = others & ((block.flags & FrameFlag.ERROR) != 0)
    rows = np.flatnonzero(others & ~errors)
    keys = _keys(block, rows)
    if by_pgn:
        numbers, places = np.unique(keys, return_inverse=True)
        found = [_key_of(number, messages, by_pgn) for number in numbers.tolist()]
        keys = np.array(found, np.uint32)[places]
    return LeftOver(np.flatnonzero(errors), *_grouped(keys, rows), messages)


def _keys(block: FrameBlock, rows: NDArray[np.int64]) -> NDArray[np.uint32]:
    extended = (block.flags[rows] & np.uint8(FrameFlag.EXTENDED)).astype(np.uint32)
    return block.frame_id[rows] | (extended << np.uint32(31))


def _key_of(key: int, messages: Mapping[int, type[Message]], by_pgn: ByPgn[int]) -> int:
    if key in messages or not key & EXTENDED:
        return key
    found = by_pgn.find(key & ~EXTENDED)
    return key if found is None else found


def _grouped(
    keys: NDArray[np.uint32], rows: NDArray[np.int64]
) -> tuple[NDArray[np.uint32], NDArray[np.int64], NDArray[np.int64]]:
    """The keys, rows and bounds of `LeftOver`."""
    # Numbers of 16 bits are sorted by their digits: two rounds of it are faster than one sort.
    order = np.argsort(keys.astype(np.uint16), kind="stable")
    order = order[np.argsort((keys[order] >> np.uint32(16)).astype(np.uint16), kind="stable")]
    keys = keys[order]
    begins = np.flatnonzero(np.diff(keys, prepend=~keys[:1]))
    return keys[begins], rows[order], np.append(begins, len(rows))
