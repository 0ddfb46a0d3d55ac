"""Which message each frame is of: identifiers hashed without collisions, frames put in groups."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.buffers import Buffers
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.model.j1939 import ByPgn

_UINT32, _INTP = np.dtype(np.uint32), np.dtype(np.intp)
_FLAGS = np.uint8(FrameFlag.EXTENDED | FrameFlag.REMOTE | FrameFlag.ERROR)
_FLAG_SHIFT = np.uint32(29)
_ALL_BITS = np.uint32(0x1FFFFFFF)
_CHUNK = 1 << 15
"""Frames looked up at a time, so that what is made in between stays in cache."""
_HASH_BITS = 16
_TRIES = 200


class Identifiers:
    """Finds the place of each frame's identifier in a list, by numbers of its own.

    Parameters
    ----------
    identifiers
        Bare identifier and whether it is extended, no two the same.
    mask
        Bits of an identifier that count.
    by_pgn
        Finds places by the PGN of identifiers that are not in the list.
    """

    def __init__(
        self,
        identifiers: Sequence[tuple[int, bool]],
        mask: int,
        by_pgn: ByPgn[int] | None = None,
    ) -> None:
        self._by_pgn = by_pgn
        self._mask = np.uint32(mask) & _ALL_BITS
        keys = [(number & int(self._mask)) | extended << 29 for number, extended in identifiers]
        self._count = len(keys)
        self._buffers = Buffers()
        self._keys = np.array(keys, np.uint32)
        self._places = np.dtype(np.uint8 if len(keys) < 1 << 8 else np.uint16)
        self._hash = _perfect_hash(self._keys)
        if self._hash is not None:
            multiplier, shift = self._hash
            slots = (self._keys * multiplier) >> shift
            size = 1 << (32 - int(shift))
            # An empty slot holds a key that has its slot elsewhere: nothing compares equal there.
            self._slot_key = np.full(size, self._keys[0])
            self._slot_key[slots] = self._keys
            self._slot_place = np.zeros(size, self._places)
            self._slot_place[slots] = np.arange(self._count)
        else:
            self._order = np.argsort(self._keys)

    def places(self, block: FrameBlock) -> NDArray[Any]:
        """Index into the list for each frame, the length of the list for one that is not in it.

        Remote and error frames are never in it. The result holds until the next call.
        """
        places = self._buffers.array("places", (len(block),), self._places)
        if not self._count:
            places[:] = 0
            return places
        for start in range(0, len(block), _CHUNK):
            stop = start + _CHUNK
            keys = self.keys(block.frame_id[start:stop], block.flags[start:stop])
            self._find(keys, places[start:stop])
            if self._by_pgn:
                ids, flags = block.frame_id[start:stop], block.flags[start:stop]
                self._find_by_pgn(self._by_pgn, ids, flags, places[start:stop])
        return places

    def _find_by_pgn(
        self,
        by_pgn: ByPgn[int],
        frame_id: NDArray[np.uint32],
        flags: NDArray[np.uint8],
        places: NDArray[Any],
    ) -> None:
        """Find the frames that have no place yet, once for each of their identifiers."""
        rows = np.flatnonzero((places == self._count) & ((flags & _FLAGS) == FrameFlag.EXTENDED))
        if not len(rows):
            return
        numbers, inverse = np.unique(frame_id[rows], return_inverse=True)
        found = [by_pgn.find(number) for number in numbers.tolist()]
        known = [self._count if place is None else place for place in found]
        places[rows] = np.array(known, self._places)[inverse]

    def keys(self, frame_id: NDArray[np.uint32], flags: NDArray[np.uint8]) -> NDArray[np.uint32]:
        """Identifier and kind (extended, remote, error) in one number; until the next call."""
        keys = self._buffers.array("keys", frame_id.shape, _UINT32)
        kinds = np.bitwise_and(flags, _FLAGS)
        first = kinds[0] if len(kinds) else _FLAGS
        if (kinds == first).all():
            np.bitwise_or(frame_id, np.uint32(first) << _FLAG_SHIFT, out=keys)
        else:
            np.left_shift(kinds, _FLAG_SHIFT, out=keys)
            np.bitwise_or(keys, frame_id, out=keys)
        if self._mask != _ALL_BITS:
            np.bitwise_and(keys, self._mask | ~_ALL_BITS, out=keys)
        return keys

    def _find(self, keys: NDArray[np.uint32], places: NDArray[Any]) -> None:
        if self._hash is None:
            at = np.searchsorted(self._keys, keys, sorter=self._order)
            index = self._order[np.minimum(at, self._count - 1)]
            known = self._keys[index] == keys
            places[:] = index
        else:
            slots = self._buffers.array("slots", keys.shape, _UINT32)
            index = self._buffers.array("index", keys.shape, _INTP)
            np.multiply(keys, self._hash[0], out=slots)
            np.right_shift(slots, self._hash[1], out=slots)
            np.copyto(index, slots)
            # With its default mode, take would go through a copy.
            np.take(self._slot_key, index, out=slots, mode="clip")
            known = slots == keys
            np.take(self._slot_place, index, out=places, mode="clip")
        if not known.all():
            places[~known] = self._count


def groups(places: NDArray[Any], count: int) -> tuple[NDArray[np.int64], list[int]]:
    """Rows in the order of their places, and where each of the places 0 to ``count`` begins.

    Rows of one place keep their order. The last of the bounds is the number of rows.
    """
    rows: NDArray[np.int64] = places.argsort(kind="stable").astype(np.int64, copy=False)
    wanted = np.arange(count + 1, dtype=places.dtype)
    bounds = np.searchsorted(places, wanted, sorter=rows).tolist()
    return rows, [*bounds, len(rows)]


def split_key(key: int) -> tuple[int, FrameFlag]:
    """The bare identifier and the kind that `Identifiers.keys` put together."""
    return key & int(_ALL_BITS), FrameFlag(key >> int(_FLAG_SHIFT))


def _perfect_hash(keys: NDArray[np.uint32]) -> tuple[np.uint32, np.uint32] | None:
    """Multiplier and shift that send no two keys to one slot; None where none was found."""
    if not len(keys):
        return None
    source = np.random.default_rng(1)
    for shift in _shifts(len(keys)):
        for multiplier in source.integers(1 << 31, 1 << 32, _TRIES, dtype=np.uint32) | 1:
            slots = (keys * multiplier) >> shift
            if len(np.unique(slots)) == len(keys):
                return np.uint32(multiplier), shift
    return None


def _shifts(count: int) -> Iterator[np.uint32]:
    for bits in range(max(4, count.bit_length() + 2), _HASH_BITS + 1, 2):
        yield np.uint32(32 - bits)
