"""The checksum algorithms that are known by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import reduce
from operator import xor
from types import MappingProxyType

Algorithm = Callable[[bytes], int]
"""Bytes to a checksum of one byte."""


def xor8(data: bytes) -> int:
    """The XOR of all bytes."""
    return reduce(xor, data, 0)


ALGORITHMS: Mapping[str, Algorithm] = MappingProxyType({"xor": xor8})
"""Those that need nobody to give them."""
