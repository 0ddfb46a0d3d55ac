"""Bit arithmetic: which bits of a frame a signal takes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from decimal import Decimal
from typing import Literal

from typedcan.model.protocol import ByteOrder, Message, ReservedBits, Signal


def bits(signal: Signal | ReservedBits) -> tuple[int, ...]:
    """The frame bits of a signal, or of reserved ones, from its least to its most significant one.

    Bit 0 is the least significant bit of byte 0, bit 8 that of byte 1. Bits past the end of the
    frame are listed like any other, so that a caller can see them.
    """
    if signal.byte_order is ByteOrder.INTEL:
        return tuple(range(signal.start, signal.start + signal.length))
    return tuple(reversed(tuple(_downwards(signal.start, signal.length))))


def filler(message: Message) -> int:
    """What is sent in reserved bits, as a number whose bits are those of the frame."""
    return sum(1 << bit for part in message.reserved if part.value for bit in bits(part))


def _downwards(start: int, length: int) -> Iterator[int]:
    """Motorola order: down to bit 0 of a byte, then on at bit 7 of the next."""
    bit = start
    for _ in range(length):
        yield bit
        bit = bit + 15 if bit % 8 == 0 else bit - 1


def in_bit_order(signals: Iterable[Signal]) -> list[Signal]:
    """Signals in the order in which DBC readers list them: by start bit, bytes from the left."""
    return sorted(signals, key=first_bit)


def readable(message: Message) -> list[Signal]:
    """The signals that can be read in its frames, in the order in which DBC readers list them."""
    left_out = {id(signal) for signal, _ in unreadable(message)}
    return in_bit_order(signal for signal in message.signals if id(signal) not in left_out)


def unreadable(message: Message) -> list[tuple[Signal, str]]:
    """The signals that no frame has, and why: they, or what selects them, cannot be read there."""
    by_name = {signal.name: signal for signal in message.signals}
    reasons = ((signal, _unreadable(signal, message, by_name)) for signal in message.signals)
    return [(signal, reason) for signal, reason in reasons if reason]


def _unreadable(signal: Signal, message: Message, by_name: Mapping[str, Signal]) -> str:
    above: list[str] = []
    while signal.name not in above:
        if fault := _fault(signal, message):
            return f"{signal.name}, which selects it, {fault}" if above else f"it {fault}"
        if not signal.multiplexer:
            return ""
        above.append(signal.name)
        if signal.multiplexer not in by_name:
            return f"it is selected by {signal.multiplexer}, which {message.name} has not"
        signal = by_name[signal.multiplexer]
    return "it selects itself"


def _fault(signal: Signal, message: Message) -> str:
    if first_bit(signal) + signal.length > 8 * message.length:
        return f"lies outside of the {message.length} bytes of {message.name}"
    if not signal.factor:
        return "has a factor that is 0, or no finite number"
    if signal.is_float and signal.length not in FLOATS:
        return f"is a float of {signal.length} bits, and there is none"
    return ""


def first_bit(signal: Signal) -> int:
    """Where a signal begins, counted as its byte order counts: Motorola bytes from their top."""
    from_left = 8 * (signal.start // 8) + 7 - signal.start % 8
    return signal.start if signal.byte_order is ByteOrder.INTEL else from_left


def bits_reader(signal: Signal, length: int) -> Callable[[bytes], int]:
    """What reads the bits of one signal, as an unsigned number, in a payload of so many bytes."""
    mask = (1 << signal.length) - 1
    if signal.byte_order is ByteOrder.INTEL:
        low = signal.start
        return lambda data: int.from_bytes(data, "little") >> low & mask
    below = 8 * length - first_bit(signal) - signal.length
    return lambda data: int.from_bytes(data, "big") >> below & mask


def bits_writer(signal: Signal, length: int) -> Callable[[bytes, int], bytes]:
    """What writes an unsigned number into those bits and leaves the others."""
    mask = (1 << signal.length) - 1
    order: Literal["little", "big"] = "little"
    low = signal.start
    if signal.byte_order is ByteOrder.MOTOROLA:
        order, low = "big", 8 * length - first_bit(signal) - signal.length

    def write(data: bytes, raw: int) -> bytes:
        number = int.from_bytes(data, order)
        number ^= (number >> low & mask ^ raw) << low
        return number.to_bytes(length, order)

    return write


def whole_byte(signal: Signal) -> int | None:
    """The byte that the signal fills exactly, or None."""
    taken = sorted(bits(signal))
    if len(taken) == 8 and taken[0] % 8 == 0 and taken[-1] == taken[0] + 7:
        return taken[0] // 8
    return None


FLOATS = {16: (10, 15), 32: (23, 127), 64: (52, 1023)}
"""Bits of the types of IEEE 754: those of the fraction, and the largest exponent."""


def largest_float(length: int) -> Decimal:
    """The largest finite number of the IEEE 754 type with so many bits, of 64 for odd ones."""
    fraction, exponent = FLOATS.get(length, FLOATS[64])
    return Decimal((2 << exponent) - (1 << (exponent - fraction)))


def float_limits(length: int) -> tuple[Decimal, Decimal]:
    """The smallest and largest finite number of that type, exactly.

    A minus sign would round the smallest one to the digits of the decimal context.
    """
    largest = largest_float(length)
    return largest.copy_negate(), largest
