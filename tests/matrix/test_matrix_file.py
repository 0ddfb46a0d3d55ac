"""The workbook as a file: sheet names, formulas, bytes."""

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
from importlib.metadata import version
from pathlib import Path

import openpyxl
import pytest
from emit.other_protocol import OTHER, signal

from dbcspec.matrix.write import emit_matrix
from typedcan.model.protocol import Message, Protocol

_RISKY = ("=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "=cmd|' /C calc'!A0", "#N/A")


def parts(data: bytes) -> Iterator[tuple[zipfile.ZipInfo, bytes]]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        for entry in archive.infolist():
            yield entry, archive.read(entry)


def test_factors_stand_in_the_xml_as_short_decimals(project_matrix: bytes) -> None:
    sheets = [
        text.decode() for entry, text in parts(project_matrix) if "worksheets" in entry.filename
    ]
    numbers = re.findall(r"<v>([^<]*)</v>", "".join(sheets))
    assert "0.1" in numbers
    assert "0.001" in numbers
    assert not [number for number in numbers if "e" in number.lower() or len(number) > 10]


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


def test_no_sheet_of_ours_has_a_formula_or_a_date(project_matrix: bytes) -> None:
    for entry, text in parts(project_matrix):
        if entry.filename.startswith("xl/worksheets/"):
            tags = {element.tag.rpartition("}")[2] for element in ET.fromstring(text).iter()}
            assert "f" not in tags
            types = {
                each.get("t") for each in ET.fromstring(text).iter() if each.tag.endswith("}c")
            }
            assert types <= {None, "n", "inlineStr", "s"}


def test_no_date_host_or_tool_stands_in_the_file(project_matrix: bytes) -> None:
    words = [
        str(date.today().year),
        "openpyxl",
        version("openpyxl"),
        platform.node(),
        "dcterms",
    ]
    for entry, text in parts(project_matrix):
        assert entry.date_time == (1980, 1, 1, 0, 0, 0)
        if entry.filename.startswith(("docProps/", "xl/workbook", "[Content")):
            for word in words:
                assert word not in text.decode()


def test_every_part_is_well_formed_and_the_zip_is_sound(project_matrix: bytes) -> None:
    with zipfile.ZipFile(io.BytesIO(project_matrix)) as archive:
        assert archive.testzip() is None
        assert archive.namelist()[0] == "[Content_Types].xml"
    for _, text in parts(project_matrix):
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
from dbcspec.matrix.write import emit_matrix
sys.stdout.buffer.write(emit_matrix(OTHER))
"""


@pytest.mark.parametrize(("seed", "seconds"), [("1", "1e9"), ("77", "1.7e9")])
def test_the_same_spec_gives_the_same_bytes_in_every_process_at_any_time(
    seed: str, seconds: str, root: Path
) -> None:
    folders = [root / "src", root / "generator", root / "tests"]
    environment = {
        **os.environ,
        "PYTHONHASHSEED": seed,
        "PYTHONPATH": os.pathsep.join(map(str, folders)),
    }
    made = subprocess.run(
        [sys.executable, "-c", _CHILD, seconds], capture_output=True, check=True, env=environment
    )
    assert made.stdout == emit_matrix(OTHER)
