"""Matrices as other people lay them out, and ours after somebody worked on them."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import openpyxl
import pytest
from emit.other_protocol import OTHER
from matrix.workbooks import (
    MATRIX,
    columns,
    edited,
    signal_rows,
    small,
)
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.matrix.read import read_matrix
from dbcspec.matrix.write import emit_matrix
from typedcan.model.protocol import Aspect, Protocol, SendType


@pytest.fixture(scope="module")
def data() -> bytes:
    return emit_matrix(OTHER)


def same(one: Protocol, other: Protocol) -> bool:
    """Equal in messages, but for Python names and the order of receivers."""

    def plain(protocol: Protocol) -> list[object]:
        return [
            dataclasses.replace(
                message,
                signals=tuple(
                    dataclasses.replace(
                        each, python_name="", receivers=tuple(sorted(each.receivers))
                    )
                    for each in message.signals
                ),
            )
            for message in protocol.messages
        ]

    return plain(one) == plain(other)


def rewrite_headings(language: int, sheet: Worksheet) -> None:
    for cell in sheet[1]:
        lines = str(cell.value).split("\n")
        cell.value = lines[min(language, len(lines) - 1)]


@pytest.mark.parametrize("language", [0, 1], ids=["Chinese only", "English only"])
def test_one_language_of_headings_is_enough(language: int, data: bytes, tmp_path: Path) -> None:
    path = edited(data, tmp_path / "m.xlsx", lambda sheet: rewrite_headings(language, sheet))
    assert same(read_matrix(path), OTHER)


def test_letter_case_spaces_and_width_of_headings_do_not_matter(
    data: bytes, tmp_path: Path
) -> None:
    def edit(sheet: Worksheet) -> None:
        for cell in sheet[1]:
            lines = str(cell.value).split("\n")
            if len(lines) == 2:
                cell.value = f"  {lines[0]} / {lines[1].upper().replace(' ', '_ ')}  "
            if lines[-1] == "Signal Name":
                cell.value = "ＳＩＧＮＡＬ　ｎａｍｅ"

    assert same(read_matrix(edited(data, tmp_path / "m.xlsx", edit)), OTHER)


def test_columns_may_stand_in_any_order_with_others_between(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "m.xlsx"
    path.write_bytes(data)
    book = openpyxl.load_workbook(path)
    rows = [list(row) for row in book[MATRIX].iter_rows(values_only=True)]
    turned = [
        [None, "Remark" if number == 0 else "see mail", *reversed(row)]
        for number, row in enumerate(rows)
    ]
    book.remove(book[MATRIX])
    sheet = book.create_sheet("Sheet1")
    sheet.append(["A matrix that somebody turned around"])
    for row in turned:
        sheet.append(row)
        sheet.append([])
    book.save(path)
    assert same(read_matrix(path), OTHER)


def test_sorting_the_rows_keeps_every_signal_in_its_message(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "m.xlsx"
    path.write_bytes(data)
    book = openpyxl.load_workbook(path)
    sheet = book[MATRIX]
    head, *rows = [list(row) for row in sheet.iter_rows(values_only=True)]
    sheet.delete_rows(1, sheet.max_row)
    for row in [head, *sorted(rows, key=lambda row: str(row[6]), reverse=True)]:
        sheet.append(row)
    book.save(path)
    back = read_matrix(path)
    assert {
        message.name: (message.length, message.sender, {each.name for each in message.signals})
        for message in back.messages
    } == {
        message.name: (message.length, message.sender, {each.name for each in message.signals})
        for message in OTHER.messages
    }


def test_merged_cells_of_messages_hold_for_all_their_rows(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    sheet = book.active
    assert isinstance(sheet, Worksheet)
    for row in (
        ("报文信息", None, None, "信号信息"),
        (
            "报文名称",
            "报文ID",
            "报文长度(Byte)",
            "信号名称",
            "字节序",
            "起始位",
            "长度",
            "网关",
            "仪表",
        ),
        ("Wheels", "0x123", 8, "Speed", "Intel", 0, 16, "S", "R"),
        (None, None, None, "Gear", "Intel", 16, 4, "S", "R"),
        (None, None, None, "Odo", "Intel", 24, 32, "S", None),
        ("Doors", "0x124", 2, "Left", "Intel", 0, 1, "R", "S"),
    ):
        sheet.append(row)
    for letter in "ABC":
        sheet.merge_cells(f"{letter}3:{letter}5")
    sheet.merge_cells("A1:C1")
    path = tmp_path / "merged.xlsx"
    book.save(path)
    back = read_matrix(path)
    assert [(m.name, m.frame_id, m.length, m.sender) for m in back.messages] == [
        ("Wheels", 0x123, 8, "网关"),
        ("Doors", 0x124, 2, "仪表"),
    ]
    assert [each.name for each in back.messages[0].signals] == ["Speed", "Gear", "Odo"]
    assert back.messages[0].signals[2].receivers == ()
    assert [node.name for node in back.nodes] == ["网关", "仪表"]


def test_a_matrix_says_only_what_it_has_columns_for(tmp_path: Path) -> None:
    assert read_matrix(small(tmp_path / "m.xlsx")).carries == frozenset()
    with_period = small(tmp_path / "n.xlsx", Cycle_Time=100)
    assert read_matrix(with_period).carries == {Aspect.PERIODS}


def test_what_is_not_said_gets_its_usual_value(tmp_path: Path) -> None:
    back = read_matrix(small(tmp_path / "m.xlsx"))
    [message] = back.messages
    [each] = message.signals
    assert back.name == "m"
    assert (message.extended, message.period, message.send_type) == (False, None, SendType.EVENT)
    assert (float(each.factor), float(each.offset), each.signed) == (1, 0, False)
    assert (int(each.minimum), int(each.maximum)) == (0, 65535)


def test_a_changed_cell_changes_that_fact_only(data: bytes, tmp_path: Path) -> None:
    def edit(sheet: Worksheet) -> None:
        sheet.cell(signal_rows(sheet)["Gear"], columns(sheet)["Resolution"]).value = 0.25

    back = read_matrix(edited(data, tmp_path / "m.xlsx", edit))
    changed = [
        (one.name, name)
        for (_, one), (_, other) in zip(OTHER.signals(), back.signals(), strict=True)
        for name in ("start", "length", "factor", "offset", "minimum", "maximum", "value_table")
        if getattr(one, name) != getattr(other, name)
    ]
    assert changed == [("Gear", "factor")]
