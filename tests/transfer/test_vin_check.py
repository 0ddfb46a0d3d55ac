"""What is a VIN: published ones, and the rules of ISO 3779 and 49 CFR 565.15 counted anew."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from swapcan.transfer import check_digit, is_valid_vin, vin_problem

LETTERS = "0123456789ABCDEFGHJKLMNPRSTUVWXYZ"
WEIGHTS = [8, 7, 6, 5, 4, 3, 2, 10, 0, 9, 8, 7, 6, 5, 4, 3, 2]

vins = st.text(LETTERS, min_size=17, max_size=17)


def value(letter: str) -> int:
    """The value of a letter in the regulation's table: the low digit of its EBCDIC code."""
    return letter.encode("cp037")[0] & 0xF


@pytest.mark.parametrize("vin", ["1M8GDM9AXKP042788", "11111111111111111", "5GZCZ43D13S812715"])
def test_published_vins_are_valid(vin: str) -> None:
    assert is_valid_vin(vin)
    assert check_digit(vin) == vin[8]


@given(vins)
def test_the_check_digit_is_the_weighted_sum_modulo_11(vin: str) -> None:
    remainder = sum(value(c) * w for c, w in zip(vin, WEIGHTS, strict=True)) % 11
    assert check_digit(vin) == ("X" if remainder == 10 else str(remainder))


@given(vins, st.integers(0, 16), st.sampled_from(LETTERS))
def test_one_wrong_character_of_another_value_is_noticed(vin: str, at: int, letter: str) -> None:
    good = vin[:8] + check_digit(vin) + vin[9:]
    wrong = good[:at] + letter + good[at + 1 :]
    differs = letter != good[at] if at == 8 else value(letter) != value(good[at])
    assert is_valid_vin(wrong) is not differs


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("1M8GDM9AXKP04278", "a VIN has 17 characters, not 16"),
        ("1M8GDM9AXKPO42788", "character 12 is 'O'; a VIN has no I, O and Q"),
        ("1m8GDM9AXKP042788", "character 2, 'm', is no digit or capital letter"),
        ("1M8GDM9A1KP042788", "check digit (position 9) is '1', the other characters make 'X'"),
    ],
)
def test_what_is_no_vin_is_told_why(text: str, problem: str) -> None:
    assert vin_problem(text) == problem


def test_a_text_that_cannot_be_a_vin_has_no_check_digit() -> None:
    with pytest.raises(ValueError, match="no I, O and Q"):
        check_digit("IM8GDM9AXKP042788")


def test_what_stands_in_the_place_of_the_check_digit_does_not_matter_to_it() -> None:
    assert check_digit("1M8GDM9A?KP042788") == "X"
