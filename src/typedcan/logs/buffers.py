"""Memory that is used again from block to block.

A column on freshly mapped memory costs a page fault every 512 float64 values, which is several
times what decoding them costs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

_SPARE = 1.25


class Buffers:
    """Flat byte buffers by place; a place holds one array at a time and grows as needed."""

    def __init__(self) -> None:
        self._bytes: dict[object, NDArray[np.uint8]] = {}

    def array(self, place: object, shape: tuple[int, ...], dtype: np.dtype[Any]) -> NDArray[Any]:
        """An uninitialised contiguous array; whatever stood at that place before is overwritten."""
        size = dtype.itemsize
        for length in shape:
            size *= length
        held = self._bytes.get(place)
        if held is None or len(held) < size:
            held = self._bytes[place] = np.empty(int(size * _SPARE) + 64, np.uint8)
        return np.ndarray(shape, dtype, held)
