"""BLF logs built by hand, for what python-can's writer never writes.

The numbers are those of the format: sizes, places and codes of its headers and objects.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable

HEADER_SIZE = 144
TEN_MICROSECONDS, NANOSECOND = 1, 2
CAN_MESSAGE, CAN_MESSAGE2, CAN_ERROR_EXT, CAN_FD_MESSAGE, CAN_FD_MESSAGE_64 = 1, 86, 73, 100, 101


def blf_file(
    stream: bytes,
    *,
    container_size: int = 1000,
    stored: bool = False,
    between: bytes = b"",
    size: int | None = None,
) -> bytes:
    """A log whose containers hold this stream of objects, begun on 14 November 2023, 22:13:20.5.

    ``between`` stands between the containers, ``size`` in the header.
    """
    parts = (stream[at : at + container_size] for at in range(0, len(stream), container_size))
    body = between.join(container(part, stored=stored) for part in parts)
    start = (2023, 11, 2, 14, 22, 13, 20, 500)
    size = HEADER_SIZE + len(body) if size is None else size
    header = struct.pack("<4sL8B", b"LOGG", HEADER_SIZE, 5, 0, 0, 0, 2, 6, 8, 1)
    header += struct.pack("<QQLL8H8H", size, 0, 0, 0, *start, *start)
    return header.ljust(HEADER_SIZE, b"\0") + body


def container(data: bytes, *, stored: bool = False, stated: int | None = None) -> bytes:
    """A container with this content; ``stated`` is the inflated size that it claims."""
    stated = len(data) if stated is None else stated
    held = data if stored else zlib.compress(data)
    size = 32 + len(held)
    base = struct.pack("<4sHHLL", b"LOBJ", 16, 1, size, 10)
    return base + struct.pack("<H6xL4x", 0 if stored else 2, stated) + held + bytes(size % 4)


def blf_object(
    kind: int,
    body: bytes,
    time: int,
    *,
    unit: int = NANOSECOND,
    version: int = 1,
    size: int | None = None,
) -> bytes:
    """An object with its header and padding; ``size`` is what it claims to have."""
    header = struct.pack("<LHHQ", unit, 0, 0, time) + bytes(8 if version == 2 else 0)
    actual = 16 + len(header) + len(body)
    size = actual if size is None else size
    base = struct.pack("<4sHHLL", b"LOBJ", 16 + len(header), version, size, kind)
    return base + header + body + bytes(actual % 4)


def classic(
    frame_id: int, data: bytes, *, channel: int = 1, flags: int = 0, dlc: int | None = None
) -> bytes:
    """The body of a CAN_MESSAGE; flag 0x80 is a remote frame, 0x01 a sent one."""
    dlc = len(data) if dlc is None else dlc
    return struct.pack("<HBBL8s", channel, flags, dlc, frame_id, data)


def fd_64(
    frame_id: int,
    data: bytes,
    *,
    dlc: int,
    valid: int | None = None,
    flags: int = 0x1000,
    direction: int = 0,
    extra: bytes = b"",
) -> bytes:
    """The body of a CAN_FD_MESSAGE_64, its optional extra data behind the payload."""
    valid = len(data) if valid is None else valid
    offset = 32 + 40 + len(data) if extra else 0
    head = struct.pack("<BBBBLL", 2, dlc, valid, 0, frame_id, 0)
    rest = struct.pack("<LLLLLHBBL", flags, 0, 0, 0, 0, 0, direction, offset, 0)
    return head + rest + data + extra


def joined(objects: Iterable[bytes]) -> bytes:
    """The stream of these objects."""
    return b"".join(objects)
