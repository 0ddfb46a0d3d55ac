"""Bits of frames on the wire, by the papers and by ISO 11898."""

from __future__ import annotations

from typedcan.model.frame_time import Bits, frame_bits, usual_bits


def test_the_bits_of_a_frame_are_those_that_the_paper_counts() -> None:
    # 34 or 54 bits that may be stuffed, 13 that may not; 80 + 10 s at worst for extended frames.
    assert frame_bits(8, extended=False) == 111
    assert frame_bits(8, extended=False, stuffed=True) == 135
    assert frame_bits(8) == 131
    for length in range(9):
        assert frame_bits(length, stuffed=True) == 80 + 10 * length
        assert frame_bits(length, extended=False, stuffed=True) == 55 + 10 * length


def test_usual_traffic_has_one_stuff_bit_in_sixteen() -> None:
    # 67 and 47 bits beside the data; of 54 and 34 of them and the data, one in 16 is stuffed.
    assert usual_bits(8) == 67 + 64 + (54 + 64) / 16
    assert usual_bits(0, extended=False) == 47 + 34 / 16
    for length in range(9):
        for extended in (False, True):
            least, most = Bits.of(length, extended=extended)
            assert least < usual_bits(length, extended=extended) < most


def test_bits_of_many_frames_are_added() -> None:
    assert Bits().plus(Bits.of(8, extended=True), 3) == (3 * 131, 3 * 160)
    once = Bits.of(0, extended=False)
    assert once.plus(once) == (94, 110)
