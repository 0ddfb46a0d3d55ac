"""CRCs have the check values of the public catalogue; sums and XOR those of a pencil."""

from __future__ import annotations

import random

import crccheck.crc  # type: ignore[import-untyped]
import pytest
from oracles.bitwise_crc import Parameters, crc

from typedcan.model.checksums.methods import Crc, Sum, Xor
from typedcan.model.checksums.registry import method_of, names

CHECK = b"123456789"

# The checks of the catalogue, copied from it by hand for those that buses of cars and plants use.
CHECKS = {
    "CRC-3/GSM": 0x4,
    "CRC-4/G-704": 0x7,
    "CRC-5/USB": 0x19,
    "CRC-6/GSM": 0x13,
    "CRC-7/MMC": 0x75,
    "CRC-8/AUTOSAR": 0xDF,
    "CRC-8/BLUETOOTH": 0x26,
    "CRC-8/MAXIM-DOW": 0xA1,
    "CRC-8/NRSC-5": 0xF7,
    "CRC-8/ROHC": 0xD0,
    "CRC-8/SAE-J1850": 0x4B,
    "CRC-8/SMBUS": 0xF4,
    "CRC-8/TECH-3250": 0x97,
    "CRC-8/WCDMA": 0x25,
    "CRC-10/ATM": 0x199,
    "CRC-11/FLEXRAY": 0x5A3,
    "CRC-12/UMTS": 0xDAF,
    "CRC-15/CAN": 0x059E,
    "CRC-16/ARC": 0xBB3D,
    "CRC-16/DNP": 0xEA82,
    "CRC-16/GENIBUS": 0xD64E,
    "CRC-16/IBM-3740": 0x29B1,
    "CRC-16/IBM-SDLC": 0x906E,
    "CRC-16/KERMIT": 0x2189,
    "CRC-16/MODBUS": 0x4B37,
    "CRC-16/USB": 0xB4C8,
    "CRC-16/XMODEM": 0x31C3,
    "CRC-17/CAN-FD": 0x04F03,
    "CRC-21/CAN-FD": 0x0ED841,
    "CRC-24/FLEXRAY-A": 0x7979BD,
    "CRC-32/AUTOSAR": 0x1697D06A,
    "CRC-32/BZIP2": 0xFC891918,
    "CRC-32/ISCSI": 0xE3069283,
    "CRC-32/ISO-HDLC": 0xCBF43926,
    "CRC-64/ECMA-182": 0x6C40DF5F0B497347,
    "CRC-64/XZ": 0x995DC9BBDF1939FA,
}

PEERS = [peer for peer in crccheck.crc.ALLCRCCLASSES if peer._width <= 64]


@pytest.mark.parametrize("name", CHECKS)
def test_a_crc_has_the_check_value_of_the_catalogue(name: str) -> None:
    assert method_of(name).function(64)(CHECK) == CHECKS[name]


@pytest.mark.parametrize("peer", PEERS, ids=lambda peer: peer._names[0])
def test_all_of_the_catalogue_agrees_with_another_implementation(peer: type) -> None:
    dice = random.Random(1)
    name, *others = peer._names  # type: ignore[attr-defined]
    assert name in names()
    for each in (name, *(other for other in others if "/" in other)):
        assert method_of(each) == method_of(name)
    ours = method_of(name).function(64)
    for length in range(10):
        data = dice.randbytes(length)
        assert ours(data) == peer.calc(data)  # type: ignore[attr-defined]


def test_a_crc_of_any_parameters_is_the_remainder_of_a_division() -> None:
    dice = random.Random(2)
    for width in range(1, 65):
        for refin, refout in ((False, False), (True, True), (False, True), (True, False)):
            poly, init, xorout = (dice.getrandbits(width) for _ in range(3))
            given = Parameters(width, poly, init, refin, refout, xorout)
            ours = Crc(**given._asdict()).function(width)
            for length in (0, 1, 9):
                data = dice.randbytes(length)
                assert ours(data) == crc(given, data), given


def test_what_is_not_said_of_a_crc_is_nothing() -> None:
    assert Crc(width=8, poly=0x07).function(8)(CHECK) == CHECKS["CRC-8/SMBUS"]


def test_sums_are_taken_modulo_what_the_signal_holds() -> None:
    data = bytes([0xFF, 0x02, 0x10])  # 255 + 2 + 16 = 273 = 0x111
    assert Sum().function(8)(data) == 0x11
    assert Sum().function(16)(data) == 0x111
    assert Sum().function(4)(data) == 0x1
    assert Sum(modulus=255).function(8)(data) == 18
    assert Sum(complement="ones").function(8)(data) == 0xEE
    assert Sum(complement="twos").function(8)(data) == 0xEF
    assert Sum(complement="twos").function(8)(bytes([0xFF, 0x01])) == 0
    assert Sum(complement="ones", modulus=255).function(8)(data) == 254 - 18
    assert Sum(unit=4).function(8)(data) == 15 + 15 + 0 + 2 + 1 + 0


def test_xor_is_that_of_bytes_or_of_their_halves() -> None:
    assert Xor().function(8)(bytes([0x12, 0x34, 0x56])) == 0x70
    assert Xor(unit=4).function(4)(bytes([0x12, 0x34])) == 1 ^ 2 ^ 3 ^ 4
    assert Xor().function(8)(b"") == 0
