"""How many bits frames have on the wire, without stuff bits and with the most there can be."""

from __future__ import annotations

from typing import NamedTuple

_HEAD, _EXTENDED_HEAD, _TAIL = 34, 54, 13
"""Bits of a frame apart from its payload: those that are stuffed, and those behind."""


class Bits(NamedTuple):
    """Bits without stuff bits and with the most there can be."""

    bare: float = 0.0
    stuffed: float = 0.0

    def plus(self, other: Bits, times: float = 1.0) -> Bits:
        """With others, so many times."""
        return Bits(self.bare + times * other.bare, self.stuffed + times * other.stuffed)


def frame_bits(length: int, *, extended: bool) -> Bits:
    """Bits of a classical frame with so many bytes, the space before the next one included.

    At most one stuff bit after every four bits beyond the first, from start of frame to checksum.
    A CAN FD frame is counted as a classical one of its length, though its header is another and
    its payload may be faster.
    """
    body = (_EXTENDED_HEAD if extended else _HEAD) + 8 * length
    return Bits(body + _TAIL, body + _TAIL + (body - 1) // 4)
