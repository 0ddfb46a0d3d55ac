"""Where the objects of a BLF log begin, for a stretch of inflated bytes at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.read.blf_layouts import FRAME_TYPES

SIGNATURE = b"LOBJ"
BASE_SIZE = 16
"""Signature, header size and version, object size and type: what every object begins with."""

MAX_FRAME_SIZE = 4096
"""No frame's object is larger; one of another type may have any size."""

_SIZE = np.dtype({"names": ["size"], "formats": ["<u4"], "offsets": [8], "itemsize": BASE_SIZE})
_WORD = int.from_bytes(SIGNATURE, "little")
_ZEROS = 32  # at most so many behind the last object of all
_PADDING = 4  # at most so many bytes between an object and the next


@dataclass(frozen=True, slots=True)
class Scan:
    """What a stretch of bytes holds.

    Parameters
    ----------
    starts
        int64, the offsets of all objects that are complete.
    stop
        Where the first one begins that is not.
    missing
        So many bytes beyond the stretch belong to an object that may be passed over, else 0.
    problem
        What is wrong at ``stop``, or None.
    """

    starts: NDArray[np.int64]
    stop: int
    missing: int = 0
    problem: str | None = None


def scan(data: bytes) -> Scan:
    """Find the objects: a signature, and then each one where its neighbour ends."""
    for alignments in (1, 4):  # nearly always all of them begin at multiples of four
        starts = _signatures(data, alignments)
        sizes = records(data, starts, _SIZE)["size"].astype(np.int64)
        if _is_chain(starts, sizes, len(data)):
            last = int(starts[-1] + sizes[-1])
            if last <= len(data):
                return Scan(starts, last)
            return _incomplete(data, starts[:-1], int(starts[-1]))
    return _walk(data)


def records(data: bytes, starts: NDArray[np.int64], record: np.dtype[np.void]) -> NDArray[np.void]:
    """Copies of the structures that begin at ``starts``, each of them within ``data``."""
    size = record.itemsize
    if len(data) < size:
        return np.empty(0, record)
    # taken as plain bytes: numpy copies a structure field by field
    every = np.ndarray((len(data) - size + 1,), f"V{size}", data, strides=(1,))
    return every[starts].view(record)


def _signatures(data: bytes, alignments: int) -> NDArray[np.int64]:
    """Where a signature stands with room for an object's base behind it."""
    places = []
    for shift in range(alignments):
        count = max(len(data) - shift, 0) // 4
        words = np.frombuffer(data[shift:] if shift else data, "<u4", count)
        places.append(np.flatnonzero(words == _WORD) * 4 + shift)
    starts = np.sort(np.concatenate(places)) if alignments > 1 else places[0]
    return starts[: np.searchsorted(starts, len(data) - BASE_SIZE, side="right")]


def _is_chain(starts: NDArray[np.int64], sizes: NDArray[np.int64], end: int) -> bool:
    """Whether each object begins where the one before it ends, from end to end."""
    if not len(starts) or starts[0] > _PADDING or sizes[-1] < BASE_SIZE:
        return False
    gaps = starts[1:] - (starts + sizes)[:-1]
    left = end - int(starts[-1] + sizes[-1])
    return left < BASE_SIZE + _PADDING and bool(((gaps >= 0) & (gaps <= _PADDING)).all())


def _walk(data: bytes) -> Scan:
    """The same from object to object: payloads may hold a signature."""
    starts: list[int] = []
    end = 0

    def found(problem: str | None = None) -> Scan:
        return Scan(np.array(starts, np.int64), end, 0, problem)

    while True:
        start = data.find(SIGNATURE, end, end + _PADDING + len(SIGNATURE))
        if start < 0 or start + BASE_SIZE > len(data):
            rest = data[end : end + _ZEROS + 1]
            if starts and len(rest) <= _ZEROS and not any(rest):
                return found()  # some programs write more of them than there should be
            enough = len(data) - end >= BASE_SIZE + _PADDING
            return found("no object begins here" if enough else None)
        size = int.from_bytes(data[start + 8 : start + 12], "little")
        if size < BASE_SIZE:
            end = start
            return found(f"an object of {size} bytes")
        if start + size > len(data):
            return _incomplete(data, np.array(starts, np.int64), start)
        starts.append(start)
        end = start + size


def _incomplete(data: bytes, starts: NDArray[np.int64], start: int) -> Scan:
    """What to do about an object that goes on in the next container."""
    size = int.from_bytes(data[start + 8 : start + 12], "little")
    if int.from_bytes(data[start + 12 : start + 16], "little") not in FRAME_TYPES:
        return Scan(starts, start, start + size - len(data))
    too_long = f"a frame of {size:,} bytes" if size > MAX_FRAME_SIZE else None
    return Scan(starts, start, 0, too_long)
