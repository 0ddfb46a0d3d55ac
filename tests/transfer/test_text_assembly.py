"""VIN and pack code put together: what is a result, what a problem, and when."""

from __future__ import annotations

import math
from itertools import permutations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from transfer.wire import ALPHABET, delivered

from swapcan.messages import B2V_ST2, V2B_VIN, B2V_SysCode1, Manufacturer
from swapcan.transfer import (
    PackCode,
    PackCodeAssembler,
    Problem,
    Vin,
    VinAssembler,
    split_pack_code,
    split_vin,
)
from typedcan.model.code_types import Code5

VIN = "1M8GDM9AXKP042788"
OTHER = "5GZCZ43D13S812715"
CODE = "04QPE4C8J4K5L6M7N8P9R0S1"


def kinds(outcomes: list[object]) -> list[object]:
    """The results, and of the problems their kind."""
    return [each.kind if isinstance(each, Problem) else each for each in outcomes]


@given(st.text(ALPHABET, min_size=17, max_size=17))
def test_a_vin_comes_back_from_its_frames(vin: str) -> None:
    assembler = VinAssembler()
    outcomes = [assembler.take(frame, 0.0) for frame in delivered(split_vin(vin))]
    assert outcomes == [(), (), (Vin(vin),)]


@given(st.text(ALPHABET, min_size=1, max_size=27), st.integers(0, 7))
def test_a_pack_code_comes_back_from_the_second_of_two_rounds(code: str, maker: int) -> None:
    assembler = PackCodeAssembler()
    frames = delivered(split_pack_code(code, maker))
    outcomes = [assembler.take(frame, cycle) for cycle in (0.0, 1.0) for frame in frames]
    assert outcomes == [()] * 7 + [(PackCode(code, maker),)]


def test_the_manufacturer_has_its_name() -> None:
    assembler = PackCodeAssembler(rounds=1)
    results = [assembler.take(f, 0.0) for f in delivered(split_pack_code(CODE, Manufacturer.CATL))]
    [code] = results[-1]
    assert isinstance(code, PackCode)
    assert code.manufacturer is Manufacturer.CATL
    assert str(code) == CODE


def test_frames_may_come_in_any_order() -> None:
    for order in permutations(split_vin(VIN)):
        assembler = VinAssembler()
        assert [assembler.take(frame, 0.0) for frame in order] == [(), (), (Vin(VIN),)]


def test_frames_that_come_again_are_counted_and_say_nothing() -> None:
    assembler = VinAssembler()
    one, two, three = split_vin(VIN)
    assert [assembler.take(f, 0.0) for f in (one, one, two, one)] == [()] * 4
    assert assembler.duplicates == 2
    assert assembler.take(three, 0.0) == (Vin(VIN),)


def test_a_set_that_is_not_complete_in_time_is_dropped_and_says_what_it_lacked() -> None:
    assembler = VinAssembler()
    one, two, three = split_vin(VIN)
    assembler.take(one, 10.0)
    assembler.take(three, 10.5)
    assert assembler.missing() == "frame 2 of 3 is missing"
    assert assembler.deadline == 11.0
    assert assembler.expire(10.99) == ()
    text = "not complete within 1 s: frame 2 of 3 is missing"
    assert assembler.expire(11.0) == (Problem("vin", "timeout", text, 11.0),)
    assert assembler.take(two, 11.2) == ()
    assert assembler.missing() == "frame 1 of 3 is missing"
    assert assembler.deadline == 11.5
    assert assembler.expire(12.2) == ()
    assert assembler.missing() == "frame 2 of 3 is missing"


def test_a_frame_that_is_always_lost_is_reported_once() -> None:
    assembler = PackCodeAssembler()
    one, _, three, four = split_pack_code(CODE)
    stream = [(cycle + n / 4, f) for cycle in range(9) for n, f in enumerate((one, three, four))]
    outcomes = [each for at, frame in stream for each in assembler.take(frame, at)]
    assert kinds(list(outcomes)) == ["timeout"]
    assert assembler.missing() == "frame 2 of 4 is missing"


def test_a_frame_that_is_late_does_not_complete_an_old_set() -> None:
    assembler = VinAssembler()
    one, two, three = split_vin(VIN)
    outcomes = [assembler.take(f, at) for f, at in ((one, 0.0), (two, 0.1), (three, 1.0))]
    assert kinds([each for outcome in outcomes for each in outcome]) == ["timeout"]


def test_other_content_is_a_conflict_and_takes_two_rounds_from_then_on() -> None:
    assembler = VinAssembler()
    new = list(split_vin(OTHER))
    frames = [split_vin(VIN)[0], *new, *new, *new]
    outcomes = [assembler.take(frame, 0.1 * n) for n, frame in enumerate(frames)]
    assert kinds(list(outcomes[1])) == ["conflict"]
    assert outcomes[2:6] == [()] * 4
    assert outcomes[6] == (Vin(OTHER),)
    assert outcomes[7:] == [(), (), (Vin(OTHER),)]


def test_what_came_before_a_conflict_counts_in_no_set() -> None:
    assembler = VinAssembler()
    one, two, three = split_vin(OTHER)
    frames = [*split_vin(VIN)[:2], one, three, one, two, three, one]
    outcomes = [each for frame in frames for each in assembler.take(frame, 0.0)]
    assert kinds(list(outcomes)) == ["conflict"]
    assert assembler.take(two, 0.0) == (Vin(OTHER),)


def test_a_first_result_is_remembered_when_another_value_begins() -> None:
    assembler = VinAssembler()
    for frame in split_vin(VIN):
        assembler.take(frame, 0.0)
    outcomes = [each for frame in split_vin(OTHER) for each in assembler.take(frame, 0.5)]
    assert kinds(list(outcomes)) == ["conflict"]
    assert assembler.missing() == "1 of 2 identical sets of frames have come"


def test_after_three_timeouts_of_silence_it_is_as_new() -> None:
    assembler = VinAssembler()
    for frame in (*split_vin(VIN), *split_vin(OTHER)):
        assembler.take(frame, 0.0)
    assert assembler.deadline == 3.0
    assert kinds(list(assembler.expire(3.0))) == ["timeout"]
    assert assembler.deadline == math.inf
    assert [assembler.take(f, 4.0) for f in split_vin(OTHER)][-1] == (Vin(OTHER),)


@pytest.mark.parametrize("number", [0, 4, 255])
def test_a_frame_number_that_there_cannot_be_is_reported_and_changes_nothing(number: int) -> None:
    assembler = VinAssembler()
    one, two, three = split_vin(VIN)
    assembler.take(one, 0.0)
    strange = V2B_VIN(frame_no=number, b1_8_15="A")
    text = f"frame number {number}; there are 1 to 3"
    assert assembler.take(strange, 0.1) == (Problem("vin", "number", text, 0.1),)
    assembler.take(two, 0.2)
    assert assembler.take(three, 0.3) == (Vin(VIN),)


def test_a_vin_that_is_not_set_is_reported_as_its_characters() -> None:
    assembler = VinAssembler()
    frames = delivered(V2B_VIN(frame_no=number) for number in (1, 2, 3))
    [*_, (problem,)] = [assembler.take(frame, 0.0) for frame in frames]
    text = "vin: character 1 is 0x00, which is none of 0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"
    assert isinstance(problem, Problem)
    assert (problem.kind, str(problem)) == ("character", text)


def test_what_fills_the_last_frame_does_not_matter() -> None:
    assembler = VinAssembler()
    one, two, _ = split_vin(VIN)
    padded = V2B_VIN(
        frame_no=3, b1_8_15="7", b2_9_16="8", b3_10_17="8", b4_11=255, b5_12="A", b6_13=255
    )
    assert [assembler.take(f, 0.0) for f in (one, two, padded)][-1] == (Vin(VIN),)


def test_a_wrong_check_digit_is_reported_where_it_is_asked_for() -> None:
    wrong = "1M8GDM9A1KP042788"
    lax, strict = VinAssembler(), VinAssembler(check=True)
    results = [(lax.take(f, 0.0), strict.take(f, 0.0)) for f in split_vin(wrong)]
    assert results[-1][0] == (Vin(wrong),)
    [problem] = results[-1][1]
    assert isinstance(problem, Problem)
    assert problem.kind == "check"
    assert problem.text.startswith(f"{wrong}: check digit")
    assert [strict.take(f, 5.0) for f in split_vin(VIN)][-1] == (Vin(VIN),)


@pytest.mark.parametrize(
    ("length", "text"),
    [
        (0, "length 0: the sender does not transmit the text"),
        (28, "length 28; the frames carry 27 characters"),
    ],
)
def test_a_pack_code_without_a_possible_length_is_reported(length: Code5, text: str) -> None:
    assembler = PackCodeAssembler(rounds=1)
    _, *others = split_pack_code(CODE)
    refused = B2V_SysCode1(sys_code_length=length)
    assert assembler.take(refused, 0.0) == (Problem("pack_code", "length", text, 0.0),)
    assert [assembler.take(frame, 0.1) for frame in others] == [()] * 3
    assert assembler.missing() == "frame 1 of 4 is missing"


def test_a_code_that_is_withdrawn_in_mid_transfer_is_not_reported() -> None:
    assembler = PackCodeAssembler(rounds=1)
    first, *others = split_pack_code(CODE)
    frames = [first, B2V_SysCode1(sys_code_length=0), *others]
    outcomes = [each for frame in frames for each in assembler.take(frame, 0.0)]
    assert kinds(list(outcomes)) == ["conflict", "length"]


def test_messages_of_other_transfers_bring_nothing_about() -> None:
    assembler = VinAssembler()
    assert assembler.take(B2V_ST2(), 0.0) == ()
    assert assembler.take(split_pack_code(CODE)[0], 0.0) == ()
    assert assembler.deadline == math.inf
    assert assembler.missing() == "no frame has arrived"


def test_settings_that_make_no_sense_are_refused() -> None:
    with pytest.raises(ValueError, match="timeout 0 s"):
        VinAssembler(timeout=0)
    with pytest.raises(ValueError, match="0 rounds"):
        PackCodeAssembler(rounds=0)


def test_silence_after_a_set_that_was_never_complete_says_nothing_more() -> None:
    assembler = PackCodeAssembler()
    assembler.take(split_pack_code(CODE)[0], 0.0)
    assert kinds(list(assembler.expire(2.0))) == ["timeout"]
    assert assembler.expire(6.0) == ()
    assert assembler.missing() == "frames 2, 3, 4 of 4 are missing"
