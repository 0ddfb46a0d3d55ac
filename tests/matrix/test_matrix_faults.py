"""Faulty cells: all of them are named, with sheet, row and column."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from matrix.workbooks import (
    HEADINGS,
    SPEED,
    save,
    small,
)

from dbcspec.errors import SpecError
from dbcspec.matrix.read import read_matrix


def test_faulty_cells_are_all_named_with_sheet_row_and_column(tmp_path: Path) -> None:
    path = save(
        tmp_path / "bad.xlsx",
        [
            [*HEADINGS, "Resolution", "Data Type", "Signal Value Description"],
            [*SPEED, "=1/3", "Complex", "open"],
            ["Wheels", "0x123", None, "Gear", "PDP", "x", 2.5, "S", "?", 0, None, "0: a\n0: b"],
            ["Doors", 124, 8, "Left", "Intel", 0, 0, "S", "R", True, None, None],
        ],
    )
    with pytest.raises(SpecError) as caught:
        read_matrix(path)
    shown = {(fault.where.line, fault.where.column): fault.text for fault in caught.value.faults}
    assert {fault.where.path for fault in caught.value.faults} == {f"{path}!CAN"}
    assert set(shown) == {
        (2, 10), (2, 11), (2, 12), (3, 5), (3, 6), (3, 7), (3, 9), (3, 10), (3, 12), (4, 2),
    }  # fmt: skip
    assert "formula" in shown[2, 10]
    assert "Motorola" in shown[3, 5]
    assert "resolution of 0" in shown[3, 10]
    assert "write 0x" in shown[4, 2]
    assert all("\n" not in text for text in shown.values())


@pytest.mark.parametrize(
    ("cells", "word"),
    [
        ({"Msg_ID": None}, "identifier"),
        ({"Msg_ID": "0x20000000"}, "identifier"),
        ({"Msg_ID": "hello"}, "identifier"),
        ({"Frame_Format": "Standard", "Msg_ID": "0x800"}, "11-bit"),
        ({"Frame_Format": "FlexRay"}, "Extended or Standard"),
        ({"Msg_Length": None}, "has no length"),
        ({"Bit_Length": None}, "has no length"),
        ({"Start_Bit": None}, "has no start bit"),
        ({"Start_Bit": -1}, "whole number"),
        ({"Signal_Name": None}, "without a name"),
        ({"Start_Byte": 5, "Start_Bit": 0}, "does not hold"),
        ({"Send_Type": "whenever"}, "Cyclic, IfActive or Event"),
        ({"Multiplexing": "m0"}, "no selector"),
        ({"Multiplexing": "perhaps"}, "expected M"),
        ({"Protection": "CRC"}, "Checksum xor"),
        ({"Resolution": "1,5"}, "a number such as"),
        ({"Resolution": "nan"}, "a number such as"),
        ({"Cycle_Time": "#N/A"}, "stands here"),
        ({"Byte_Order": None}, "Intel"),
        ({"Start_Bit": 3, "Byte_Order": "Motorola LSB"}, "begin before"),
    ],
)
def test_each_fault_says_what_to_do(cells: dict[str, object], word: str, tmp_path: Path) -> None:
    with pytest.raises(SpecError) as caught:
        read_matrix(small(tmp_path / "m.xlsx", **cells))
    assert any(word in fault.text for fault in caught.value.faults), str(caught.value)


def test_contradicting_rows_of_one_message_are_reported(tmp_path: Path) -> None:
    rows: list[Sequence[object]] = [
        list(HEADINGS),
        SPEED,
        ["Wheels", "0x123", 7, "Gear", "Intel", 16, 4, "S", "R"],
        ["Wheels", "0x123", 8, "Speed", "Intel", 24, 4, "S", "R"],
    ]
    with pytest.raises(SpecError) as caught:
        read_matrix(save(tmp_path / "m.xlsx", rows))
    texts = [fault.text for fault in caught.value.faults]
    assert texts == ["Wheels: differs from row 2, which says '8'", "Wheels has two signals Speed"]
