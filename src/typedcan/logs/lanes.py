"""Where the bits of a signal lie in a payload, as a part of one machine word."""

from __future__ import annotations

from dataclasses import dataclass

from typedcan.model.layout import first_bit
from typedcan.model.protocol import ByteOrder, Signal

_BYTES = 8


@dataclass(frozen=True, slots=True)
class Lane:
    """A word of the payload: its value, shifted right and cut to so many bits, is the signal.

    Parameters
    ----------
    byte, width
        First byte and how many: 1, 2, 4 or 8.
    big_endian
        The order of the bytes in the word.
    shift, bits
        Free bits below the signal, and bits of the signal.
    """

    byte: int
    width: int
    big_endian: bool
    shift: int
    bits: int

    @property
    def whole(self) -> bool:
        """Whether the signal fills the word."""
        return self.bits == 8 * self.width


def lane_of(signal: Signal, row: int) -> Lane | None:
    """The narrowest word in a payload of ``row`` bytes that holds the signal.

    None where it touches more than eight bytes.
    """
    first = first_bit(signal)
    byte, last = first // 8, (first + signal.length - 1) // 8
    touched = last - byte + 1
    if touched > _BYTES:
        return None
    width = 1 << (touched - 1).bit_length()
    # A word that would reach beyond the payload begins earlier instead.
    byte = min(byte, row - width)
    inside = first - 8 * byte
    big_endian = signal.byte_order is ByteOrder.MOTOROLA
    shift = 8 * width - inside - signal.length if big_endian else inside
    return Lane(byte, width, big_endian, shift, signal.length)
