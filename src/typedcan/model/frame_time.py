"""How many bits a CAN frame has on the wire: without stuff bits, usually, and at most."""

from __future__ import annotations

from typing import NamedTuple

_STANDARD_HEAD = 34
_EXTENDED_HEAD = 54
"""Bits apart from the payload that stuff bits can fall into: start of frame to checksum."""

_TAIL = 13
"""Bits without stuffing: delimiters, acknowledgement, end of frame and the space after it."""

_BITS_PER_STUFF_BIT = 16
"""In traffic of measured values, as seen; it depends on the data, at worst it is 4."""


def frame_bits(length: int, *, extended: bool = True, stuffed: bool = False) -> int:
    """Bits of a classical CAN frame with so many bytes, the space before the next one included.

    ``stuffed`` adds the most stuff bits that any identifier and payload can need: one after every
    four bits beyond the first, as Davis, Burns, Bril and Lukkien count them (2007, equation 1).
    A CAN FD frame is counted as a classical one of its length, though its header is another and
    its payload may be faster.
    """
    body = _body(length, extended)
    return body + _TAIL + ((body - 1) // 4 if stuffed else 0)


def usual_bits(length: int, *, extended: bool = True) -> float:
    """As `frame_bits`, with about as many stuff bits as usual traffic has."""
    body = _body(length, extended)
    return body + _TAIL + body / _BITS_PER_STUFF_BIT


class Bits(NamedTuple):
    """Bits without stuff bits and with the most there can be, of one frame or of many."""

    bare: float = 0.0
    stuffed: float = 0.0

    @classmethod
    def of(cls, length: int, *, extended: bool) -> Bits:
        """Those of one frame, as `frame_bits` has them."""
        bare = frame_bits(length, extended=extended)
        return cls(bare, frame_bits(length, extended=extended, stuffed=True))

    def plus(self, other: Bits, times: float = 1.0) -> Bits:
        """With others, so many times."""
        return Bits(self.bare + times * other.bare, self.stuffed + times * other.stuffed)


def _body(length: int, extended: bool) -> int:  # noqa: FBT001
    return (_EXTENDED_HEAD if extended else _STANDARD_HEAD) + 8 * length
