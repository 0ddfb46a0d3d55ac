"""Whether a file is an Excel workbook that can be opened without harm; looked at before it is."""

from __future__ import annotations

import io
import posixpath
import xml.etree.ElementTree as ET
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from openpyxl.utils.cell import column_index_from_string

from typedcan.model.errors import ReadError

LARGEST_FILE = 32 * 2**20
"""Bytes that the file may have, packed."""

LARGEST_UNPACKED = 128 * 2**20
"""Bytes that all its parts may have together, unpacked."""

MOST_PARTS = 4_000
MOST_ROWS = 100_000
"""The highest row that a sheet may use."""

MOST_CELLS = 2_000_000
"""Cells that all sheets may have together, empty ones to the left of filled ones counted."""

_HIGHEST_RATIO = 400
_SMALL_PART = 2**20
_CHUNK = 2**16
_OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_ENCRYPTED = "EncryptedPackage".encode("utf-16-le")
_ENCRYPTED_PART = 1  # of the flag bits of a part of a zip file
_SHEETS = "xl/worksheets/"
_RELATION = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"


@dataclass(frozen=True, slots=True)
class Checked:
    """A workbook found sound: its bytes, and the merged ranges of each sheet by its name."""

    data: bytes
    merged: Mapping[str, tuple[str, ...]]


def check_workbook(path: Path, name: str) -> Checked:
    """Read and check a file; raises `ReadError` in one line that calls it ``name``."""
    data = _bytes(path, name)
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return Checked(data, _Archive(archive, name).check())
    except (zipfile.BadZipFile, EOFError, zlib.error, NotImplementedError, RuntimeError):
        raise ReadError(f"{name}: is damaged or cut off; save it again as .xlsx") from None


def _bytes(path: Path, name: str) -> bytes:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ReadError(f"{name}: is larger than {LARGEST_FILE >> 20} MiB, too large a matrix")
        data = path.read_bytes()
    except OSError as error:
        raise ReadError(f"{name}: cannot be read: {error.strerror}") from None
    except ValueError:
        raise ReadError(f"{name!r}: is no name of a file") from None
    if data.startswith(_OLE):
        if _ENCRYPTED in data:
            raise ReadError(f"{name}: is protected by a password; save it without one")
        raise ReadError(f"{name}: is an old .xls file; save it as .xlsx (Excel workbook)")
    if not data:
        raise ReadError(f"{name}: is empty")
    if not data.startswith(b"PK"):
        raise ReadError(f"{name}: is not an Excel workbook (.xlsx)")
    return data


class _Archive:
    """Goes through every part of a zip file once, and unpacks none further than allowed."""

    def __init__(self, archive: zipfile.ZipFile, name: str) -> None:
        self._archive = archive
        self._name = name
        self._left = LARGEST_UNPACKED
        self._cells = 0

    def check(self) -> dict[str, tuple[str, ...]]:
        """The merged ranges of each sheet; raises `ReadError` for what must not be opened."""
        parts = self._archive.infolist()
        names = {part.filename for part in parts}
        if any(part.flag_bits & _ENCRYPTED_PART for part in parts):
            raise ReadError(f"{self._name}: is protected by a password; save it without one")
        if len(parts) > MOST_PARTS or len(names) < len(parts):
            raise ReadError(f"{self._name}: has too many parts, or one twice: no sound workbook")
        if any(name.lower().endswith("vbaproject.bin") for name in names):
            raise ReadError(f"{self._name}: has macros; save it as .xlsx, without them")
        if "xl/workbook.xml" not in names or "[Content_Types].xml" not in names:
            raise ReadError(f"{self._name}: is a zip file, but no Excel workbook (.xlsx)")
        if sum(part.file_size for part in parts) > LARGEST_UNPACKED:
            raise self._too_large()
        scans = {part.filename: self._scan(part) for part in parts}
        return {
            title: tuple(scans[target].merged)
            for title, target in self._sheet_parts(names).items()
            if target in scans
        }

    def _too_large(self) -> ReadError:
        limit = LARGEST_UNPACKED >> 20
        return ReadError(f"{self._name}: unpacks to more than {limit} MiB, too large a matrix")

    def _scan(self, part: zipfile.ZipInfo) -> _Scan:
        """Unpack a part bit by bit: what it says of its size may be a lie."""
        is_sheet = part.filename.startswith(_SHEETS)
        is_xml = part.filename.endswith((".xml", ".rels", ".vml"))
        scan = _Scan(self._name, part.filename, counting=is_sheet)
        size = 0
        with self._archive.open(part) as stream:
            while chunk := stream.read(_CHUNK):
                size += len(chunk)
                self._left -= len(chunk)
                if self._left < 0:
                    raise self._too_large()
                if size > _SMALL_PART and size > _HIGHEST_RATIO * max(part.compress_size, 1):
                    raise ReadError(
                        f"{self._name}: {part.filename} unpacks to over {_HIGHEST_RATIO} times "
                        f"its size: no sound workbook"
                    )
                if is_xml:
                    scan.feed(chunk)
        if is_xml:
            scan.feed(b"", last=True)
        self._cells += scan.cells
        if self._cells > MOST_CELLS:
            raise ReadError(f"{self._name}: has more than {MOST_CELLS} cells, too many")
        return scan

    def _sheet_parts(self, names: set[str]) -> dict[str, str]:
        """The part of each sheet."""
        relations = "xl/_rels/workbook.xml.rels"
        if relations not in names:
            return {}
        targets = {
            each.get("Id", ""): posixpath.normpath(posixpath.join("/xl", each.get("Target", "")))
            for each in ET.fromstring(self._archive.read(relations))
        }
        return {
            each.get("name", ""): targets.get(each.get(_RELATION, ""), "").lstrip("/")
            for each in ET.fromstring(self._archive.read("xl/workbook.xml")).iter()
            if each.tag.endswith("}sheet")
        }


@dataclass(slots=True)
class _Scan:
    """Counts the cells of a sheet and refuses XML that declares entities."""

    file: str
    part: str
    counting: bool
    cells: int = 0
    merged: list[str] = field(default_factory=list[str])
    _parser: expat.XMLParserType = field(default_factory=lambda: expat.ParserCreate("utf-8"))
    _column: int = 0

    def __post_init__(self) -> None:
        self._parser.StartDoctypeDeclHandler = self._doctype
        if self.counting:
            self._parser.StartElementHandler = self._element

    def feed(self, data: bytes, *, last: bool = False) -> None:
        try:
            self._parser.Parse(data, last)
        except expat.ExpatError as error:
            text = f"{self.file}: {self.part} is damaged: {expat.ErrorString(error.code)}"
            raise ReadError(f"{text}; save the workbook again") from None

    def _doctype(self, *_: object) -> None:
        raise ReadError(f"{self.file}: {self.part} declares XML entities: no sound workbook")

    def _element(self, tag: str, attributes: dict[str, str]) -> None:
        tag = tag.rpartition(":")[2]
        if tag == "c":
            self._cell(attributes.get("r", ""))
        elif tag == "row":
            self._column = 0
            row = attributes.get("r", "1")
            if not row.isdecimal() or int(row) > MOST_ROWS:
                text = f"{self.file}: {self.part} has something in row {row}; a matrix has at most"
                raise ReadError(f"{text} {MOST_ROWS} rows: delete what stands below it")
        elif tag == "mergeCell":
            self.merged.append(attributes.get("ref", ""))

    def _cell(self, reference: str) -> None:
        letters = reference.rstrip("0123456789")
        column = self._column + 1
        if letters:
            try:
                column = column_index_from_string(letters)
            except ValueError:
                raise ReadError(f"{self.file}: {self.part} has a cell {reference!r}") from None
        self.cells += max(1, column - self._column)
        self._column = column
        if self.cells > MOST_CELLS:
            raise ReadError(f"{self.file}: has more than {MOST_CELLS} cells, too many")
