"""What kind of log a file is, by what stands at its begin."""

from __future__ import annotations

import re
import zlib
from pathlib import Path

from typedcan.logs.read.lines import as_utf_8

GZIP = b"\x1f\x8b"
_HEAD = 65_536
_LINES = 200

_BINARY = (
    (b"LOGG", "blf"),
    (b"MDF     4", "mf4"),
    (b"UnFinMF 4", "mf4"),
    (b"SQLite format 3\0", "other"),
    (b"\x0a\x0d\x0d\x0a", "pcapng"),
    (b"\xa1\xb2\xc3\xd4", "pcap"),
    (b"\xd4\xc3\xb2\xa1", "pcap"),
    (b"\xa1\xb2\x3c\x4d", "pcap"),
    (b"\x4d\x3c\xb2\xa1", "pcap"),
)

_FOREIGN = (
    (b"MDF     3", "an MDF 3 file", "save it as MF4 (with asammdf: File, Convert to 4.10)"),
    (b"MDF     2", "an MDF 2 file", "save it as MF4 (with asammdf: File, Convert to 4.10)"),
    (b"UnFinMF", "an unfinished MDF 3 file", "finish it, then save it as MF4"),
    (b"PK\x03\x04", "a ZIP archive or a workbook", "unpack it; from Excel, save the log as CSV"),
    (b"\xd0\xcf\x11\xe0", "an old Office document", "save the log as CSV"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive", "unpack it"),
    (b"Rar!", "a RAR archive", "unpack it"),
    (b"BZh", "a bzip2 archive", "unpack it"),
    (b"\xfd7zXZ\0", "an xz archive", "unpack it"),
    (b"\x28\xb5\x2f\xfd", "a zstd archive", "unpack it"),
    (b"%PDF", "a PDF document", "export the log itself"),
    (b"PAR1", "a Parquet table", "it is no log: convert the log that it was made of"),
)

_FOREIGN_TEXT = (
    (
        rb"^//-+\s+Microchip",
        "a log of Microchip's CAN BUS Analyzer",
        "export it as GVRET CSV with SavvyCAN",
    ),
    (rb"^@ TEXT @", "a log of CarBus Analyzer", "export it as GVRET CSV with SavvyCAN"),
    (rb'^\s*(?:VERSION\s+"|NS_\s*:|BU_\s*:|BO_ \d)', "a DBC database", "name it with --dbc"),
    (rb"^\s*(?:<\?xml|<[A-Za-z!])", "an XML file", "export the log as ASC, BLF or MF4"),
    (rb"^\s*[{\[]\s*[\"{\[]", "a JSON file", "export the log as ASC, BLF or MF4"),
    (
        rb"^date,?\s*time.*\bKvaser\b|^\s*Chn\s+Identifier\s+Flg",
        "a log of Kvaser's CanKing",
        "save it as ASC or BLF with Kvaser's converter",
    ),
    (rb"^;\s*CAN-Bus Trace|^\[ixxat|IXXAT", "a log of IXXAT's tools", "export it as ASC"),
    (
        rb"(?m)^[tTrRdDbB][\dA-Fa-f]{4,}\r?$",
        "a log in the format of SLCAN",
        "turn it into a candump log with can-utils' slcanpty and candump -l",
    ),
    (
        rb"^\d+\.\d+ (?:R|T|C)\d*(?:11|29|XX|EV|VN|CV)? ",
        "a CRTD log",
        "export it as CSV with SavvyCAN",
    ),
    (
        rb"^(?:ID,Data Bytes)",
        "a CSV of identifiers without times",
        "export it as GVRET CSV with SavvyCAN",
    ),
)

_TEXT = (
    (
        "trc",
        re.compile(
            rb"^;\$(?:FILEVERSION|STARTTIME|COLUMNS)=|^;.*(?:PCAN|\bTRCWriter\b)|^\s*\d+\)\s+\d",
            re.IGNORECASE,
        ),
    ),
    (
        "busmaster",
        re.compile(
            rb"^-?\*{3}(?:BUSMASTER|PROTOCOL CAN|\[START LOG)|^\d+:\d\d?:\d\d?:\d{1,4} [RT]x \d",
            re.IGNORECASE,
        ),
    ),
    ("gvret", re.compile(rb"^\s*Time ?Stamp\s*,\s*ID\s*,\s*Extended\s*,", re.IGNORECASE)),
    (
        "csv",
        re.compile(
            rb"^timestamp,arbitration_id,|^\d+\.?\d*(?:e[+-]\d+)?,0x[\da-f]+,[01],[01],[01],",
            re.IGNORECASE,
        ),
    ),
    (
        "asc",
        re.compile(
            rb"^(?:date\s|base\s+(?:hex|dec)\b|begin\s+trigger\s?block|(?:no )?internal events)"
            rb"|^\s*-?\d+\.\d+\s+(?:\d+\s+(?:\S+\s+(?:rx|tx|txrq)\s|errorframe|statistic:|j1939tp)"
            rb"|canfd\s|start of measurement)",
            re.IGNORECASE,
        ),
    ),
    (
        "candump",
        re.compile(
            rb"^\s*\(\d+\.\d+\)\s+\S+\s+[\da-f]+#"
            rb"|^\s*(?:\([\d :.-]+\)\s+)?\S+\s+(?:[RT]X [B-] [E-]\s+)?"
            rb"(?:[\da-f]{3}|[\da-f]{8})\s+[\[{]\w{1,2}[\]}]",
            re.IGNORECASE,
        ),
    ),
)


class Head:
    """The begin of a file.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    OSError
        It cannot be read.
    """

    def __init__(self, path: Path) -> None:
        with path.open("rb") as file:
            raw = file.read(_HEAD)
        self.is_packed = raw.startswith(GZIP)
        self.bytes = _unpacked(raw) if self.is_packed else raw

    def kind(self) -> str:
        """The kind of log that it is: empty where nothing tells."""
        for begin, kind in _BINARY:
            if self.bytes.startswith(begin):
                return kind
        for line in self._text().splitlines()[:_LINES]:
            for kind, pattern in _TEXT:
                if pattern.search(line):
                    return kind
        return ""

    def foreign(self) -> str:
        """What else it is, and what to do about it: empty where nothing tells."""
        for begin, what, advice in _FOREIGN:
            if self.bytes.startswith(begin):
                return f"{what}, which is no log that is read here: {advice}"
        text = self._text()
        for pattern, what, advice in _FOREIGN_TEXT:
            if re.search(pattern, text[:4096]):
                return f"{what}, which is no log that is read here: {advice}"
        return ""

    def _text(self) -> bytes:
        return b"".join(as_utf_8(iter([self.bytes]))).replace(b"\r", b"\n")


def _unpacked(raw: bytes) -> bytes:
    try:
        return zlib.decompressobj(31).decompress(raw, _HEAD)
    except zlib.error:
        return b""
