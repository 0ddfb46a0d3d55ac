"""What is said of checksums and counters to people, and how specs write the bytes covered."""

from __future__ import annotations

import pytest

from typedcan.model.protection import Checksum, Counter, covered_bytes


@pytest.mark.parametrize(
    ("text", "covered"),
    [
        ("1~7", (1, 2, 3, 4, 5, 6, 7)),
        ("5", (5,)),
        ("0~2 5 7", (0, 1, 2, 5, 7)),
        ("7 6 5", (7, 6, 5)),
        ("5 5", (5, 5)),
        ("3~3", (3,)),
        ("6~5", ()),
        ("0 6~5", ()),
    ],
)
def test_covered_bytes_are_numbers_and_ranges(text: str, covered: tuple[int, ...]) -> None:
    assert covered_bytes(text) == covered
    if covered:
        written = Checksum(signal="S", algorithm="xor", covered=covered).covers()
        assert covered_bytes(written) == covered
        assert written == text.replace("3~3", "3")


def test_a_checksum_is_said_in_words() -> None:
    plain = Checksum(signal="S", algorithm="xor", covered=(1, 2, 3, 7))
    assert str(plain) == "xor of bytes 1 to 3, 7"
    full = Checksum(
        signal="S",
        algorithm="Of_Nobody",
        covered=(4,),
        before=(1, 171),
        after=(0,),
        data_ids=(9, 10),
        is_open=True,
    )
    assert str(full) == (
        "Of_Nobody of byte 4, before 0x01 0xAB, after 0x00, data ids 0x09 0x0A, left open"
    )


def test_a_counter_is_said_in_words() -> None:
    assert str(Counter(signal="S", modulus=16)) == "0 to 15"
    assert str(Counter(signal="S", modulus=3, first=9, step=-4)) == "9 to 1 by -4"
    assert str(Counter(signal="S", modulus=3, first=9, step=-1)) == "9 to 7"


def test_a_counter_runs_on_and_back() -> None:
    counter = Counter(signal="S", modulus=3, first=9, step=-4)
    assert [counter.after(value) for value in (9, 5, 1)] == [5, 1, 9]
    assert [counter.before(value) for value in (5, 1, 9)] == [9, 5, 1]
    assert [value for value in range(-10, 20) if counter.holds(value)] == [1, 5, 9]
    assert (counter.last, Counter(signal="S", modulus=1, first=4).after(4)) == (1, 4)
