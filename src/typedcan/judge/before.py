"""The last frame of a message in what was judged before."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Before:
    """One frame: seconds since the log's begin, number in the log, raw values by field, bytes."""

    time: float
    order: int
    raw: Mapping[str, int]
    payload: NDArray[np.uint8]
