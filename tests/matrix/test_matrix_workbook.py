"""The workbook as others see it, through plain openpyxl."""

from __future__ import annotations

import io
from decimal import Decimal

import openpyxl
import pytest
from matrix.workbooks import MATRIX, columns, signal_rows
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from typedcan.model.protocol import Protocol

_BRIEF = {
    "报文名称": "Msg Name",
    "报文标识符": "Msg ID",
    "帧格式": "Frame Format",
    "发送类型": "Send Type",
    "周期": "Cycle Time (ms)",
    "报文长度": "Msg Length (Byte)",
    "信号名称": "Signal Name",
    "信号描述": "Signal Description",
    "排列格式": "Byte Order",
    "起始字节": "Start Byte",
    "起始位": "Start Bit",
    "信号长度": "Bit Length",
    "数据类型": "Data Type",
    "精度": "Resolution",
    "偏移量": "Offset",
    "物理最小值": "Min",
    "物理最大值": "Max",
    "初始值": "Initial Value (Hex)",
    "无效值": "Invalid Value (Hex)",
    "单位": "Unit",
    "信号值描述": "Signal Value Description",
    "复用": "Multiplexing",
    "标准出处": "Reference",
    "勘误": "Errata",
}


@pytest.fixture(scope="module")
def book(project_matrix: bytes) -> Workbook:
    return openpyxl.load_workbook(io.BytesIO(project_matrix))


@pytest.fixture(scope="module")
def matrix(book: Workbook) -> Worksheet:
    return book[MATRIX]


def test_every_heading_is_there_in_chinese_and_english(
    matrix: Worksheet, protocol: Protocol
) -> None:
    headings = [str(cell.value) for cell in matrix[1]]
    for chinese, english in _BRIEF.items():
        assert f"{chinese}\n{english}" in headings
    nodes = [node.name for node in protocol.nodes]
    assert headings[-len(nodes) :] == nodes


def test_there_is_a_row_for_each_message_and_each_signal(
    matrix: Worksheet, protocol: Protocol
) -> None:
    rows = matrix.max_row - 1
    assert rows == len(protocol.messages) + sum(1 for _ in protocol.signals())


def test_headings_stay_in_sight_and_filter_all_rows(matrix: Worksheet) -> None:
    assert matrix.freeze_panes == "H2"
    assert str(matrix["G1"].value).endswith("Signal Name")
    assert matrix.auto_filter.ref == matrix.dimensions
    assert all(matrix.column_dimensions[letter].width > 5 for letter in "ABCDEFG")


def test_numbers_are_numbers_and_identifiers_are_text(
    matrix: Worksheet, protocol: Protocol
) -> None:
    rows, places = signal_rows(matrix), columns(matrix)
    for _, each in protocol.signals():
        row = rows[each.name]
        for heading, value in (
            ("Start Bit", each.start),
            ("Bit Length", each.length),
            ("Start Byte", each.start // 8),
            ("Resolution", each.factor),
            ("Offset", each.offset),
            ("Min", each.minimum),
            ("Max", each.maximum),
        ):
            cell = matrix.cell(row, places[heading])
            assert cell.data_type == "n"
            assert Decimal(repr(cell.value)) == value
        assert matrix.cell(row, places["Msg ID"]).data_type == "s"


def test_identifiers_have_all_their_digits(matrix: Worksheet, protocol: Protocol) -> None:
    texts = {matrix.cell(row, 2).value for row in range(2, matrix.max_row + 1)}
    assert texts == {f"0x{message.frame_id:08X}" for message in protocol.messages}


def test_senders_and_receivers_are_marked(matrix: Worksheet, protocol: Protocol) -> None:
    rows, places = signal_rows(matrix), columns(matrix)
    for message, each in protocol.signals():
        row = rows[each.name]
        for node in protocol.nodes:
            wanted = {message.sender: "S", **dict.fromkeys(each.receivers, "R")}.get(node.name)
            assert matrix.cell(row, places[node.name]).value == wanted


def test_message_rows_look_different_from_signal_rows(matrix: Worksheet) -> None:
    names = columns(matrix)["Signal Name"]
    fills: dict[bool, set[str]] = {True: set(), False: set()}
    for row in range(2, matrix.max_row + 1):
        cell = matrix.cell(row, names)
        fills[cell.value is None].add(str(cell.fill.fgColor.rgb))
    assert len(fills[True]) == len(fills[False]) == 1
    assert fills[True] != fills[False]


def test_value_descriptions_have_a_code_a_line(matrix: Worksheet, protocol: Protocol) -> None:
    rows, places = signal_rows(matrix), columns(matrix)
    for _, each in protocol.signals():
        text = matrix.cell(rows[each.name], places["Signal Value Description"]).value
        table = each.value_table.codes if each.value_table else ()
        assert (text or "") == "\n".join(f"0x{code.value:X}: {code.label}" for code in table)


def test_the_cover_names_the_protocol_and_its_digest(book: Workbook, protocol: Protocol) -> None:
    cover = {row[0].value: row[1].value for row in book.worksheets[0].iter_rows()}
    assert cover["名称 / Name"] == protocol.name
    assert cover["编号 / Number"] == protocol.number
    assert cover["版本 / Edition"] == protocol.edition
    assert cover["摘要 / Digest"] == protocol.digest
    assert book.worksheets[0]["A2"].value == protocol.title


def test_every_erratum_stands_on_its_sheet(book: Workbook, protocol: Protocol) -> None:
    rows = list(book["勘误 Errata"].iter_rows(min_row=2, values_only=True))
    assert [row[0] for row in rows] == [erratum.id for erratum in protocol.errata]
    assert [row[5] for row in rows] == [erratum.because for erratum in protocol.errata]


def test_nodes_and_buses_stand_on_their_sheet(book: Workbook, protocol: Protocol) -> None:
    rows = list(book["节点与总线 Nodes"].iter_rows(values_only=True))
    first = {row[0]: row for row in rows}
    for node in protocol.nodes:
        assert first[node.name][3] == f"0x{node.address:02X}"
    for bus in protocol.buses:
        assert first[bus.name][3] == bus.bit_rate


def test_each_message_has_its_bits_in_colour(book: Workbook, protocol: Protocol) -> None:
    for message in protocol.messages:
        sheet = book[message.name]
        merged = {str(area): area for area in sheet.merged_cells.ranges}
        shown: dict[int, str] = {}
        for byte in range(message.length):
            for bit in range(8):
                cell = sheet.cell(4 + byte, 9 - bit)
                area = next((one for one in merged.values() if cell.coordinate in one), None)
                top = sheet.cell(area.min_row, area.min_col) if area else cell
                if top.value:
                    shown[8 * byte + bit] = str(top.value).split("\n")[0]
                    assert top.fill.fill_type == "solid"
                else:
                    assert top.fill.fill_type is None
        # The oracle counts bits in its own way: Motorola runs down a byte, then on to the next.
        wanted: dict[int, str] = {}
        for each in message.signals:
            place = each.start
            for _ in range(each.length):
                wanted[place] = each.name
                if each.byte_order.value == "Intel":
                    place += 1
                else:
                    place = place - 1 if place % 8 else place + 15
        assert shown == wanted


def test_neighbouring_signals_have_different_colours(book: Workbook) -> None:
    sheet = book["B2V_ST1"]
    colours = {sheet.cell(5, number).fill.fgColor.rgb for number in (2, 3, 4, 6)}
    assert len(colours) == 4
