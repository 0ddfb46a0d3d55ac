"""VIN and pack code into frames: the bytes of tables 8 and 15."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from transfer.wire import ALPHABET, payloads

from swapcan.messages import Manufacturer
from swapcan.transfer import split_pack_code, split_vin
from swapcan.transfer.text import PACK_CODE
from swapcan.transfer.text import VIN as VIN_TRANSFER
from typedcan.transfer import TransferError, characters

VIN = "1M8GDM9AXKP042788"
CODE = "04QPE4C8J4K5L6M7N8P9R0S1"


def test_a_vin_takes_three_frames_the_last_filled_up_with_zeros() -> None:
    assert payloads(split_vin(VIN)) == [
        "01" + b"1M8GDM9".hex(),
        "02" + b"AXKP042".hex(),
        "03" + b"788\0\0\0\0".hex(),
    ]


def test_a_pack_code_takes_four_frames_with_manufacturer_length_and_checksums() -> None:
    bodies = [
        bytes([Manufacturer.LG | len(CODE) << 3]) + b"04QPE4",
        b"C8J4K5L",
        b"6M7N8P9",
        b"R0S1\0\0\0",
    ]
    frames = payloads(split_pack_code(CODE, Manufacturer.LG))
    assert [frame[2:] for frame in frames] == [body.hex() for body in bodies]
    for frame in map(bytes.fromhex, frames):
        checksum = 0
        for byte in frame[1:]:
            checksum ^= byte
        assert frame[0] == checksum


def test_a_short_and_the_longest_pack_code_have_room() -> None:
    first, *others = payloads(split_pack_code("Z"))
    assert first[2:] == "08" + b"Z\0\0\0\0\0".hex()
    assert others == ["00" * 8] * 3
    assert payloads(split_pack_code("7" * 27))[3][2:] == b"7777777".hex()


@pytest.mark.parametrize(
    ("split", "problem"),
    [
        (lambda: split_vin("1M8GDM9AXKP04278"), "vin: a VIN has 17 characters, not 16"),
        (lambda: split_vin("1M8GDM9AXKP04278-"), "vin: character 17, '-', is none of 0123"),
        (lambda: split_vin("1M8GDM9A1KP042788", check=True), "vin: check digit"),
        (lambda: split_pack_code(""), "pack_code: a pack code has 1 to 27 characters, not 0"),
        (lambda: split_pack_code("7" * 28), "not 28"),
        (lambda: split_pack_code("7é"), "pack_code: character 2, 'é', is none of 0123"),
        (lambda: split_pack_code("7", 8), "pack_code: there is no manufacturer code 8"),
    ],
)
def test_what_does_not_fit_is_refused(split: Callable[[], object], problem: str) -> None:
    with pytest.raises(TransferError) as error:
        split()
    assert problem in str(error.value)


def test_letters_that_the_frames_have_but_a_vin_has_not_pass_unless_checked() -> None:
    vin = "IOQ45678901234567"
    assert payloads(split_vin(vin))[0] == "01" + b"IOQ4567".hex()
    with pytest.raises(TransferError, match="character 1 is 'I'"):
        split_vin(vin, check=True)


def test_the_characters_of_a_text_are_those_that_all_its_items_can_hold() -> None:
    assert characters(PACK_CODE) == characters(VIN_TRANSFER) == set(ALPHABET)
