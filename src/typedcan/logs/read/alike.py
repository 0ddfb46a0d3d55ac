"""Which lines look alike: letters and digits stand at the same columns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.read.digits import Words, low_bytes

_DIGITS = b"+/" + bytes(code for code in range(128) if chr(code).isalnum())
_WITHOUT_DIGITS = bytes(ord("0") if code in _DIGITS else code for code in range(256))
_SPREAD = np.uint64(0x9E3779B97F4A7C15)


def lines_at(text: NDArray[np.uint8], starts: NDArray[np.int64], words: int) -> Words:
    """The text from each start on, shape (n, words); a character is a byte."""
    width = 8 * words
    every = np.ndarray((len(text) - width,), f"V{width}", text, strides=(1,))
    lines: Words = every[starts].view(np.uint64).reshape(-1, words)
    return lines


def groups_alike(
    text: NDArray[np.uint8], starts: NDArray[np.int64], length: int
) -> list[NDArray[np.int64]]:
    """Lines of one length by what they look like: for each look which ones, in their order.

    Now and then lines that do not look alike are in one group.
    """
    words = -(-length // 8)
    lines = lines_at(text, starts, words)
    plain = np.frombuffer(lines.tobytes().translate(_WITHOUT_DIGITS), np.uint64)
    looks = np.zeros(len(starts), np.uint64)
    for place, column in enumerate(plain.reshape(-1, words).T, 1):
        kept = low_bytes(length - 8 * (words - 1)) if place == words else low_bytes(8)
        looks = (looks ^ (column & kept)) * _SPREAD
        looks ^= looks >> np.uint64(32)
    order = np.argsort(looks, kind="stable")
    return np.split(order, np.flatnonzero(np.diff(looks[order])) + 1)
