"""A module of a user's: algorithms for tests of --algorithm, which find it by its name."""

from __future__ import annotations

from collections.abc import Callable


def inverted_sum(data: bytes) -> int:
    """One that has no name."""
    return ~sum(data) & 0xFF


def _made() -> Callable[[bytes], int]:
    return lambda data: inverted_sum(data)  # noqa: PLW0108 - one that no other process is handed


closure = _made()


def too_wide(data: bytes) -> int:
    """Makes what a byte cannot hold."""
    return 256 + len(data)


def failing(data: bytes) -> int:
    """Makes nothing."""
    raise LookupError(f"no table for {len(data)} bytes")


no_function = 5
