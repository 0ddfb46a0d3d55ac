"""How many bits a CAN frame has on the wire, without stuff bits and with the most there can be."""

from __future__ import annotations

_STANDARD_HEAD = 34
_EXTENDED_HEAD = 54
"""Bits apart from the payload that stuff bits can fall into: start of frame to checksum."""

_TAIL = 13
"""Bits without stuffing: delimiters, acknowledgement, end of frame and the space after it."""


def frame_bits(length: int, *, extended: bool = True, stuffed: bool = False) -> int:
    """Bits of a classical CAN frame with so many bytes, the space before the next one included.

    ``stuffed`` adds the most stuff bits that any identifier and payload can need: one after every
    four bits beyond the first, as Davis, Burns, Bril and Lukkien count them (2007, equation 1).
    """
    body = (_EXTENDED_HEAD if extended else _STANDARD_HEAD) + 8 * length
    return body + _TAIL + ((body - 1) // 4 if stuffed else 0)
