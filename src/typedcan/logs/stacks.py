"""Signals of one message that numpy treats alike, stacked so that one call serves all of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import State
from typedcan.logs.lanes import Lane
from typedcan.logs.scaling import Scaling

UINT8, UINT64 = np.dtype(np.uint8), np.dtype(np.uint64)


@dataclass(frozen=True, slots=True)
class Part:
    """A signal to be decoded by numpy.

    Parameters
    ----------
    name
        Of the signal.
    lane
        Where its bits are.
    signed
        Whether the raw value is in two's complement.
    raw
        Type of the raw value.
    scaling
        To the column's values.
    reserved
        Raw codes that are no value.
    """

    name: str
    lane: Lane
    signed: bool
    raw: np.dtype[Any]
    scaling: Scaling
    reserved: Mapping[int, State]

    @property
    def in_bytes(self) -> bool:
        """Whether the signal is put together from one byte or two, not cut out of a word."""
        return self.lane.bits <= 8 and self.lane.width <= 2

    @property
    def likeness(self) -> tuple[object, ...]:
        """The same for all signals that can share a stack."""
        scaled = None if self.scaling.factor is None else self.scaling.dtype.str
        width = 1 if self.in_bytes else self.lane.width
        return width, self.raw.str, scaled, bool(self.reserved)


@dataclass(frozen=True, slots=True)
class ByteLoad:
    """Consecutive bytes of the payload, from and up to, to consecutive rows from ``row`` on."""

    row: int
    start: int
    stop: int


@dataclass(frozen=True, slots=True)
class WordLoad:
    """A word of the payload into one row."""

    row: int
    byte: int
    dtype: np.dtype[Any]


@dataclass(frozen=True, slots=True)
class Stack:
    """A table with a row per signal and a column per frame, and what is done to it in turn.

    Parameters
    ----------
    names
        The signals, by row: those that take a second byte, the others that have to be shifted,
        those that have to be cut, those that fill their word.
    lane, raw
        Type of the words, and of the raw values.
    low, high
        Where words are bytes: which of the loaded bytes holds the lower bits, and, for the first
        rows, the upper ones.
    lifts, caps
        For the first rows, by how much the upper byte has to be shifted left, and which bits of it
        to keep then; eight bytes at a time.
    words
        What is loaded where words are longer.
    shifts, masks
        A number per row, from the first row on, as many rows as need it: by how much to shift
        right, and which bits to keep. They are for eight bytes at a time, several words at once:
        what a shift moves into the neighbour is cut off there.
    signs
        The sign bit, for the first rows.
    scaling
        Type of the column's values; None: raw values.
    factors, offsets
        A number per row; None: 1, 0.
    codes, states
        Reserved codes, a table per rank: a row per signal; and the state each stands for.
    """

    names: tuple[str, ...]
    lane: np.dtype[Any]
    raw: np.dtype[Any]
    low: NDArray[np.intp]
    high: NDArray[np.intp]
    lifts: NDArray[np.uint64]
    caps: NDArray[np.uint64]
    words: tuple[WordLoad, ...]
    shifts: NDArray[np.uint64]
    masks: NDArray[np.uint64]
    signs: NDArray[Any]
    scaling: np.dtype[Any] | None
    factors: NDArray[Any] | None
    offsets: NDArray[Any] | None
    codes: tuple[NDArray[Any], ...]
    states: tuple[NDArray[np.uint8], ...]


def stacks_of(parts: Iterable[Part]) -> tuple[tuple[ByteLoad, ...], tuple[Stack, ...]]:
    """Put the signals that are alike in one stack; the bytes are loaded once for all stacks."""
    alike: dict[object, list[Part]] = {}
    loaded: set[int] = set()
    for part in parts:
        alike.setdefault(part.likeness, []).append(part)
        if part.in_bytes:
            loaded.update(range(part.lane.byte, part.lane.byte + part.lane.width))
    rows = {byte: row for row, byte in enumerate(sorted(loaded))}
    return _runs(rows), tuple(_stack(members, rows) for members in alike.values())


def _runs(rows: Mapping[int, int]) -> tuple[ByteLoad, ...]:
    runs: list[ByteLoad] = []
    for byte, row in rows.items():
        if runs and byte == runs[-1].stop:
            runs[-1] = ByteLoad(runs[-1].row, runs[-1].start, byte + 1)
        else:
            runs.append(ByteLoad(row, byte, byte + 1))
    return tuple(runs)


def _stack(parts: list[Part], rows: Mapping[int, int]) -> Stack:
    parts = sorted(
        parts,
        key=lambda part: (-part.lane.width, part.lane.whole, not part.lane.shift, part.lane.byte),
    )
    lanes = [part.lane for part in parts]
    in_bytes = parts[0].in_bytes
    dtype = np.dtype(UINT8 if in_bytes else f"u{lanes[0].width}")
    pairs = [lane for lane in lanes if in_bytes and lane.width > 1]
    partial = [lane for lane in lanes if not lane.whole]
    codes, states = _reserved(parts)
    return Stack(
        names=tuple(part.name for part in parts),
        lane=dtype,
        raw=parts[0].raw,
        low=np.array([rows[_low_byte(lane)] for lane in lanes if in_bytes], np.intp),
        high=np.array([rows[_high_byte(lane)] for lane in pairs], np.intp),
        lifts=_column([8 - lane.shift for lane in pairs], UINT64),
        caps=_masks([_ones(lane.bits) & ~_ones(8 - lane.shift) for lane in pairs], dtype),
        words=() if in_bytes else _word_loads(lanes),
        shifts=_column([lane.shift for lane in lanes if lane.shift], UINT64),
        masks=_masks([_first_bits(lane, dtype) for lane in partial], dtype),
        signs=_column([1 << lane.bits - 1 for lane in partial if parts[0].signed], dtype),
        codes=codes,
        states=states,
        **_factors(parts),
    )


def _ones(bits: int) -> int:
    return (1 << bits) - 1


def _first_bits(lane: Lane, dtype: np.dtype[Any]) -> int:
    """Which bits of the first word are the signal's, after the shift."""
    return _ones(min(lane.bits, 8 * dtype.itemsize - lane.shift))


def _masks(masks: Sequence[int], dtype: np.dtype[Any]) -> NDArray[Any]:
    """The mask of one word for all words in eight bytes."""
    words = _column(masks, dtype).repeat(8 // dtype.itemsize, axis=1)
    return words.view(UINT64)


def _low_byte(lane: Lane) -> int:
    return lane.byte + lane.width - 1 if lane.big_endian else lane.byte


def _high_byte(lane: Lane) -> int:
    return lane.byte if lane.big_endian else lane.byte + lane.width - 1


def _column(numbers: Sequence[float], dtype: np.dtype[Any]) -> NDArray[Any]:
    return np.array(numbers, dtype).reshape(-1, 1)


def _word_loads(lanes: Sequence[Lane]) -> tuple[WordLoad, ...]:
    return tuple(
        WordLoad(row, lane.byte, np.dtype(f"{'>' if lane.big_endian else '<'}u{lane.width}"))
        for row, lane in enumerate(lanes)
    )


def _factors(parts: Sequence[Part]) -> dict[str, Any]:
    """The scaling of a stack, in the type in which it is calculated."""
    scalings = [part.scaling for part in parts]
    given = [(scaling.factor, scaling.offset) for scaling in scalings if scaling.factor is not None]
    if not given:
        return {"scaling": None, "factors": None, "offsets": None}
    dtype = scalings[0].dtype
    number = UINT64 if dtype.kind in "iu" else dtype
    factors = _column([factor for factor, _ in given], number)
    offsets = _column([offset for _, offset in given], number)
    # Adding 0 makes 0 of -0, as it does in cantools; adding -0 changes nothing.
    minus = parts[0].raw.kind == "f" or bool((factors <= 0).any())
    adding = bool(offsets.any()) or (minus and not bool(np.signbit(offsets).all()))
    return {
        "scaling": dtype,
        "factors": factors if (factors != 1).any() else None,
        "offsets": offsets if adding else None,
    }


def _reserved(
    parts: Sequence[Part],
) -> tuple[tuple[NDArray[Any], ...], tuple[NDArray[np.uint8], ...]]:
    most = max(len(part.reserved) for part in parts)
    # A signal with fewer codes repeats its first: states are joined, so that changes nothing.
    ranks = [
        [(own := sorted(part.reserved))[rank if rank < len(own) else 0] for part in parts]
        for rank in range(most)
    ]
    codes = tuple(_column(rank, parts[0].raw) for rank in ranks)
    states = tuple(
        _column([part.reserved[code] for part, code in zip(parts, rank, strict=True)], UINT8)
        for rank in ranks
    )
    return codes, states
