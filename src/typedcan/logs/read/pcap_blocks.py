"""The packets of pcap and pcapng files."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

_SECTION, _INTERFACE, _SIMPLE, _ENHANCED, _OLD_PACKET = 0x0A0D0D0A, 1, 3, 6, 2
_LONGEST = 2**24
"""Bytes of a block at most: no frame needs a thousandth of it."""

_MOST_INTERFACES = 4096
_NAME, _RESOLUTION, _OFFSET, _FLAGS = 2, 9, 14, 2
_OUTBOUND = 2
_MICROSECONDS, _NANOSECONDS = 10**6, 10**9
_FIRST_YEARS = 2**40

_CLASSIC = {
    b"\xa1\xb2\xc3\xd4": (">", _MICROSECONDS),
    b"\xd4\xc3\xb2\xa1": ("<", _MICROSECONDS),
    b"\xa1\xb2\x3c\x4d": (">", _NANOSECONDS),
    b"\x4d\x3c\xb2\xa1": ("<", _NANOSECONDS),
}


class BrokenCapture(Exception):
    """A capture is damaged from byte ``at`` on; the text says how."""

    def __init__(self, at: int, problem: str) -> None:
        super().__init__(problem)
        self.at = at


@dataclass(frozen=True, slots=True)
class Interface:
    """A network that was captured.

    Parameters
    ----------
    link
        Its link type.
    name
        Its name, such as can0, if the file says it.
    units
        Units of time in a second.
    offset
        Seconds that are added to times.
    end
        So far the file is read.
    """

    link: int
    name: str | None
    units: int
    offset: int
    end: int


@dataclass(frozen=True, slots=True)
class Packet:
    """A packet that was captured, with its place in the file; the time is in seconds."""

    interface: Interface
    time: float
    data: bytes
    is_sent: bool
    at: int
    end: int

    @property
    def link(self) -> int:
        """The link type of its network."""
        return self.interface.link


def packets(file: BinaryIO) -> Iterator[Packet | Interface]:
    """The packets of a file, and its interfaces before them; raises `BrokenCapture`."""
    magic = file.read(4)
    file.seek(0)
    if magic in _CLASSIC:
        yield from _classic(file, *_CLASSIC[magic])
    else:
        yield from _blocks(file)


def _classic(file: BinaryIO, order: str, units: int) -> Iterator[Packet | Interface]:
    header = file.read(24)
    if len(header) < 24:
        raise BrokenCapture(0, "the header is cut off")
    link = struct.unpack_from(f"{order}I", header, 20)[0] & 0x0FFF_FFFF
    interface = Interface(link, None, units, 0, 24)
    yield interface
    record = struct.Struct(f"{order}IIII")
    at = 24
    while head := file.read(record.size):
        if len(head) < record.size:
            raise BrokenCapture(at, "the file ends within a packet")
        seconds, part, held, _ = record.unpack(head)
        if held > _LONGEST:
            raise BrokenCapture(at, f"a packet of {held:,} bytes")
        data = file.read(held)
        if len(data) < held:
            raise BrokenCapture(at, "the file ends within a packet")
        end = at + record.size + held
        yield Packet(interface, seconds + part / units, data, is_sent=False, at=at, end=end)
        at = end


def _blocks(file: BinaryIO) -> Iterator[Packet | Interface]:
    order, at = "<", 0
    interfaces: list[Interface] = []
    while head := file.read(12):
        if len(head) < 12:
            raise BrokenCapture(at, "the file ends within a block")
        if head[:4] == b"\x0a\x0d\x0d\x0a":
            order = ">" if head[8:] == b"\x1a\x2b\x3c\x4d" else "<"
            interfaces = []
        kind, length = struct.unpack_from(f"{order}II", head)
        if length < 12 or length % 4 or length > _LONGEST:
            raise BrokenCapture(at, f"a block of {length:,} bytes")
        body = head[8:] + file.read(length - 12)
        if len(body) < length - 8:
            raise BrokenCapture(at, "the file ends within a block")
        end = at + length
        if kind == _INTERFACE and length >= 20:
            if len(interfaces) == _MOST_INTERFACES:
                raise BrokenCapture(at, f"more than {_MOST_INTERFACES:,} interfaces")
            interfaces.append(_interface(body[:-4], order, end))
            yield interfaces[-1]
        elif kind in (_ENHANCED, _OLD_PACKET, _SIMPLE):
            yield _packet(kind, body[:-4], order, interfaces, (at, end))
        at = end


def _options(data: bytes, order: str) -> Iterator[tuple[int, bytes]]:
    place = 0
    while place + 4 <= len(data):
        code, length = struct.unpack_from(f"{order}HH", data, place)
        if not code:
            return
        yield code, data[place + 4 : place + 4 + length]
        place += 4 + (length + 3) // 4 * 4


def _interface(body: bytes, order: str, end: int) -> Interface:
    link = struct.unpack_from(f"{order}H", body)[0]
    name, units, offset = None, _MICROSECONDS, 0
    for code, value in _options(body[8:], order):
        if code == _NAME:
            text = value.rstrip(b"\0").decode(errors="replace")
            name = text if text.isprintable() and text else None
        elif code == _RESOLUTION and value:
            exponent = value[0] & 0x7F
            units = 2**exponent if value[0] & 0x80 else 10 ** min(exponent, 30)
        elif code == _OFFSET and len(value) == 8:
            offset = struct.unpack(f"{order}q", value)[0]
    return Interface(link, name, units, offset if abs(offset) < _FIRST_YEARS else 0, end)


def _packet(
    kind: int, body: bytes, order: str, interfaces: list[Interface], place: tuple[int, int]
) -> Packet:
    at, end = place
    try:
        if kind == _SIMPLE:
            return Packet(interfaces[0], 0.0, body[4:], is_sent=False, at=at, end=end)
        form = "IIII" if kind == _ENHANCED else "HHIII"
        head = struct.Struct(f"{order}{form}I")
        fields = head.unpack_from(body)
        high, low, held = fields[-4], fields[-3], fields[-2]
        interface = interfaces[fields[0]]
    except (IndexError, struct.error):
        raise BrokenCapture(at, "a packet of no interface") from None
    data = body[head.size : head.size + held]
    if len(data) < held:
        raise BrokenCapture(at, "a packet that is longer than its block")
    time = interface.offset + (high << 32 | low) / interface.units
    sent = False
    for code, value in _options(body[head.size + (held + 3) // 4 * 4 :], order):
        if code == _FLAGS and len(value) == 4:
            sent = struct.unpack(f"{order}I", value)[0] & 3 == _OUTBOUND
    return Packet(interface, time, data, sent, at, end)
