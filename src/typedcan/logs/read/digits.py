"""Digits of text to numbers, eight characters at a time: a character is a byte of a uint64 word.

The first character is the lowest byte. A function that turns digits into a value also gives a
word per row that is zero where all eight characters were such digits.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Words = NDArray[np.uint64]


def each_byte(value: int) -> np.uint64:
    """A word with this value in each of its bytes."""
    return np.uint64(value * 0x0101010101010101)


def low_bytes(count: int) -> np.uint64:
    """A word whose lowest bytes are all ones: the mask for so many characters."""
    return np.uint64((1 << 8 * count) - 1)


_ZEROS = each_byte(ord("0"))
_HIGH = each_byte(0x80)
_NIBBLES = each_byte(0x0F)
_ONES = each_byte(1)
_BYTES = np.uint64(0x00FF00FF00FF00FF)
_PAIRS = np.uint64(0x0000FFFF0000FFFF)
_FIRST_OF_FOUR = np.uint64(0x000000FF000000FF)

_BASE64_ALPHABET = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"
_BASE64 = bytes(
    _BASE64_ALPHABET.index(code) if code in _BASE64_ALPHABET else 0xFF for code in range(256)
)


def _shift(count: int) -> np.uint64:
    return np.uint64(8 * count)


def window(lanes: Words, offset: int) -> Words:
    """The eight characters from a column on; ``lanes`` has shape (words of a line, lines)."""
    lane, skip = divmod(offset, 8)
    characters: Words = lanes[lane]
    if skip:
        characters = characters >> _shift(skip)
        if lane + 1 < len(lanes):
            characters |= lanes[lane + 1] << _shift(8 - skip)
    return characters


def flush_right(lanes: Words, offset: int, width: int) -> Words:
    """A number of up to eight characters, with zeros ("0") before it to make eight."""
    characters = window(lanes, offset)
    if width == 8:
        return characters
    return (characters << _shift(8 - width)) | (_ZEROS & low_bytes(8 - width))


def decimal(characters: Words) -> tuple[Words, Words]:
    """Eight decimal digits each to their value."""
    digits = characters ^ _ZEROS
    faults = (digits | (digits + each_byte(0x76))) & _HIGH
    digits = digits * np.uint64(10) + (digits >> np.uint64(8))
    high = (digits & _FIRST_OF_FOUR) * np.uint64(100 + (1_000_000 << 32))
    low = ((digits >> np.uint64(16)) & _FIRST_OF_FOUR) * np.uint64(1 + (10_000 << 32))
    return (high + low) >> np.uint64(32), faults


def _nibbles(characters: Words) -> tuple[Words, Words]:
    """Hexadecimal digits to their values, still a byte each."""
    lower = characters | each_byte(0x20)
    is_digit = (characters + each_byte(0x80 - 0x30)) & ~(characters + each_byte(0x80 - 0x3A))
    is_letter = (lower + each_byte(0x80 - 0x61)) & ~(lower + each_byte(0x80 - 0x67))
    faults = ~(is_digit | is_letter) & _HIGH
    letters = (characters >> np.uint64(6)) & _ONES
    return (characters & _NIBBLES) + letters * np.uint64(9), faults


def hex_bytes(characters: Words, count: int) -> tuple[Words, Words]:
    """Up to four bytes written as "DEADBEEF", in their order."""
    kept = low_bytes(2 * count)
    nibbles, faults = _nibbles((characters & kept) | (_ZEROS & ~kept))
    pairs = ((nibbles << np.uint64(4)) | (nibbles >> np.uint64(8))) & _BYTES
    pairs = (pairs | (pairs >> np.uint64(8))) & _PAIRS
    return (pairs | (pairs >> np.uint64(16))) & low_bytes(4), faults


def hex_number(characters: Words) -> tuple[NDArray[np.uint32], Words]:
    """Eight hexadecimal digits to their value."""
    value, faults = hex_bytes(characters, 4)
    return value.astype("<u4").view(">u4").astype(np.uint32), faults


def spaced_hex_bytes(characters: Words, count: int) -> tuple[Words, Words]:
    """Up to three bytes written as "DE AD BE"; the spaces are not looked at."""
    kept = np.uint64(sum(0xFFFF << 24 * place for place in range(count)))
    nibbles, faults = _nibbles((characters & kept) | (_ZEROS & ~kept))
    pairs = (nibbles << np.uint64(4)) | (nibbles >> np.uint64(8))
    first = pairs & np.uint64(0xFF)
    second = (pairs >> np.uint64(16)) & np.uint64(0xFF00)
    return first | second | ((pairs >> np.uint64(32)) & np.uint64(0xFF0000)), faults


def base64_bytes(characters: Words, count: int) -> tuple[Words, Words]:
    """Up to six bytes written in base64."""
    kept = low_bytes(-(-4 * count // 3))
    filled = (characters & kept) | (each_byte(ord("A")) & ~kept)
    sixes = np.frombuffer(filled.tobytes().translate(_BASE64), dtype=np.uint64)
    faults = sixes & _HIGH
    twelves = ((sixes & _BYTES) << np.uint64(6)) | ((sixes >> np.uint64(8)) & _BYTES)
    triples = ((twelves & _PAIRS) << np.uint64(12)) | ((twelves >> np.uint64(16)) & _PAIRS)
    first = (triples >> np.uint64(16)) & _FIRST_OF_FOUR
    second = triples & (_FIRST_OF_FOUR << np.uint64(8))
    ordered = first | second | ((triples & _FIRST_OF_FOUR) << np.uint64(16))
    return (ordered & low_bytes(3)) | ((ordered >> np.uint64(32)) << np.uint64(24)), faults


def seconds(whole: Words, fraction: Words, places: int) -> NDArray[np.float64]:
    """The number "whole.fraction", rounded as `float` rounds it: bit for bit.

    ``fraction`` has ``places`` digits, 9 at most, and ``whole`` is below 10**10. Below 2**53 all
    the digits are one exact integer and the division rounds once. Above, the whole part is at
    least 2**23, and fraction / 10**places is so much finer than the half of its last bit that
    rounding it first never changes the sum.
    """
    scale = 10**places
    scaled = whole * np.uint64(scale) + fraction
    values: NDArray[np.float64] = scaled.astype(np.float64) / scale
    if scaled.size and scaled.max() > 1 << 53:
        parts = whole.astype(np.float64) + fraction.astype(np.float64) / scale
        values = np.where(scaled > np.uint64(1 << 53), parts, values)
    return values
