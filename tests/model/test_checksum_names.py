"""Algorithms are found by their names and parameters, and what is none is told in one line."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from typedcan.model.checksums.methods import Crc, Sum, Xor
from typedcan.model.checksums.registry import (
    AlgorithmError,
    canonical_name,
    chosen_of,
    function_of,
    is_known,
    method_of,
    names,
)


def test_the_case_and_punctuation_of_names_do_not_count() -> None:
    j1850 = Crc(width=8, poly=0x1D, init=0xFF, xorout=0xFF)
    for name in ("CRC-8/SAE-J1850", "crc8_sae_j1850", "Crc 8 SAE J1850"):
        assert method_of(name) == j1850
    assert method_of("XOR") == Xor()
    assert method_of("Sum modulus=0xff complement=Ones") == Sum(modulus=255, complement="ones")


def test_names_of_other_standards_lead_to_the_one_of_the_catalogue() -> None:
    assert canonical_name("CRC-16/CCITT-FALSE") == "CRC-16/IBM-3740"
    assert canonical_name("crc_16_autosar") == "CRC-16/IBM-3740"
    assert canonical_name("CRC-8/MAXIM") == "CRC-8/MAXIM-DOW"


def test_parameters_of_a_named_crc_are_that_crc() -> None:
    text = "width=8 poly=0x2F init=0xFF refin=false refout=false xorout=0xFF check=0xDF"
    assert canonical_name(text) == "CRC-8/AUTOSAR"


@pytest.mark.parametrize(
    "text",
    [
        "width=8 poly=0x1 init=0x0 refin=true refout=false xorout=0x0",
        "width=13 poly=0x1FFF init=0x12 refin=false refout=true xorout=0x0",
        *("sum modulus=255 complement=ones", "sum complement=twos unit=4", "xor unit=4"),
        *("crc_of_nobody", "sum unit=3"),
    ],
)
def test_what_has_no_name_stands_as_it_is_written(text: str) -> None:
    assert canonical_name(text) == text


def test_parameters_reach_from_the_narrowest_crc_to_the_widest() -> None:
    assert method_of("width=1 poly=1 init=1 xorout=1") == Crc(width=1, poly=1, init=1, xorout=1)
    assert method_of("width=8 poly=0xff") == Crc(width=8, poly=255)
    assert method_of("width=64 poly=0") == Crc(width=64, poly=0)
    assert method_of("sum modulus=0x100000000") == Sum(modulus=1 << 32)


def test_every_name_stands_for_itself() -> None:
    assert len(names()) > 100
    for name in names():
        assert canonical_name(name) == name
        assert is_known(name)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("crc_of_nobody", "nothing here computes 'crc_of_nobody'; known are xor, sum and CRCs"),
        ("crc8_j1850", "is it CRC-8/SAE-J1850?"),
        ("", "nothing here computes ''"),
        ("crc-8", "nothing here computes 'crc-8'"),
        ("width=8", "poly is to be a number from 0 to 0xFF"),
        ("width=0 poly=1", "width is to be a number from 1 to 0x40"),
        ("width=65 poly=1", "width is to be a number from 1 to 0x40"),
        ("width=8 poly=0x100", "poly is to be a number from 0 to 0xFF"),
        ("width=8 poly=1 init=-1", "init is to be a number from 0 to 0xFF"),
        ("width=8 poly=1 refin=maybe", "refin is to be false or true"),
        ("width=8 poly=1 width=8", "expected parameters such as width=8"),
        ("width=8 poly=1 twice", "expected parameters such as width=8"),
        ("width=8 poly=1 pol=1", "there is no parameter pol"),
        ("width=8 poly=0x2F init=0xFF xorout=0xFF check=0xDE", "they make 0xDF of '123456789'"),
        ("sum modulo=3", "there is no parameter modulo"),
        ("sum complement=threes", "complement is to be ones or twos"),
        ("sum modulus=0x100000001", "modulus is to be a number from 0 to 0x100000000"),
        ("xor unit=16", "unit is to be 8 or 4"),
        ("xor of bytes", "expected parameters"),
    ],
)
def test_what_is_no_algorithm_is_said_in_one_line(text: str, problem: str) -> None:
    with pytest.raises(AlgorithmError) as caught:
        method_of(text)
    assert problem in str(caught.value)
    assert "\n" not in str(caught.value)
    assert not is_known(text)


def test_what_is_given_stands_before_what_is_known() -> None:
    assert chosen_of("xor", {}) == Xor()
    assert chosen_of("mine", {"mine": "crc8 autosar"}) == method_of("CRC-8/AUTOSAR")
    assert chosen_of("yours", {"mine": "xor"}) is None
    ours = function_of("xor", 8, {"xor": len})
    assert ours
    assert ours(b"12345") == 5
    with pytest.raises(AlgorithmError, match="nothing here computes 'none'"):
        chosen_of("mine", {"mine": "none"})


def test_results_that_the_signal_cannot_hold_are_refused() -> None:
    assert function_of("CRC-8/AUTOSAR", 8, {})
    with pytest.raises(AlgorithmError, match="CRC-8/AUTOSAR makes 8 bits, its signal has 7"):
        function_of("CRC-8/AUTOSAR", 7, {})
    with pytest.raises(AlgorithmError, match="sum modulus=257 makes 9 bits, its signal has 8"):
        function_of("sum modulus=257", 8, {})
    assert function_of("sum modulus=256", 8, {})
    assert function_of("xor unit=4", 4, {})


def failing(data: bytes) -> int:
    raise ZeroDivisionError(f"of\n{len(data)}")


@pytest.mark.parametrize(
    ("function", "problem"),
    [
        (failing, "the algorithm mine raised ZeroDivisionError: of 3"),
        (lambda data: data, "the algorithm mine made b'abc', which is no int"),
        (bool, "the algorithm mine made True, which is no int"),
        (lambda data: 2.0 * len(data), "the algorithm mine made 6.0, which is no int"),
        (lambda data: 253 + len(data), "the algorithm mine made 256, its signal has 8 bits"),
        (lambda data: -len(data), "the algorithm mine made -3, its signal has 8 bits"),
    ],
)
def test_a_function_that_makes_no_checksum_is_named(
    function: Callable[[bytes], int], problem: str
) -> None:
    compute = function_of("mine", 8, {"mine": function})
    assert compute
    with pytest.raises(AlgorithmError) as caught:
        compute(b"abc")
    assert str(caught.value) == problem
