"""Checksums are made, read and filled in wherever their signal stands."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest
from cantools.autosar import end_to_end
from model.protected import INTEL, MOTOROLA, message, signal

from typedcan.model.checksums.methods import Algorithm
from typedcan.model.checksums.registry import AlgorithmError
from typedcan.model.e2e import e2e_checksum
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import ByteOrder, Message, Signal
from typedcan.model.seal import Seal, protection_faults, seal_of, seals_of


def keeping(taken: list[bytes]) -> Algorithm:
    """An algorithm that keeps what it is given."""

    def keep(data: bytes) -> int:
        taken.append(data)
        return 0

    return keep


def seal(guarded: Message, **given: Any) -> Seal:
    found = seal_of(guarded, given)
    assert found
    return found


def guarded_by(own: Signal, algorithm: str, *covered: int, length: int = 8, **more: Any) -> Message:
    checksum = Checksum(signal=own.name, algorithm=algorithm, covered=covered, **more)
    return message(own, checksum=checksum, length=length)


# A sum of bytes 0 and 1, which is 0x3AB, at several places of payloads of four bytes.
FOUR = bytes([0xFF, 0xFE, 0x00, 0x00])
PLACES = [
    (signal("Sum", 16, 16), 0x1FD, "fffefd01"),
    (signal("Sum", 23, 16, MOTOROLA), 0x1FD, "fffe01fd"),
    (signal("Sum", 24, 8), 0xFD, "fffe00fd"),
    (signal("Sum", 31, 8, MOTOROLA), 0xFD, "fffe00fd"),
    (signal("Sum", 20, 4), 0xD, "fffed000"),
    (signal("Sum", 18, 9), 0x1FD, "fffef407"),
    (signal("Sum", 19, 9, MOTOROLA), 0x1FD, "fffe0fe8"),
    (signal("Sum", 17, 1), 0x1, "fffe0200"),
]


@pytest.mark.parametrize(("own", "value", "sealed"), PLACES)
def test_a_checksum_stands_at_any_place_in_any_width_and_byte_order(
    own: Signal, value: int, sealed: str
) -> None:
    made = seal(guarded_by(own, "sum", 0, 1, length=4))
    assert made.bits == own.length
    assert made.expected(FOUR) == value
    assert made.filled(FOUR).hex() == sealed
    assert made.read(bytes.fromhex(sealed)) == value
    full = made.write(b"\xff" * 4, value)
    assert made.read(full) == value
    assert made.write(full, made.read(b"\xff" * 4)) == b"\xff" * 4  # no other bit has changed


def test_the_bits_of_the_checksum_itself_count_as_0() -> None:
    made = seal(guarded_by(signal("Sum", 28, 4), "sum unit=4", 2, 3, length=4))
    for own in (0x00, 0x70, 0xF0):
        assert made.expected(bytes([0, 0, 0x21, own | 0x3])) == 2 + 1 + 3
    whole = seal(guarded_by(signal("Xor", 0, 8), "xor", 0, 1, length=2))
    assert whole.expected(b"\x77\x12") == 0x12


def test_bytes_are_covered_in_the_order_that_is_said() -> None:
    own = signal("Sum", 0, 8)
    taken: list[bytes] = []
    for covered in ((1, 2, 3), (3, 2, 1), (1, 3), (2,)):
        guarded = guarded_by(own, "mine", *covered, length=4)
        seal(guarded, mine=keeping(taken)).expected(b"\0abc")
    assert taken == [b"abc", b"cba", b"ac", b"b"]


def test_bytes_that_no_frame_carries_stand_before_and_after() -> None:
    own = signal("Sum", 0, 8)
    taken: list[bytes] = []
    guarded = guarded_by(own, "mine", 1, 2, length=3, before=(1, 0x23), after=(7,))
    seal(guarded, mine=keeping(taken)).expected(b"\0ab")
    assert taken == [b"\x01\x23ab\x07"]


def test_a_data_id_is_chosen_by_the_counter() -> None:
    checksum = Checksum(
        signal="Sum", algorithm="mine", covered=(0, 1), after=(9,), data_ids=(65, 66, 67)
    )
    guarded = message(
        signal("Sum", 0, 8),
        signal("Count", 12, 4),
        checksum=checksum,
        counter=Counter(signal="Count", modulus=16),
        length=2,
    )
    taken: list[bytes] = []
    made = seal(guarded, mine=keeping(taken))
    for counter in (0, 1, 2, 3, 15):
        made.expected(bytes([0xEE, counter << 4 | 5]))
    assert [data[-1:] for data in taken] == [b"A", b"B", b"C", b"A", b"A"]
    assert taken[1] == b"\x00\x15\x09B"


def profile(name: str, ids: Sequence[int], crc: int, length: int, counter: Signal) -> Message:
    others = range(crc // 8, length)
    return message(
        signal("Crc", 0, crc),
        counter,
        checksum=e2e_checksum(name, "Crc", others, ids),
        counter=Counter(signal=counter.name, modulus=1 << counter.length),
        length=length,
    )


@pytest.mark.parametrize("length", [2, 8, 15, 64])
def test_e2e_profile_2_is_that_of_cantools(length: int) -> None:
    dice = random.Random(length)
    ids = [dice.randrange(256) for _ in range(16)]
    made = seal(profile("PROFILE_02", ids, 8, length, signal("Count", 8, 4)))
    for _ in range(50):
        payload = dice.randbytes(length)
        theirs = end_to_end.apply_profile2_crc(payload, ids[payload[1] & 0xF])
        assert made.filled(payload) == bytes(theirs or b"")


@pytest.mark.parametrize("length", [4, 8, 15, 64])
def test_e2e_profile_5_is_that_of_cantools(length: int) -> None:
    dice = random.Random(length)
    for _ in range(50):
        data_id, payload = dice.randrange(1 << 16), dice.randbytes(length)
        made = seal(profile("PROFILE_05", [data_id], 16, length, signal("Count", 16, 8)))
        theirs = end_to_end.apply_profile5_crc(payload, data_id)
        assert made.filled(payload) == bytes(theirs or b"")


def honda(address: int, data: bytes) -> int:
    """As the cars of one make have it: nibbles, in the lower half of the last byte."""
    nibbles = [address >> shift & 0xF for shift in (0, 4, 8)]
    for byte in data[:-1]:
        nibbles += [byte >> 4, byte & 0xF]
    return 8 - sum(nibbles) - (data[-1] >> 4) & 0xF


def test_a_checksum_of_nibbles_with_the_identifier_is_said_by_parameters() -> None:
    dice = random.Random(3)
    address = 0x1A6
    guarded = guarded_by(
        signal("Sum", 56, 4), "sum unit=4 complement=twos", *range(8), before=(0x01, 0xA6, 0x08)
    )
    made = seal(guarded)
    for _ in range(50):
        payload = dice.randbytes(8)
        assert made.expected(payload) == honda(address, payload)


def test_a_message_without_a_checksum_has_no_seal() -> None:
    assert seal_of(message(signal("Speed", 0, 8)), {}) is None
    assert seal_of(guarded_by(signal("Sum", 0, 8), "of_nobody", 1), {}) is None


def test_the_seals_of_a_protocol_are_those_that_something_computes() -> None:
    known = guarded_by(signal("Sum", 0, 8), "sum", 1)
    unknown = guarded_by(signal("Sum", 0, 8), "of_nobody", 1)
    assert list(seals_of([known], {})) == ["Guarded"]
    assert seals_of([unknown], {}) == {}
    assert list(seals_of([unknown], {"of_nobody": "xor"})) == ["Guarded"]
    with pytest.raises(AlgorithmError, match="no message has the algorithm 'mine'; known: sum"):
        seals_of([known], {"mine": "xor"})
    with pytest.raises(AlgorithmError, match="'mine'; known: none"):
        seals_of([], {"mine": "xor"})


CRC, COUNT = signal("Crc", 0, 8), signal("Count", 8, 4)


def faults(
    checksum: Checksum | None = None, counter: Counter | None = None, **more: Any
) -> list[Any]:
    signals = more.pop("signals", (CRC, COUNT))
    return [*protection_faults(message(*signals, checksum=checksum, counter=counter, **more))]


def checked(**changed: Any) -> Checksum:
    return Checksum(**{"signal": "Crc", "algorithm": "xor", "covered": (1, 2), **changed})


def counting(**changed: Any) -> Counter:
    return Counter(**{"signal": "Count", "modulus": 16, **changed})


def test_what_can_be_made_has_no_fault() -> None:
    assert faults() == []
    assert faults(checked(), counting()) == []
    assert faults(checked(before=(0, 255), after=(255,), data_ids=(255,)), counting()) == []
    assert faults(checked(algorithm="of_nobody")) == []
    assert faults(checked(covered=(7, 0))) == []
    assert faults(counter=counting(modulus=15, first=1)) == []
    assert faults(counter=counting(modulus=1, first=15)) == []
    assert faults(counter=counting(modulus=16, first=15, step=-1)) == []
    wide = (signal("Crc", 0, 64), signal("Count", 64, 64))
    assert faults(checked(covered=(20,)), counting(modulus=1 << 62), signals=wide, length=64) == []


@pytest.mark.parametrize(
    ("changed", "key", "problem"),
    [
        ({"signal": "None"}, "signal", "Guarded has no such signal"),
        ({"covered": ()}, "bytes", "covers no byte: ranges rise, such as 1~7"),
        ({"covered": (1, 8)}, "bytes", "bytes 1 8 are not in the message"),
        ({"covered": (1, 1)}, "bytes", "bytes 1 1 have one twice"),
        ({"before": (256,)}, "before", "are bytes, 0 to 0xFF"),
        ({"after": (-1,)}, "before", "are bytes, 0 to 0xFF"),
        ({"data_ids": (1,)}, "data_ids", "Guarded has no counter that chooses among data_ids"),
        ({"algorithm": "CRC-16/ARC"}, "algorithm", "CRC-16/ARC makes 16 bits, its signal has 8"),
    ],
)
def test_a_checksum_that_cannot_be_made_is_told(
    changed: dict[str, Any], key: str, problem: str
) -> None:
    ((name, said, text),) = faults(checked(**changed))
    assert (name, said) == (changed.get("signal", "Crc"), key)
    assert problem in text


@pytest.mark.parametrize(
    ("changed", "problem"),
    [
        ({"modulus": 17}, "Count: it runs 0 to 16, it may run within 0 to 15"),
        ({"modulus": 0}, "it may run within 0 to 15"),
        ({"step": 0}, "it may run within 0 to 15"),
        ({"first": 1}, "it runs 1 to 16"),
        ({"step": -1}, "it runs 0 to -15"),
        ({"signal": "None"}, "None: Guarded has no such signal"),
    ],
)
def test_a_counter_that_cannot_run_is_told(changed: dict[str, Any], problem: str) -> None:
    ((_, _, text),) = faults(counter=counting(**changed))
    assert problem in text


def test_what_is_filled_in_is_an_unsigned_signal_of_every_frame() -> None:
    plain = signal("Crc", 0, 8)
    for carrier, problem in (
        (replace(plain, signed=True), "unsigned integer of at most 64 bits"),
        (replace(plain, is_float=True, length=32), "unsigned integer of at most 64 bits"),
        (replace(plain, length=65), "unsigned integer of at most 64 bits"),
        (replace(plain, multiplexer="Mux", selectors=(1,)), "not of a branch"),
        (replace(plain, start=57), "does not lie in the 8 bytes of Guarded"),
    ):
        ((_, key, text),) = faults(checked(), signals=(carrier,))
        assert key == "signal"
        assert problem in text


@pytest.mark.parametrize("order", [INTEL, MOTOROLA])
def test_wide_checksums_of_long_frames_keep_every_bit(order: ByteOrder) -> None:
    own = signal("Crc", 3, 64, order)
    made = seal(guarded_by(own, "CRC-64/XZ", *range(20, 64), length=64))
    payload = made.filled(bytes(range(64)))
    assert made.read(payload) == made.expected(bytes(range(64)))
    assert made.expected(payload) == made.expected(bytes(range(64)))
