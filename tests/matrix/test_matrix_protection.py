"""Checksums and counters of any kind stand in a cell of the matrix and are read back from it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from matrix.workbooks import HEADINGS, SPEED, save, small
from model.protected import message, signal

from dbcspec.matrix.read import read_matrix
from dbcspec.matrix.write import emit_matrix
from typedcan.model.errors import TypedcanError
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import Node, Protocol

PLAIN = Checksum(signal="Crc", algorithm="xor", covered=(1, 2, 3))
CHECKSUMS = [
    PLAIN,
    replace(PLAIN, covered=(7,)),
    replace(PLAIN, covered=(0, 3, 4, 5, 7, 6)),
    replace(PLAIN, algorithm="CRC-8/SAE-J1850"),
    replace(PLAIN, algorithm="sum modulus=255 complement=ones"),
    replace(PLAIN, algorithm="width=8 poly=0x3 init=0x0 refin=true refout=true xorout=0x7"),
    replace(PLAIN, before=(0, 255), after=(18,)),
    replace(PLAIN, data_ids=tuple(range(16))),
    replace(PLAIN, algorithm="Of_Nobody", is_open=True),
    replace(PLAIN, algorithm="Of_Nobody"),
    replace(PLAIN, before=(1,), data_ids=(2,), algorithm="Of_Nobody", is_open=True),
]
COUNTERS = [
    Counter(signal="Count", modulus=16),
    Counter(signal="Count", modulus=15, first=1),
    Counter(signal="Count", modulus=4, first=12, step=-4),
]


def come_back(folder: Path, checksum: Checksum, counter: Counter) -> Any:
    guarded = message(
        signal("Crc", 0, 8), signal("Count", 8, 4), checksum=checksum, counter=counter
    )
    protocol = Protocol(name="guarded", nodes=(Node(name="ECU"),), messages=(guarded,))
    path = folder / "guarded.xlsx"
    path.write_bytes(emit_matrix(protocol))
    (back,) = read_matrix(path).messages
    return back.checksum, back.counter


@pytest.mark.parametrize("checksum", CHECKSUMS, ids=str)
def test_a_checksum_comes_back_from_its_cell(checksum: Checksum, tmp_path: Path) -> None:
    assert come_back(tmp_path, checksum, COUNTERS[0]) == (checksum, COUNTERS[0])


@pytest.mark.parametrize("counter", COUNTERS, ids=str)
def test_a_counter_comes_back_from_its_cell(counter: Counter, tmp_path: Path) -> None:
    assert come_back(tmp_path, PLAIN, counter) == (PLAIN, counter)


@pytest.mark.parametrize(
    ("cell", "problem"),
    [
        ("Checksum xor", "expected 'Checksum xor, bytes 1~7' or 'Counter, modulus 16'"),
        ("Checksum xor, bytes 1-7", "expected 'Checksum xor, bytes 1~7'"),
        ("Checksum xor, bytes 7~1", "covers no byte: ranges rise"),
        ("Checksum xor, bytes 1~8", "bytes 1~8 are not in the message"),
        ("Checksum CRC-32/MEF, bytes 4", "CRC-32/MEF makes 32 bits, its signal has 16"),
        ("Checksum xor, bytes 4, before 0x100", "expected 'Checksum xor, bytes 1~7'"),
        ("Checksum xor, bytes 4, before 256", "before, after and data_ids are bytes"),
        ("Checksum xor, bytes 4, data_ids 1 2", "has no counter that chooses among data_ids"),
        ("Counter, modulus 65537", "it runs 0 to 65536, it may run within 0 to 65535"),
        ("Counter, modulus 2, step 0", "it may run within 0 to 65535"),
    ],
)
def test_a_cell_that_says_what_cannot_be_is_told(cell: str, problem: str, tmp_path: Path) -> None:
    with pytest.raises(TypedcanError) as caught:
        read_matrix(small(tmp_path / "m.xlsx", Protection=cell))
    assert problem in caught.value.lines[0]


def test_a_message_has_one_checksum_and_one_counter(tmp_path: Path) -> None:
    gear = ["Wheels", "0x123", 8, "Gear", "Intel", 16, 16, "S", "R"]
    for cell in ("Checksum xor, bytes 5", "Counter, modulus 16"):
        rows: list[list[object]] = [[*HEADINGS, "Protection"], [*SPEED, cell], [*gear, cell]]
        with pytest.raises(TypedcanError) as caught:
            read_matrix(save(tmp_path / "m.xlsx", rows))
        assert "Wheels has Speed already for this" in caught.value.lines[0]
    rows = [
        [*HEADINGS, "Protection"],
        [*SPEED, "Checksum xor, bytes 5"],
        [*gear, "Counter, modulus 16"],
    ]
    (found,) = read_matrix(save(tmp_path / "m.xlsx", rows)).messages
    assert found.checksum
    assert found.counter


def test_what_people_write_in_other_ways_is_understood(tmp_path: Path) -> None:
    cell = "checksum crc_16_arc, bytes 2~7, before 0XA 17"
    (found,) = read_matrix(small(tmp_path / "m.xlsx", Protection=cell)).messages
    assert found.checksum == Checksum(
        signal="Speed", algorithm="CRC-16/ARC", covered=(2, 3, 4, 5, 6, 7), before=(10, 17)
    )
