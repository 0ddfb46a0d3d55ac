"""Checksums and counters of many payloads at once: rows of bytes to columns."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, reduce
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.model.checksums.methods import Crc, Method, Sum
from typedcan.model.checksums.registry import Given, chosen_of
from typedcan.model.layout import bits, whole_byte
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import Message, Signal
from typedcan.model.seal import seal_of

NONE: Given = MappingProxyType({})
"""No algorithms besides those that are known."""

_WORD = 62
"""Bits that the sums of columns may have."""


def checksums_right(
    message: Message, payload: NDArray[np.uint8], given: Given = NONE
) -> NDArray[np.bool_]:
    """Which payloads, a row each, carry the checksum of their bytes.

    An algorithm that somebody gives is called for each row. Raises as
    `typedcan.model.seal.seal_of`, and `ValueError` where that has nothing to make a checksum by.
    """
    seal = seal_of(message, given)
    if seal is None or message.checksum is None:
        raise ValueError(f"{message.name} has no checksum")
    signal = message.signal(message.checksum.signal)
    method = chosen_of(message.checksum.algorithm, given)
    if isinstance(method, Method) and (not isinstance(method, Sum) or signal.length <= _WORD):
        made = _over(method, _pieces(message, message.checksum, payload), signal.length)
    else:
        content, length = payload[:, : message.length].tobytes(), message.length
        rows = (content[at : at + length] for at in range(0, len(content), length))
        made = np.fromiter(map(seal.expected, rows), np.uint64, len(payload))
    byte = whole_byte(signal)
    carried = raw_values(signal, payload) if byte is None else payload[:, byte]
    right: NDArray[np.bool_] = carried == made
    return right


def raw_values(signal: Signal, payload: NDArray[np.uint8]) -> NDArray[np.uint64]:
    """The raw values of an unsigned signal in payloads, a row each."""
    pieces = [
        _bits_of(payload[:, byte], lowest, kept).astype(np.uint64) << np.uint64(shift)
        for byte, (lowest, kept, shift) in _parts(signal).items()
    ]
    return reduce(np.bitwise_or, pieces)


def _bits_of(column: NDArray[np.uint8], lowest: int, kept: int) -> NDArray[np.uint8]:
    shifted = column >> np.uint8(lowest) if lowest else column
    return shifted if kept << lowest > 0x7F else shifted & np.uint8(kept)


def _parts(signal: Signal) -> dict[int, tuple[int, int, int]]:
    """By byte: the lowest bit there of a signal, how its bits there are masked, their place."""
    parts: dict[int, tuple[int, int, int]] = {}
    for place, bit in enumerate(bits(signal)):
        lowest, kept, shift = parts.get(bit // 8, (bit % 8, 0, place))
        parts[bit // 8] = lowest, kept << 1 | 1, shift
    return parts


def counter_places(counter: Counter, raw: NDArray[Any]) -> NDArray[np.int64]:
    """Which of its values a counter has, from 0; -1 for one that it does not run through."""
    if raw.dtype == object:  # no counter runs as far as int64
        raw = np.minimum(raw, np.iinfo(np.int64).max)
    index = raw.astype(np.int64) - counter.first
    own = (index >= 0) & (index < counter.modulus)
    if counter.step != 1:
        index, rest = np.divmod(index, counter.step)
        own = (rest == 0) & (index >= 0) & (index < counter.modulus)
    return np.where(own, index, -1)


def _pieces(message: Message, checksum: Checksum, payload: NDArray[np.uint8]) -> list[Any]:
    """The covered bytes as columns, as `typedcan.model.seal` has them for one payload."""
    own = message.signal(checksum.signal)
    blank: Mapping[int, int] = {
        byte: 0xFF ^ kept << lowest for byte, (lowest, kept, _) in _parts(own).items()
    }
    pieces: list[Any] = [
        payload[:, byte] & np.uint8(blank[byte]) if byte in blank else payload[:, byte]
        for byte in checksum.covered
    ]
    if checksum.data_ids and message.counter:
        counter = raw_values(message.signal(message.counter.signal), payload)
        ids = np.array(checksum.data_ids, np.uint8)
        chosen = [ids[counter % np.uint64(len(ids))]]
        return [*checksum.before, *pieces, *checksum.after, *chosen]
    return [*checksum.before, *pieces, *checksum.after]


def _over(method: Method, pieces: list[Any], bits_: int) -> Any:
    if isinstance(method, Crc):
        table = _table(method)
        return method.over((_as(piece, table.dtype) for piece in pieces), table)
    if isinstance(method, Sum):
        made = method.over((_as(piece, np.dtype(np.int64)) for piece in pieces), bits_)
        return made.astype(np.uint64)
    return method.over(pieces)


def _as(piece: Any, dtype: np.dtype[Any]) -> Any:
    return piece if isinstance(piece, int) else piece.astype(dtype, copy=False)


@cache
def _table(crc: Crc) -> NDArray[Any]:
    dtype = next(bits for bits in (8, 16, 32, 64) if bits >= crc.register_bits)
    return np.array(crc.table, f"u{dtype // 8}")
