"""The three ways in which text logs write payloads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.read.digits import (
    Words,
    base64_bytes,
    hex_bytes,
    low_bytes,
    spaced_hex_bytes,
    window,
)


@dataclass(frozen=True, slots=True)
class Payload:
    """A way to write payloads, as pieces of the same size with a shorter one at the end.

    Parameters
    ----------
    step
        Bytes in a piece.
    pitch
        Columns from one piece to the next.
    separated
        There is a blank between bytes.
    width
        The characters that so many bytes take.
    piece
        Reads the characters of so many bytes; see `digits`.
    """

    step: int
    pitch: int
    separated: bool
    width: Callable[[int], int]
    piece: Callable[[Words, int], tuple[Words, Words]]

    def digits(self, first: int, length: int) -> list[slice]:
        """The columns of the digits of a payload that begins at a column."""
        if not self.separated:
            return [slice(first, first + self.width(length))]
        return [slice(first + 3 * place, first + 3 * place + 2) for place in range(length)]

    def read(self, lanes: Words, first: int, length: int) -> tuple[NDArray[np.uint8], Words]:
        """The payloads from a column on, shape (n, 8) or (n, 64), and where they are faulty."""
        pieces = []
        faults = np.zeros(lanes.shape[1], np.uint64)
        for place, done in enumerate(range(0, length, self.step)):
            characters = window(lanes, first + self.pitch * place)
            piece, wrong = self.piece(characters, min(self.step, length - done))
            pieces.append(piece)
            faults |= wrong
        if length <= 8:
            return self._word(pieces, length, len(faults)), faults
        data = np.zeros((len(faults), 64 + self.step), np.uint8)
        for piece, done in zip(pieces, range(0, length, self.step), strict=True):
            data[:, done : done + self.step] = _as_bytes(piece)[:, : self.step]
        data[:, length:] = 0
        return data[:, :64], faults

    def _word(self, pieces: list[Words], length: int, count: int) -> NDArray[np.uint8]:
        word = np.zeros(count, np.uint64)
        for place, piece in enumerate(pieces):
            word |= piece << np.uint64(8 * self.step * place)
        return _as_bytes(word & low_bytes(length))


def _as_bytes(words: Words) -> NDArray[np.uint8]:
    return words.view(np.uint8).reshape(-1, 8)


HEX = Payload(4, 8, separated=False, width=lambda length: 2 * length, piece=hex_bytes)
"""DEADBEEF"""

SPACED_HEX = Payload(
    3, 9, separated=True, width=lambda length: max(3 * length - 1, 0), piece=spaced_hex_bytes
)
"""DE AD BE EF"""

BASE64 = Payload(
    6, 8, separated=False, width=lambda length: -(-4 * length // 3), piece=base64_bytes
)
"""3q2+7w, without the padding behind it"""
