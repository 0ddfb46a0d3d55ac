"""Captures of SocketCAN, their bytes worked out by hand."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from logs.log_files import Row, rows_in

from typedcan.logs.frames import FrameFlag as Flag
from typedcan.logs.read import LogError, open_log
from typedcan.logs.read.source import Damage

CLASSIC = struct.pack(">IBBxx", 0x98FEF100, 3, 0) + b"\1\2\3"
REMOTE = struct.pack(">IBBxx", 0x40000123, 8, 0)
ERROR = struct.pack(">IBBxx", 0x20000088, 8, 0) + bytes(8)
FD = struct.pack(">IBBxx", 0x123, 12, 0x05) + bytes(range(12))
ROWS = [
    (0x18FEF100, Flag.EXTENDED, 3, b"\1\2\3"),
    (0x123, Flag.REMOTE, 8, b""),
    (0x88, Flag.ERROR, 8, bytes(8)),
    (0x123, Flag.FD | Flag.BIT_RATE_SWITCH, 12, bytes(range(12))),
]
PACKETS = [CLASSIC, REMOTE, ERROR, FD]


def block(kind: int, body: bytes, order: str) -> bytes:
    """A block of pcapng."""
    body += bytes(-len(body) % 4)
    size = struct.pack(f"{order}I", len(body) + 12)
    return struct.pack(f"{order}I", kind) + size + body + size


def option(code: int, value: bytes, order: str) -> bytes:
    """An option of a block of pcapng."""
    return struct.pack(f"{order}HH", code, len(value)) + value + bytes(-len(value) % 4)


def pcapng(packets: list[bytes], order: str = "<", link: int = 227, *, sent: bool = False) -> bytes:
    """A capture of an interface can0, times in nanoseconds, half a second apart from 1000 s on."""
    section = struct.pack(f"{order}IHHq", 0x1A2B3C4D, 1, 0, -1)
    options = option(2, b"can0", order) + option(9, b"\x09", order) + bytes(4)
    interface = struct.pack(f"{order}HHI", link, 0, 0) + options
    content = block(0x0A0D0D0A, section, order) + block(1, interface, order)
    for number, packet in enumerate(packets):
        time = 1000 * 10**9 + number * 5 * 10**8
        head = struct.pack(
            f"{order}IIIII", 0, time >> 32, time & 0xFFFFFFFF, len(packet), len(packet)
        )
        flags = option(2, struct.pack(f"{order}I", 2 if sent else 1), order) + bytes(4)
        content += block(6, head + packet + bytes(-len(packet) % 4) + flags, order)
    return content


def pcap(packets: list[bytes], order: str = "<", link: int = 227) -> bytes:
    """The same in the older format, which has no names, times in microseconds."""
    content = struct.pack(f"{order}IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, link)
    for number, packet in enumerate(packets):
        head = (1000 + number // 2, number % 2 * 500_000, len(packet), len(packet))
        content += struct.pack(f"{order}IIII", *head) + packet
    return content


def read(tmp_path: Path, content: bytes) -> tuple[list[Row], Damage | None]:
    """The frames, and the damage."""
    path = tmp_path / "bus.bin"
    path.write_bytes(content)
    with open_log(path, 3) as source:
        return rows_in(source), source.damage


def rows(channel: str | None, extra: int = 0) -> list[Row]:
    """What the packets are."""
    return [
        (1000 + number / 2, frame_id, flags | extra, channel, length, data)
        for number, (frame_id, flags, length, data) in enumerate(ROWS)
    ]


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("sent", [False, True])
def test_captures_of_wireshark_are_read(tmp_path: Path, order: str, *, sent: bool) -> None:
    found = read(tmp_path, pcapng(PACKETS, order, sent=sent))
    assert found == (rows("can0", Flag.SENT if sent else 0), None)


@pytest.mark.parametrize("order", ["<", ">"])
def test_captures_of_tcpdump_are_read(tmp_path: Path, order: str) -> None:
    assert read(tmp_path, pcap(PACKETS, order)) == (rows(None), None)


@pytest.mark.parametrize("kind", [0, 4])
def test_captures_of_all_interfaces_are_read(tmp_path: Path, kind: int) -> None:
    head = struct.pack(">HHH8x", kind, 280, 0)
    packets = [head + (b"\0\x0d" if each is FD else b"\0\x0c") + each for each in PACKETS]
    found, damage = read(tmp_path, pcap(packets, link=113))
    assert (found, damage) == (rows(None, Flag.SENT if kind == 4 else 0), None)


def test_a_capture_of_another_network_is_named(tmp_path: Path) -> None:
    for content in (pcap([bytes(60)], link=1), pcapng([bytes(60)], link=1)):
        with pytest.raises(LogError, match="another network than CAN"):
            read(tmp_path, content)


@pytest.mark.parametrize("make", [pcap, pcapng])
def test_a_capture_cut_anywhere_gives_the_frames_before(
    tmp_path: Path, make: Callable[[list[bytes]], bytes]
) -> None:
    content, whole = make(PACKETS), read(tmp_path, make(PACKETS))[0]
    counts = set()
    for size in range(52, len(content)):
        found, damage = read(tmp_path, content[:size])
        assert found == whole[: len(found)]
        counts.add(len(found))
        assert (damage is None) == (content[:size] == make(PACKETS[: len(found)]))
    assert counts >= {1, 2, 3}


def test_sizes_that_lie_are_damage(tmp_path: Path) -> None:
    lying = struct.pack("<IIII", 2000, 0, 2**31, 2**31)
    found, damage = read(tmp_path, pcap(PACKETS) + lying)
    assert len(found) == 4
    assert damage is not None
    assert "a packet of 2,147,483,648 bytes" in damage.problem
    found, damage = read(tmp_path, pcapng(PACKETS) + struct.pack("<III", 6, 2**31, 0))
    assert len(found) == 4
    assert damage is not None
    assert "a block of 2,147,483,648 bytes" in damage.problem
