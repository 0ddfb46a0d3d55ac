"""What stands in single cells, as people write it."""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from decimal import Decimal
from pathlib import Path

import pytest
from matrix.workbooks import (
    HEADINGS,
    SPEED,
    repacked,
    save,
    small,
)

from dbcspec.matrix.read import read_matrix
from typedcan.model.protocol import ByteOrder, SendType, Signal


def only_signal(path: Path) -> Signal:
    [(_, each)] = read_matrix(path).signals()
    return each


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


def test_receivers_on_the_signal_rows_the_message_hold_for_its_signals(tmp_path: Path) -> None:
    rows: list[Sequence[object]] = [
        list(HEADINGS),
        ["Wheels", "0x123", 8, None, None, None, None, "S", "R"],
        ["Wheels", "0x123", None, "Speed", "Intel", 0, 16, None, None],
    ]
    back = read_matrix(save(tmp_path / "m.xlsx", rows))
    assert back.messages[0].sender == "ECU"
    assert back.messages[0].signals[0].receivers == ("DASH",)
