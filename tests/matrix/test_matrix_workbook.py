"""The workbook as others see it: plain openpyxl, the zip directory, the XML."""

from __future__ import annotations

import io
import os
import platform
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
import zipfile
from collections.abc import Iterator
from datetime import date
from decimal import Decimal
from importlib.metadata import version
from pathlib import Path

import openpyxl
import pytest
from emit.other_protocol import OTHER, signal
from matrix.workbooks import MATRIX, column, row_of
from openpyxl.workbook import Workbook
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.emit.matrix import emit_matrix
from dbcspec.model import Message, Protocol

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
_RISKY = ("=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "=cmd|' /C calc'!A0", "#N/A")


@pytest.fixture(scope="module")
def data(protocol: Protocol) -> bytes:
    return emit_matrix(protocol)


@pytest.fixture(scope="module")
def book(data: bytes) -> Workbook:
    return openpyxl.load_workbook(io.BytesIO(data))


@pytest.fixture(scope="module")
def matrix(book: Workbook) -> Worksheet:
    return book[MATRIX]


def parts(data: bytes) -> Iterator[tuple[zipfile.ZipInfo, bytes]]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for entry in archive.infolist():
            yield entry, archive.read(entry)


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
    for _, each in protocol.signals():
        row = row_of(matrix, each.name)
        for heading, value in (
            ("Start Bit", each.start),
            ("Bit Length", each.length),
            ("Start Byte", each.start // 8),
            ("Resolution", each.factor),
            ("Offset", each.offset),
            ("Min", each.minimum),
            ("Max", each.maximum),
        ):
            cell = matrix.cell(row, column(matrix, heading))
            assert cell.data_type == "n"
            assert Decimal(repr(cell.value)) == value
        assert matrix.cell(row, column(matrix, "Msg ID")).data_type == "s"


def test_identifiers_have_all_their_digits(matrix: Worksheet, protocol: Protocol) -> None:
    texts = {matrix.cell(row, 2).value for row in range(2, matrix.max_row + 1)}
    assert texts == {f"0x{message.frame_id:08X}" for message in protocol.messages}


def test_factors_stand_in_the_xml_as_short_decimals(data: bytes) -> None:
    sheets = [text.decode() for entry, text in parts(data) if "worksheets" in entry.filename]
    numbers = re.findall(r"<v>([^<]*)</v>", "".join(sheets))
    assert "0.1" in numbers
    assert "0.001" in numbers
    assert not [number for number in numbers if "e" in number.lower() or len(number) > 10]


def test_senders_and_receivers_are_marked(matrix: Worksheet, protocol: Protocol) -> None:
    for message, each in protocol.signals():
        row = row_of(matrix, each.name)
        for node in protocol.nodes:
            wanted = {message.sender: "S", **dict.fromkeys(each.receivers, "R")}.get(node.name)
            assert matrix.cell(row, column(matrix, node.name)).value == wanted


def test_message_rows_look_different_from_signal_rows(matrix: Worksheet) -> None:
    names = column(matrix, "Signal Name")
    fills: dict[bool, set[str]] = {True: set(), False: set()}
    for row in range(2, matrix.max_row + 1):
        cell = matrix.cell(row, names)
        fills[cell.value is None].add(str(cell.fill.fgColor.rgb))
    assert len(fills[True]) == len(fills[False]) == 1
    assert fills[True] != fills[False]


def test_value_descriptions_have_a_code_a_line(matrix: Worksheet, protocol: Protocol) -> None:
    codes = column(matrix, "Signal Value Description")
    for _, each in protocol.signals():
        text = matrix.cell(row_of(matrix, each.name), codes).value
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


def test_sheet_names_are_what_excel_takes() -> None:
    names = (
        "A" * 40,
        "A" * 39 + "B",
        "a" * 40,
        "History",
        "x[1]:*?/\\y",
        "'quoted'",
        "矩阵 Matrix",
    )
    messages = tuple(
        Message(name=name, frame_id=number, length=1, sender="")
        for number, name in enumerate(names)
    )
    book = openpyxl.load_workbook(io.BytesIO(emit_matrix(Protocol(name="odd", messages=messages))))
    titles = book.sheetnames
    assert len({title.lower() for title in titles}) == len(titles) == 4 + len(names)
    for title in titles:
        assert 1 <= len(title) <= 31
        assert not set(title) & set("[]:*?/\\")
        assert title.lower() != "history"
        assert title.strip("'") == title


def test_a_protocol_with_very_many_messages_gets_no_bit_sheets() -> None:
    messages = tuple(
        Message(name=f"M{number}", frame_id=number, length=8, sender="") for number in range(300)
    )
    data = emit_matrix(Protocol(name="many", messages=messages))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert sum("worksheets/sheet" in name for name in archive.namelist()) == 4


@pytest.mark.parametrize("text", _RISKY)
def test_text_never_becomes_a_formula(text: str) -> None:
    one = signal("One", 0, 8, title=text, unit=text, reference=text)
    message = Message(
        name="M", frame_id=1, length=8, sender="ECU", title=text, english=text, signals=(one,)
    )
    data = emit_matrix(Protocol(name=text, title=text, english=text, messages=(message,)))
    for _, xml in parts(data):
        assert b"<f" not in re.sub(rb"<f(onts?|ills?|ill)\b", b"", xml) or b"<sheetData" not in xml
    book = openpyxl.load_workbook(io.BytesIO(data))
    cells = [
        cell
        for sheet in book.worksheets
        for row in sheet.iter_rows()
        for cell in row
        if isinstance(cell.value, str) and cell.value.strip() and text.strip() in cell.value
    ]
    assert len(cells) >= 5
    assert {cell.data_type for cell in cells} == {"s"}
    alone = [cell for cell in cells if cell.value == text]
    assert text[0] == "#" or all(cell.quotePrefix for cell in alone)


def test_no_sheet_of_ours_has_a_formula_or_a_date(data: bytes) -> None:
    for entry, text in parts(data):
        if entry.filename.startswith("xl/worksheets/"):
            tags = {element.tag.rpartition("}")[2] for element in ET.fromstring(text).iter()}
            assert "f" not in tags
            types = {
                each.get("t") for each in ET.fromstring(text).iter() if each.tag.endswith("}c")
            }
            assert types <= {None, "n", "inlineStr", "s"}


def test_no_date_host_or_tool_stands_in_the_file(data: bytes) -> None:
    words = [
        str(date.today().year),
        "openpyxl",
        version("openpyxl"),
        platform.node(),
        "dcterms",
    ]
    for entry, text in parts(data):
        assert entry.date_time == (1980, 1, 1, 0, 0, 0)
        if entry.filename.startswith(("docProps/", "xl/workbook", "[Content")):
            for word in words:
                assert word not in text.decode()


def test_every_part_is_well_formed_and_the_zip_is_sound(data: bytes) -> None:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        assert archive.namelist()[0] == "[Content_Types].xml"
    for _, text in parts(data):
        ET.fromstring(text)


_CHILD = """
import datetime, sys, time
seconds = float(sys.argv[1])
time.time = lambda: seconds
time.localtime = lambda *_: time.gmtime(seconds)
class Late(datetime.datetime):
    @classmethod
    def now(cls, tz=None):
        return datetime.datetime.fromtimestamp(seconds, tz)
datetime.datetime = Late
from emit.other_protocol import OTHER
from dbcspec.emit.matrix import emit_matrix
sys.stdout.buffer.write(emit_matrix(OTHER))
"""


@pytest.mark.parametrize(("seed", "seconds"), [("1", "1e9"), ("77", "1.7e9")])
def test_the_same_spec_gives_the_same_bytes_in_every_process_at_any_time(
    seed: str, seconds: str, root: Path
) -> None:
    folders = [root / "generator", root / "tests"]
    environment = {
        **os.environ,
        "PYTHONHASHSEED": seed,
        "PYTHONPATH": os.pathsep.join(map(str, folders)),
    }
    made = subprocess.run(
        [sys.executable, "-c", _CHILD, seconds], capture_output=True, check=True, env=environment
    )
    assert made.stdout == emit_matrix(OTHER)
