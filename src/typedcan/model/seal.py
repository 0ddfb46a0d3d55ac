"""The checksum of a message, ready to be computed, read and filled in."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from operator import itemgetter

from typedcan.model.checksums.methods import Algorithm
from typedcan.model.checksums.registry import WIDEST, AlgorithmError, Given, function_of
from typedcan.model.layout import bits, bits_reader, bits_writer, whole_byte
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import Message

_LARGEST = (1 << 62) - 1
"""What a counter counts to at most: columns have signed numbers of 64 bits."""


@dataclass(frozen=True, slots=True)
class Seal:
    """How the checksum of one message is made; payloads have the message's length.

    Parameters
    ----------
    bits
        How many the checksum has.
    cover
        What the function takes of a payload.
    function
        The algorithm.
    read, write
        The checksum that a payload has, and the payload with another one.
    verify
        Whether a payload has the checksum that it must carry.
    """

    bits: int
    cover: Callable[[bytes], bytes]
    function: Algorithm
    read: Callable[[bytes], int]
    write: Callable[[bytes, int], bytes]
    verify: Callable[[bytes], bool]

    def expected(self, payload: bytes) -> int:
        """The checksum that the payload must carry."""
        return self.function(self.cover(payload))

    def filled(self, payload: bytes) -> bytes:
        """The payload with its checksum."""
        return self.write(payload, self.expected(payload))


def seal_of(message: Message, given: Given) -> Seal | None:
    """What makes the checksum of a message; None where it has none, or nothing computes it.

    Raises `AlgorithmError` where what is given, or named, makes no such checksum.
    """
    checksum = message.checksum
    if checksum is None:
        return None
    signal = message.signal(checksum.signal)
    function = function_of(checksum.algorithm, signal.length, given)
    if function is None:
        return None
    byte, cover = whole_byte(signal), _cover(message, checksum)
    read = bits_reader(signal, message.length) if byte is None else itemgetter(byte)
    return Seal(
        bits=signal.length,
        cover=cover,
        function=function,
        read=read,
        write=bits_writer(signal, message.length) if byte is None else _byte_writer(byte),
        verify=lambda payload: function(cover(payload)) == read(payload),
    )


def seals_of(messages: Iterable[Message], given: Given) -> dict[str, Seal]:
    """By name of the message, what makes its checksum, where something does.

    Raises `AlgorithmError` as `seal_of`, and where no message has an algorithm of a given name.
    """
    messages = tuple(messages)
    named = {each.checksum.algorithm: None for each in messages if each.checksum}
    for name in given:
        if name not in named:
            known = ", ".join(named) or "none"
            raise AlgorithmError(f"no message has the algorithm {name!r}; known: {known}")
    seals = ((each.name, seal_of(each, given)) for each in messages)
    return {name: seal for name, seal in seals if seal}


def _byte_writer(byte: int) -> Callable[[bytes, int], bytes]:
    return lambda payload, raw: payload[:byte] + bytes((raw,)) + payload[byte + 1 :]


def _cover(message: Message, checksum: Checksum) -> Callable[[bytes], bytes]:
    covered, signal = checksum.covered, message.signal(checksum.signal)
    pick = _picker(covered)
    if not {bit // 8 for bit in bits(signal)}.isdisjoint(covered):
        pick = _blanked(bits_writer(signal, message.length), pick)
    return _framed(message, checksum, pick)


def _picker(covered: tuple[int, ...]) -> Callable[[bytes], bytes]:
    first, end = covered[0], covered[-1] + 1
    if covered == tuple(range(first, end)):
        return itemgetter(slice(first, end))
    return lambda payload: bytes(payload[number] for number in covered)


def _blanked(
    write: Callable[[bytes, int], bytes], pick: Callable[[bytes], bytes]
) -> Callable[[bytes], bytes]:
    """What is picked where the checksum itself is 0."""
    return lambda payload: pick(write(payload, 0))


def _framed(
    message: Message, checksum: Checksum, pick: Callable[[bytes], bytes]
) -> Callable[[bytes], bytes]:
    """With the bytes that no frame carries."""
    before, after, ids = map(bytes, (checksum.before, checksum.after, checksum.data_ids))
    if ids and message.counter:
        counter = bits_reader(message.signal(message.counter.signal), message.length)

        def with_data_id(payload: bytes) -> bytes:
            chosen = counter(payload) % len(ids)
            return before + pick(payload) + after + ids[chosen : chosen + 1]

        return with_data_id
    return (lambda payload: before + pick(payload) + after) if before or after else pick


def protection_faults(message: Message) -> Iterator[tuple[str, str, str]]:
    """What keeps the checksum and the counter of a message from being made.

    Yields the signal, the key of a spec that is to be corrected, and what is wrong.
    """
    if message.checksum and message.counter and message.checksum.signal == message.counter.signal:
        name = message.counter.signal
        yield name, "signal", f"{name}: is the checksum, and cannot be the counter too"
        return
    if message.checksum:
        for key, text in _checksum_faults(message, message.checksum):
            yield message.checksum.signal, key, text
    if message.counter:
        for key, text in _counter_faults(message, message.counter):
            yield message.counter.signal, key, text


def _carrier_fault(message: Message, name: str) -> str | None:
    carrier = next((each for each in message.signals if each.name == name), None)
    if carrier is None:
        return f"{name}: {message.name} has no such signal"
    if carrier.signed or carrier.is_float or carrier.length > WIDEST:
        return f"{name}: what fills it in needs an unsigned integer of at most {WIDEST} bits"
    if carrier.multiplexer:
        return f"{name}: what fills it in needs a signal of every frame, not of a branch"
    if not all(0 <= bit < 8 * message.length for bit in bits(carrier)):
        return f"{name}: does not lie in the {message.length} bytes of {message.name}"
    return None


def _checksum_faults(message: Message, checksum: Checksum) -> Iterator[tuple[str, str]]:
    name = checksum.signal
    if fault := _carrier_fault(message, name):
        yield "signal", fault
        return
    covered = checksum.covered
    if not covered:
        yield "bytes", f"{name}: covers no byte: ranges rise, such as 1~7"
    elif not all(0 <= byte < message.length for byte in covered):
        yield "bytes", f"{name}: bytes {checksum.covers()} are not in the message"
    elif len({*covered}) < len(covered):
        yield "bytes", f"{name}: bytes {checksum.covers()} have one twice"
    extra = (*checksum.before, *checksum.after, *checksum.data_ids)
    if not all(0 <= byte <= 0xFF for byte in extra):
        yield "before", f"{name}: before, after and data_ids are bytes, 0 to 0xFF"
    if checksum.data_ids and message.counter is None:
        yield "data_ids", f"{name}: {message.name} has no counter that chooses among data_ids"
    try:
        function_of(checksum.algorithm, message.signal(name).length, {})
    except AlgorithmError as error:
        yield "algorithm", f"{name}: {error}"


def _counter_faults(message: Message, counter: Counter) -> Iterator[tuple[str, str]]:
    name = counter.signal
    if fault := _carrier_fault(message, name):
        yield "signal", fault
        return
    ends = counter.first, counter.last
    most = min(message.signal(name).raw_limits[1], _LARGEST)
    if counter.modulus < 1 or not counter.step or min(ends) < 0 or max(ends) > most:
        yield "modulus", f"{name}: it runs {counter}, it may run within 0 to {most}"
