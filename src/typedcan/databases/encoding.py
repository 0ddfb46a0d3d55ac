"""Files of unknown encoding to text; what could be read in two ways is refused, not guessed.

DBC files do not say how they are encoded. In order: a byte order mark, ASCII, UTF-8, and then
GBK or cp1252, whichever the bytes look like. Nearly every byte sequence decodes as both, so these
two are told apart by how their bytes stand: Chinese characters are pairs of high bytes, mostly
of the 3,755 common ones; Western letters and signs such as ä or ° stand alone among ASCII.
"""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from typedcan.model.errors import Location, ReadError

LARGEST_FILE = 16 * 2**20
"""Bytes that a file may have unless the caller says otherwise; cantools reads 1 MB in seconds."""

_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_HIGH_BYTES = re.compile(rb"[\x80-\xff]+")
_LONGEST_WESTERN_RUN = 3
_MANY, _FEW, _MOST, _HALF = 0.75, 0.25, 0.9, 0.5


def read_text(
    path: Path,
    encoding: str | None = None,
    *,
    shown_as: str | None = None,
    largest: int = LARGEST_FILE,
) -> str:
    """The text of a file with Unix line ends.

    ``shown_as`` is what errors call the file, ``largest`` the bytes that it may have. Raises
    `ReadError` for what is no readable text file, or where the encoding cannot be told.
    """
    name = shown_as or str(path)
    text = decode(_read(path, name, largest), name, encoding)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_encoded(path: Path, encoding: str | None = None) -> tuple[bytes, str]:
    """The bytes of a text file and their encoding; raises `ReadError` as `read_text`."""
    data = _read(path, str(path), LARGEST_FILE)
    decode(data, str(path), encoding)
    return data, encoding or find_encoding(data) or "utf-8"


def decode(data: bytes, name: str, encoding: str | None = None) -> str:
    """The bytes of the file called ``name`` as text; see `read_text`."""
    chosen = encoding or find_encoding(data)
    if chosen is None:
        raise ReadError(
            f"{name}: the encoding cannot be told for sure: give it, such as gbk, cp1252 or utf-8"
        )
    try:
        return data.decode(chosen)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        where = Location(name, line)
        raise ReadError(f"{where}: not {chosen}: byte 0x{data[error.start]:02X}") from None
    except (LookupError, ValueError):
        raise ReadError(f"{name}: there is no text encoding {chosen!r}") from None


def find_encoding(data: bytes) -> str | None:
    """The name of the encoding, or None where it cannot be told for sure."""
    for mark, encoding in _BYTE_ORDER_MARKS:
        if data.startswith(mark):
            return encoding
    for encoding in ("ascii", "utf-8"):
        if _decodes(data, encoding):
            return encoding
    runs = _HIGH_BYTES.findall(data)
    alone = sum(len(run) == 1 for run in runs) / len(runs)
    chinese = _share_of_common_characters(data)
    if chinese >= _MOST and alone <= _FEW:
        return "gb18030"
    short = max(map(len, runs)) <= _LONGEST_WESTERN_RUN
    western = short and (alone >= _MANY or chinese < _HALF)
    return "cp1252" if western and _decodes(data, "cp1252") else None


def _share_of_common_characters(data: bytes) -> float:
    """How many of the characters beyond ASCII, read as GBK, are signs or common Chinese."""
    try:
        text = data.decode("gb18030")
    except UnicodeDecodeError:
        return 0
    characters = [each for each in text if not each.isascii()]
    return sum(map(_is_common, characters)) / len(characters)


def _is_common(character: str) -> bool:
    """Whether GB 2312 has it among its signs (rows 1 to 9) or common characters (16 to 55)."""
    try:
        code = character.encode("gb2312")
    except UnicodeEncodeError:
        return False
    return 0xA1 <= code[0] <= 0xA9 or 0xB0 <= code[0] <= 0xD7


def _decodes(data: bytes, encoding: str) -> bool:
    try:
        data.decode(encoding)
    except UnicodeDecodeError:
        return False
    return True


def _read(path: Path, name: str, largest: int) -> bytes:
    try:
        if not path.exists():
            raise ReadError(f"{name}: there is no such file")
        if not path.is_file():
            raise ReadError(f"{name}: is not a file")
        with path.open("rb") as file:
            data = file.read(largest + 1)
    except OSError as error:
        raise ReadError(f"{name}: cannot be read: {error.strerror}") from None
    except ValueError:
        raise ReadError(f"{name!r}: is no path") from None
    if len(data) > largest:
        raise ReadError(f"{name}: is larger than {largest // 2**20} MB")
    if not data.strip():
        raise ReadError(f"{name}: the file is empty")
    if b"\0" in data and not data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        raise ReadError(f"{name}: is not a text file")
    return data
