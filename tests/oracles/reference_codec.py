"""A codec that moves one bit at a time, from the plain numbers of the model and nothing else.

It is slow and says what a DBC means by a start bit: bit 8 x byte + n is the bit of value 2**n of
that byte. An Intel signal starts at its least significant bit and grows upwards. A Motorola
signal starts at its most significant bit and runs down the byte, then on at the top of the next.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

from typedcan.model.protocol import ByteOrder, Message, Signal

Place = tuple[int, int]
"""A byte of the payload, and a bit of it from 0 (value 1) to 7 (value 128)."""


def places(signal: Signal) -> list[Place]:
    """Where the bits of a signal lie, from the least to the most significant one."""
    if signal.byte_order is ByteOrder.INTEL:
        numbers = range(signal.start, signal.start + signal.length)
        return [divmod(number, 8) for number in numbers]
    byte, bit = divmod(signal.start, 8)
    # Counted from the left edge of the payload, a Motorola signal is one unbroken run.
    from_left = 8 * byte + (7 - bit)
    run = [divmod(number, 8) for number in range(from_left, from_left + signal.length)]
    return [(byte, 7 - column) for byte, column in reversed(run)]


def raw_value(signal: Signal, data: bytes) -> int:
    """The raw value of one signal in a payload."""
    raw = 0
    for weight, (byte, bit) in enumerate(places(signal)):
        if data[byte] & (1 << bit):
            raw += 1 << weight
    if signal.signed and raw >> (signal.length - 1):
        raw -= 1 << signal.length
    return raw


def raw_values(message: Message, data: bytes) -> dict[str, int]:
    """The raw values of all signals in a payload."""
    return {signal.name: raw_value(signal, data) for signal in message.signals}


def payload(message: Message, raw: Mapping[str, int]) -> bytes:
    """The payload that carries these raw values; every other bit is 0."""
    data = [0] * message.length
    for signal in message.signals:
        value = raw.get(signal.name, 0) % (1 << signal.length)
        for weight, (byte, bit) in enumerate(places(signal)):
            if value & (1 << weight):
                data[byte] |= 1 << bit
    return bytes(data)


def physical_value(signal: Signal, raw: int) -> Fraction:
    """The physical value of a raw one, exactly."""
    return raw * Fraction(signal.factor) + Fraction(signal.offset)


def raw_range(signal: Signal) -> range:
    """The raw values whose physical value lies inside the printed range; the scale must rise."""
    ends = (Fraction(signal.minimum), Fraction(signal.maximum))
    low, high = ((end - Fraction(signal.offset)) / Fraction(signal.factor) for end in ends)
    return range(math.ceil(low), math.floor(high) + 1)


def labels(signal: Signal) -> dict[int, str]:
    """The English labels of a signal's codes."""
    table = signal.value_table
    return {code.value: code.english for code in table.codes} if table else {}


def is_defined(signal: Signal, raw: int) -> bool:
    """Whether the standard gives a raw value a meaning: inside the range, or a labelled code."""
    return raw in labels(signal) or raw in raw_range(signal)
