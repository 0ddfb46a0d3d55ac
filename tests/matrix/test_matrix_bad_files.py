"""Files that are no matrix, and files that mean harm: one clear line for each."""

from __future__ import annotations

import errno
import os
import struct
import time
import zipfile
from pathlib import Path

import openpyxl
import pytest
from emit.other_protocol import OTHER
from matrix.workbooks import HEADINGS, SPEED, repacked, save, small

from dbcspec.matrix.read import read_matrix
from dbcspec.matrix.write import emit_matrix
from typedcan.model.errors import ReadError

_OLE = bytes.fromhex("d0cf11e0a1b11ae1")
_SHEET = "xl/worksheets/sheet1.xml"


@pytest.fixture(scope="module")
def data() -> bytes:
    return emit_matrix(OTHER)


def refusal(path: Path) -> str:
    """The one line with which a file is refused."""
    with pytest.raises(ReadError) as caught:
        read_matrix(path)
    text = str(caught.value)
    assert "\n" not in text
    assert str(path) in text
    return text


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    text = refusal(tmp_path / "gone.xlsx")
    assert text.endswith(f"cannot be read: {os.strerror(errno.ENOENT)}")


def test_a_folder(tmp_path: Path) -> None:
    assert "cannot be read" in refusal(tmp_path)


@pytest.mark.parametrize(
    ("content", "word"),
    [
        (b"", "is empty"),
        (b"Msg Name,Msg ID\n", "is not an Excel workbook"),
        (b"PK\x03\x04 and then nothing of the kind", "is damaged or cut off"),
        (_OLE + b"\0" * 512, "old .xls file"),
        (_OLE + b"\0" * 512 + "EncryptedPackage".encode("utf-16-le"), "protected by a password"),
    ],
    ids=["empty", "text", "half a zip", "xls", "password"],
)
def test_what_is_no_workbook(content: bytes, word: str, tmp_path: Path) -> None:
    path = tmp_path / "m.xlsx"
    path.write_bytes(content)
    assert word in refusal(path)


@pytest.mark.parametrize("part", [0.05, 0.3, 0.6, 0.9, 0.999])
def test_a_file_that_is_cut_off(part: float, data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "m.xlsx"
    path.write_bytes(data[: int(len(data) * part)])
    assert "is damaged or cut off" in refusal(path)


def test_a_flipped_byte_is_noticed(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "m.xlsx"
    at = data.index(b"<sheetData>") + 200
    path.write_bytes(data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :])
    assert "is damaged" in refusal(path)


def test_a_zip_that_is_no_workbook(tmp_path: Path) -> None:
    path = tmp_path / "m.xlsx"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("readme.txt", "hello")
    assert "no Excel workbook" in refusal(path)


@pytest.mark.parametrize("name", ["xl/vbaProject.bin", "xl/VBAPROJECT.BIN"])
def test_a_workbook_with_macros(name: str, data: bytes, tmp_path: Path) -> None:
    assert "has macros" in refusal(repacked(data, tmp_path / "m.xlsm", {name: b"Sub Boo()"}))


def test_a_part_that_unpacks_to_far_more_than_it_takes(data: bytes, tmp_path: Path) -> None:
    bomb = b"<worksheet>" + b" " * (20 * 2**20) + b"</worksheet>"
    path = repacked(data, tmp_path / "m.xlsx", {_SHEET: bomb})
    assert path.stat().st_size < 200_000
    assert "times its size" in refusal(path)


def test_a_workbook_that_unpacks_to_too_much(data: bytes, tmp_path: Path) -> None:
    parts = {f"xl/media/{number}.bin": b"\0" * (40 * 2**20) for number in range(4)}
    assert "MiB" in refusal(repacked(data, tmp_path / "m.xlsx", parts))


def test_a_directory_that_lies_about_sizes(data: bytes, tmp_path: Path) -> None:
    path = repacked(data, tmp_path / "m.xlsx", {"xl/zzz.bin": b"\0" * (30 * 2**20)})
    raw = bytearray(path.read_bytes())
    size = struct.pack("<I", 30 * 2**20)
    at = raw.rindex(size)  # in the central directory, which readers believe
    raw[at : at + 4] = struct.pack("<I", 10)
    path.write_bytes(raw)
    started = time.monotonic()
    refusal(path)
    assert time.monotonic() - started < 5


def test_a_part_that_stands_in_the_zip_twice(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "m.xlsx"
    path.write_bytes(data)
    with zipfile.ZipFile(path, "a") as archive, pytest.warns(UserWarning, match="workbook"):
        archive.writestr("xl/workbook.xml", b"<workbook/>")
    assert "one twice" in refusal(path)


def test_a_part_with_a_password(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "m.xlsx"
    flags = data.rindex(b"PK\x01\x02") + 8  # of the last part, in the central directory
    path.write_bytes(data[:flags] + bytes([data[flags] | 1]) + data[flags + 1 :])
    assert "is protected by a password" in refusal(path)


def test_xml_that_declares_entities(data: bytes, tmp_path: Path) -> None:
    def reference(number: int) -> str:
        return f"&l{number};"

    laughs = "".join(f'<!ENTITY l{n} "{10 * reference(n - 1)}">' for n in range(1, 10))
    text = f'<!DOCTYPE x [<!ENTITY l0 "ha">{laughs}]><worksheet>&l9;</worksheet>'
    path = repacked(data, tmp_path / "m.xlsx", {_SHEET: text.encode()})
    assert "declares XML entities" in refusal(path)


def test_xml_in_another_encoding_cannot_hide_entities(data: bytes, tmp_path: Path) -> None:
    text = '<?xml version="1.0" encoding="UTF-16"?><!DOCTYPE x [<!ENTITY a "b">]><x>&a;</x>'
    path = repacked(data, tmp_path / "m.xlsx", {_SHEET: text.encode("utf-16")})
    assert _SHEET in refusal(path)


@pytest.mark.parametrize("text", [b"", b"<worksheet>", b"<a></b>", b"\xff\xff"])
def test_a_part_that_is_no_xml(text: bytes, data: bytes, tmp_path: Path) -> None:
    path = repacked(data, tmp_path / "m.xlsx", {_SHEET: text})
    assert f"{_SHEET} is damaged" in refusal(path)


@pytest.mark.parametrize("name", ["xl/workbook.xml", "xl/_rels/workbook.xml.rels"])
def test_xml_that_is_something_else(name: str, data: bytes, tmp_path: Path) -> None:
    refusal(repacked(data, tmp_path / "m.xlsx", {name: b"<something><else/></something>"}))


def test_a_cell_in_the_last_row_of_excel(tmp_path: Path) -> None:
    path = small(tmp_path / "m.xlsx")
    book = openpyxl.load_workbook(path)
    book["CAN"].cell(1_048_576, 1).value = "x"
    book.save(path)
    assert "row 1048576" in refusal(path)


def test_more_cells_than_any_matrix_has(data: bytes, tmp_path: Path) -> None:
    cells = (f'<row r="{n}"><c r="XFD{n}" t="n"><v>{n}</v></c></row>' for n in range(1, 200))
    text = f"<worksheet><sheetData>{''.join(cells)}</sheetData></worksheet>"
    path = repacked(data, tmp_path / "m.xlsx", {_SHEET: text.encode()})
    assert "cells" in refusal(path)


def test_a_workbook_without_a_matrix_names_what_is_missing(tmp_path: Path) -> None:
    path = save(tmp_path / "m.xlsx", [["Msg Name", "Msg ID", "Signal Name", "Bit Length"]])
    text = refusal(path)
    assert "CAN" in text
    assert "起始位 (start bit)" in text


def test_a_workbook_of_something_else(tmp_path: Path) -> None:
    assert "no CAN matrix" in refusal(save(tmp_path / "m.xlsx", [["Date", "Price"], [1, 2]]))


def test_headings_without_rows(tmp_path: Path) -> None:
    assert "has no message" in refusal(save(tmp_path / "m.xlsx", [list(HEADINGS)]))


def test_two_matrices_in_one_workbook(tmp_path: Path) -> None:
    path = save(tmp_path / "m.xlsx", [list(HEADINGS), list(SPEED)])
    book = openpyxl.load_workbook(path)
    book.copy_worksheet(book["CAN"]).title = "CAN old"
    book.save(path)
    assert "CAN, CAN old" in refusal(path)


def test_another_name_is_used_in_messages(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"^HEAD:m\.xlsx: "):
        read_matrix(tmp_path / "m.xlsx", shown_as="HEAD:m.xlsx")
