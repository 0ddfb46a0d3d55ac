"""The text of an error: one short line that can be printed, whatever the value was."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
import pytest
from fields.any_values import HOSTILE, tried

import swapcan
from swapcan import EncodeError, Message
from swapcan import messages as m


def command(value: Any) -> Message:
    return m.V2B_CMD(hv_on_off=value)


def status(value: Any) -> Message:
    return m.B2V_ST2(soc=value)


def count(value: Any) -> Message:
    return m.B2V_ST4(max_temp_position=value)


def vin(value: Any) -> Message:
    return m.V2B_VIN(b1_8_15=value)


def refusal(message: Message) -> str:
    with pytest.raises(EncodeError) as refused:
        swapcan.encode(message)
    return refused.value.problem


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (10**40 - 1, 40 * "9"),
        (10**40, "a number of about 40 digits"),
        (-(10**40), "a number of about 40 digits"),
    ],
)
def test_a_number_that_nobody_would_read_is_not_written_out(value: int, text: str) -> None:
    assert refusal(count(value)).startswith(f"{text} is out of range")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ([56 * "x"], f"['{56 * 'x'}']"),
        ([57 * "x"], f"['{55 * 'x'}..."),
        ([1, 2, 3, 4, 5, 6, 7, 8], "[1, 2, 3, 4, 5, 6, ...]"),
        ([[[[1]]]], "[[[...]]]"),
        (bytes(1000), None),
        ({"key": 1000 * "x"}, None),
    ],
)
def test_of_what_is_long_the_error_shows_a_part(value: object, text: str | None) -> None:
    problem = refusal(status(value)).removeprefix("expected a number, 0 to 102 %, not ")
    assert len(problem) <= 60
    assert text is None or problem == text


class Mute:
    """It has no text."""

    def __repr__(self) -> str:
        raise ZeroDivisionError


class Line(str):
    """Its text is its own affair."""

    __slots__ = ()

    def __repr__(self) -> str:
        return f"{self}\n\x1b[2J"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (Mute(), "a Mute"),
        (Fraction(10**5000, 3), "a Fraction"),
        (Line("up"), "up\\n\\x1b[2J"),
        (Line(100 * "x"), f"{57 * 'x'}..."),
    ],
    ids=["raises", "too_long_for_python", "control_characters", "long"],
)
def test_what_has_no_proper_text_gets_one(value: object, text: str) -> None:
    assert refusal(status(value)) == f"expected a number, 0 to 102 %, not {text}"


LONG: list[Callable[[], object]] = [
    lambda: "x" * 10**6,
    lambda: "\x1b[2J\r\n\u202e电\ud800",
    lambda: b"\x00" * 10**6,
    lambda: list(range(10**6)),
    lambda: {"a": [{"b": [[10**10_000]]}]},
    lambda: np.zeros((100, 100)),
    lambda: Fraction(10**5000, 3),
    lambda: 10**10_000,
    type("C" * 1000, (), {}),
    *HOSTILE,
]


@pytest.mark.parametrize("make", [command, status, count, vin], ids=lambda make: make.__name__)
def test_the_text_of_an_error_is_one_short_line_whatever_was_given(
    make: Callable[[Any], Message],
) -> None:
    refused = [
        str(result)
        for value in LONG
        if isinstance(result := tried(partial(swapcan.encode, make(value()))), EncodeError)
    ]
    assert len(refused) > len(LONG) / 2
    for text in refused:
        assert text.isprintable()
        assert len(text) < 200
