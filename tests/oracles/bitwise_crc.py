"""CRCs bit by bit, as a division of polynomials: no tables, no registers that shift."""

from __future__ import annotations

from typing import NamedTuple


class Parameters(NamedTuple):
    """As the public catalogue has them."""

    width: int
    poly: int
    init: int
    refin: bool
    refout: bool
    xorout: int


def crc(parameters: Parameters, data: bytes) -> int:
    """The remainder of the message, its first bits inverted by init, times x to the width."""
    bits = [bit for byte in data for bit in _bits(byte, 8, reflected=parameters.refin)]
    bits += [0] * parameters.width
    init = _bits(parameters.init, parameters.width, reflected=False)
    bits[: parameters.width] = [a ^ b for a, b in zip(bits, init, strict=False)]
    divisor = [1, *_bits(parameters.poly, parameters.width, reflected=False)]
    for place in range(8 * len(data)):
        if bits[place]:
            for step, bit in enumerate(divisor):
                bits[place + step] ^= bit
    remainder = bits[8 * len(data) :]
    if parameters.refout:
        remainder.reverse()
    return int("".join(map(str, remainder)), 2) ^ parameters.xorout


def _bits(number: int, count: int, *, reflected: bool) -> list[int]:
    """From the most significant one, or from the least."""
    bits = [number >> place & 1 for place in range(count)]
    return bits if reflected else bits[::-1]
