"""Matrices as other people write them, and ours after somebody worked on them."""

from __future__ import annotations

import dataclasses
import zipfile
from collections.abc import Sequence
from decimal import Decimal
from pathlib import Path

import openpyxl
import pytest
from emit.other_protocol import OTHER
from matrix.workbooks import HEADINGS, MATRIX, SPEED, column, edited, repacked, row_of, save, small
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.emit.matrix import emit_matrix
from dbcspec.errors import SpecError
from dbcspec.model import Aspect, ByteOrder, Protocol, SendType, Signal
from dbcspec.read.matrix import read_matrix


@pytest.fixture(scope="module")
def data() -> bytes:
    return emit_matrix(OTHER)


def only_signal(path: Path) -> Signal:
    [(_, each)] = read_matrix(path).signals()
    return each


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


@pytest.mark.parametrize(
    "text", ["0x18FF1234", "0X18ff1234", "18FF1234", "18FF1234h", " 18FF 1234 "]
)
def test_identifiers_are_hexadecimal_with_or_without_0x(text: str, tmp_path: Path) -> None:
    [message] = read_matrix(small(tmp_path / "m.xlsx", Msg_ID=text)).messages
    assert (message.frame_id, message.extended) == (0x18FF1234, True)


@pytest.mark.parametrize("value", ["１６", "16", " 16 ", 16.0])
def test_numbers_may_be_text_and_full_width(value: object, tmp_path: Path) -> None:
    assert only_signal(small(tmp_path / "m.xlsx", Bit_Length=value)).length == 16


@pytest.mark.parametrize(
    ("value", "wanted"),
    [(0.1, "0.1"), ("0.1", "0.1"), ("１．５", "1.5"), ("−40", "-40"), ("1E-3", "0.001")],
)
def test_factors_are_exact(value: object, wanted: str, tmp_path: Path) -> None:
    assert only_signal(small(tmp_path / "m.xlsx", Resolution=value)).factor == Decimal(wanted)


def test_a_calculated_number_is_what_excel_shows(tmp_path: Path) -> None:
    path = small(tmp_path / "m.xlsx", Resolution=0.1)
    with zipfile.ZipFile(path) as archive:
        sheet = archive.read("xl/worksheets/sheet1.xml")
    calculated = sheet.replace(b"<v>0.1</v>", b"<v>0.30000000000000004</v>")
    assert calculated != sheet
    repacked(path.read_bytes(), path, {"xl/worksheets/sheet1.xml": calculated})
    assert only_signal(path).factor == Decimal("0.3")


@pytest.mark.parametrize(
    ("heading", "value", "wanted"),
    [
        ("Invalid Value (Hex)", "0xFFFF", 0xFFFF),
        ("Invalid Value (Hex)", "FFFF", 0xFFFF),
        ("Invalid Value (Hex)", "10", 0x10),
        ("Invalid Value (Hex)", 10, 0x10),
        ("Invalid Value", 10, 10),
        ("Invalid Value", "0x10", 0x10),
        ("无效值", "65535", 65535),
    ],
)
def test_raw_values_are_hexadecimal_where_they_say_so(
    heading: str, value: object, wanted: int, tmp_path: Path
) -> None:
    path = save(tmp_path / "m.xlsx", [[*HEADINGS, heading], [*SPEED, value]])
    assert only_signal(path).invalid_code == wanted


def test_negative_raw_values_are_read_from_their_bits(tmp_path: Path) -> None:
    path = small(
        tmp_path / "m.xlsx", Data_Type="Signed", Bit_Length=8, Invalid_Value="0x80",
        Signal_Value_Description="0xFF: off\n0x1: on\n-2: odd",
    )  # fmt: skip
    each = only_signal(path)
    assert each.invalid_code == -128
    assert each.value_table
    assert each.value_table.labels() == {-2: "odd", -1: "off", 1: "on"}


@pytest.mark.parametrize(
    "text",
    [
        "0x0: 打开\n0x1: 关闭",
        "0:打开\n1:关闭",
        "0x0：打开\n0x1：关闭",
        "0=打开\r\n1 = 关闭",
        "0x00:打开\n\n0x01:关闭\n",
    ],
)
def test_codes_are_read_in_the_usual_spellings(text: str, tmp_path: Path) -> None:
    each = only_signal(small(tmp_path / "m.xlsx", Signal_Value_Description=text))
    assert each.value_table
    assert {code: label.strip() for code, label in each.value_table.labels().items()} == {
        0: "打开",
        1: "关闭",
    }


@pytest.mark.parametrize(
    ("order", "start", "length", "wanted"),
    [
        ("Intel", 8, 16, (ByteOrder.INTEL, 8)),
        ("Motorola MSB", 15, 16, (ByteOrder.MOTOROLA, 15)),
        ("Motorola", 15, 16, (ByteOrder.MOTOROLA, 15)),
        ("Motorola LSB", 16, 16, (ByteOrder.MOTOROLA, 15)),
        ("Motorola LSB", 20, 10, (ByteOrder.MOTOROLA, 13)),
        ("大端 Motorola (LSB)", 4, 4, (ByteOrder.MOTOROLA, 7)),
    ],
)
def test_start_bits_follow_the_byte_order(
    order: str, start: int, length: int, wanted: tuple[ByteOrder, int], tmp_path: Path
) -> None:
    path = small(tmp_path / "m.xlsx", Byte_Order=order, Start_Bit=start, Bit_Length=length)
    each = only_signal(path)
    assert (each.byte_order, each.start) == wanted


@pytest.mark.parametrize(
    ("word", "signed", "is_float"),
    [
        ("Unsigned", False, False),
        ("无符号", False, False),
        ("signed", True, False),
        ("有符号数", True, False),
        ("Float", True, True),
        ("IEEE 单精度浮点", True, True),
        ("uint16", False, False),
        ("sint16", True, False),
        (None, False, False),
    ],
)
def test_data_types_are_read_in_the_usual_words(
    word: str | None, signed: object, is_float: object, tmp_path: Path
) -> None:
    each = only_signal(small(tmp_path / "m.xlsx", Data_Type=word, Bit_Length=32))
    assert (each.signed, each.is_float) == (signed, is_float)


@pytest.mark.parametrize(
    ("word", "wanted"),
    [
        ("Cyclic", SendType.CYCLIC),
        ("周期型", SendType.CYCLIC),
        ("事件", SendType.EVENT),
        ("IfActive", SendType.IF_ACTIVE),
        ("On Event", SendType.EVENT),
        (None, SendType.CYCLIC),
    ],
)
def test_send_types_are_read_in_the_usual_words(
    word: str | None, wanted: SendType, tmp_path: Path
) -> None:
    path = small(tmp_path / "m.xlsx", Send_Type=word, Cycle_Time=100)
    assert read_matrix(path).messages[0].send_type is wanted


def test_bytes_may_be_counted_from_one(tmp_path: Path) -> None:
    rows: list[list[object]] = [
        [*HEADINGS, "Start Byte"],
        [*SPEED, 1],
        ["Wheels", "0x123", 8, "Gear", "Intel", 16, 4, "S", "R", 3],
    ]
    assert len(list(read_matrix(save(tmp_path / "m.xlsx", rows)).signals())) == 2


def test_bus_limits_stand_in_for_missing_physical_ones(tmp_path: Path) -> None:
    path = small(
        tmp_path / "m.xlsx", **{"Bus Min (Hex)": "0x0", "Bus Max (Hex)": "0xFA"},
        Resolution=0.5, Offset=-40,
    )  # fmt: skip
    each = only_signal(path)
    assert (float(each.minimum), float(each.maximum)) == (-40, 85)


def test_receivers_on_the_row_of_the_message_hold_for_its_signals(tmp_path: Path) -> None:
    rows: list[Sequence[object]] = [
        list(HEADINGS),
        ["Wheels", "0x123", 8, None, None, None, None, "S", "R"],
        ["Wheels", "0x123", None, "Speed", "Intel", 0, 16, None, None],
    ]
    back = read_matrix(save(tmp_path / "m.xlsx", rows))
    assert back.messages[0].sender == "ECU"
    assert back.messages[0].signals[0].receivers == ("DASH",)


def test_a_changed_cell_changes_that_fact_only(data: bytes, tmp_path: Path) -> None:
    def edit(sheet: Worksheet) -> None:
        sheet.cell(row_of(sheet, "Gear"), column(sheet, "Resolution")).value = 0.25

    back = read_matrix(edited(data, tmp_path / "m.xlsx", edit))
    changed = [
        (one.name, name)
        for (_, one), (_, other) in zip(OTHER.signals(), back.signals(), strict=True)
        for name in ("start", "length", "factor", "offset", "minimum", "maximum", "value_table")
        if getattr(one, name) != getattr(other, name)
    ]
    assert changed == [("Gear", "factor")]


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
        ({"DASH": "S"}, "two senders"),
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
