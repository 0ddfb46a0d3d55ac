"""Checksums and counters of many payloads at once are those of each payload."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from model.protected import INTEL, MOTOROLA, message, signal
from numpy.typing import NDArray
from oracles.bitwise_crc import Parameters, crc

from typedcan.logs.checksums import checksums_right, counter_places, raw_values
from typedcan.model.checksums.registry import AlgorithmError, method_of, names
from typedcan.model.layout import bits
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import Message, Signal
from typedcan.model.seal import seal_of

PARAMETERS = (
    *("sum modulus=255", "sum complement=ones", "sum complement=twos", "sum unit=4"),
    *("sum modulus=100 complement=twos", "xor unit=4", "width=5 poly=0x15 refin=true refout=false"),
    *("width=7 poly=0x45 init=0x11 refout=true", "width=13 poly=0x1CF5 refin=true refout=false"),
)
CARRIERS = (
    *(signal("Crc", 0, 64), signal("Crc", 3, 64), signal("Crc", 7, 64, MOTOROLA)),
    *(signal("Crc", 16, 32), signal("Crc", 21, 40, MOTOROLA), signal("Crc", 480, 32)),
)


def rows(payloads: list[bytes]) -> NDArray[np.uint8]:
    return np.frombuffer(b"".join(payloads), np.uint8).reshape(len(payloads), -1)


def some(count: int, length: int, dice: random.Random) -> list[bytes]:
    return [dice.randbytes(length) for _ in range(count)]


@st.composite
def guarded(draw: st.DrawFn) -> Message:
    """Any algorithm that is known, at any place, over any bytes, beside a counter."""
    own = draw(st.sampled_from(CARRIERS))
    covered = draw(st.lists(st.integers(0, 63), min_size=1, max_size=20, unique=True))
    short = st.lists(st.integers(0, 255), max_size=3).map(tuple)
    checksum = Checksum(
        signal="Crc",
        algorithm=draw(st.sampled_from((*names(), *PARAMETERS))),
        covered=tuple(covered),
        before=draw(short),
        after=draw(short),
        data_ids=draw(short),
    )
    counting = Counter(signal="Count", modulus=16)
    count = signal("Count", draw(st.sampled_from((100, 300, 475))), 4)
    return message(own, count, checksum=checksum, counter=counting, length=64)


@settings(max_examples=150, deadline=None)
@given(guarded(), st.randoms(use_true_random=False))
def test_columns_agree_with_each_payload(guarded: Message, dice: random.Random) -> None:
    bits_ = guarded.signals[0].length
    method = method_of(guarded.checksum.algorithm) if guarded.checksum else None
    assume(method and method.result_bits(bits_) <= bits_)
    seal = seal_of(guarded, {})
    assert seal
    payloads = [seal.filled(each) for each in some(8, 64, dice)]
    spoilt = [seal.write(each, seal.read(each) ^ 1 << dice.randrange(bits_)) for each in payloads]
    assert checksums_right(guarded, rows(payloads)).tolist() == [True] * 8
    assert checksums_right(guarded, rows(spoilt)).tolist() == [False] * 8


def test_columns_of_a_crc_are_the_remainders_of_a_division() -> None:
    dice = random.Random(5)
    for refin, refout in ((False, False), (True, True)):
        given_ = Parameters(16, 0x1021, 0xFFFF, refin, refout, 0)
        text = f"width=16 poly=0x1021 init=0xFFFF refin={refin} refout={refout}".lower()
        checksum = Checksum(signal="Crc", algorithm=text, covered=(0, 1, 2, 3, 4, 5))
        own = message(signal("Crc", 55, 16, MOTOROLA), checksum=checksum)
        payloads = [each + crc(given_, each).to_bytes(2) for each in some(100, 6, dice)]
        assert checksums_right(own, rows(payloads)).all()
        payloads[7] = bytes(8)
        assert np.flatnonzero(~checksums_right(own, rows(payloads))).tolist() == [7]


def test_rows_may_be_wider_than_the_message() -> None:
    checksum = Checksum(signal="Sum", algorithm="of_mine", covered=(0,))
    own = message(signal("Sum", 15, 8, MOTOROLA), checksum=checksum, length=2)
    payload = rows([b"\x05\x05\xff\xff", b"\x05\x06\xff\xff"])
    for algorithm in ("sum", lambda data: data[0]):
        mine: dict[str, Any] = {"of_mine": algorithm}
        assert checksums_right(own, payload, mine).tolist() == [True, False]
    with pytest.raises(ValueError, match="Guarded has no checksum"):
        checksums_right(own, payload)


def test_an_algorithm_that_makes_no_checksum_is_named_in_columns_too() -> None:
    checksum = Checksum(signal="Sum", algorithm="of_mine", covered=(0,))
    own = message(signal("Sum", 8, 8), checksum=checksum, length=2)
    with pytest.raises(AlgorithmError, match="of_mine made 256, its signal has 8 bits"):
        checksums_right(own, rows([b"\x00\x00"]), {"of_mine": lambda data: 256})


@pytest.mark.parametrize("order", [INTEL, MOTOROLA])
def test_raw_values_are_those_of_the_bits_wherever_they_are(order: Any) -> None:
    dice = random.Random(6)
    payloads = some(20, 64, dice)
    for start, length in ((0, 8), (7, 8), (3, 9), (100, 1), (61, 64), (391, 33), (440, 63)):
        own: Signal = signal("Any", start, length, order)
        expected = [
            sum((each[bit // 8] >> bit % 8 & 1) << place for place, bit in enumerate(bits(own)))
            for each in payloads
        ]
        assert raw_values(own, rows(payloads)).tolist() == expected


@pytest.mark.parametrize(
    ("counter", "values"),
    [
        (Counter(signal="Count", modulus=4), [0, 1, 2, 3]),
        (Counter(signal="Count", modulus=3, first=1), [1, 2, 3]),
        (Counter(signal="Count", modulus=3, first=2, step=5), [2, 7, 12]),
        (Counter(signal="Count", modulus=3, first=9, step=-4), [9, 5, 1]),
    ],
)
def test_a_counter_has_its_values_in_their_order(counter: Counter, values: list[int]) -> None:
    raw = np.arange(16, dtype=np.uint64)
    places = counter_places(counter, raw).tolist()
    assert [places.index(place) for place in range(len(values))] == values
    assert places.count(-1) == 16 - len(values)
    assert [value for value in range(16) if counter.holds(value)] == sorted(values)
    assert [counter.after(value) for value in values] == [*values[1:], values[0]]
    assert counter.last == values[-1]
