"""A damaged BLF log gives every frame before the damage, and says where it broke."""

from __future__ import annotations

import bisect
import random
import struct
import tracemalloc
import zlib
from pathlib import Path

import pytest
from logs.blf_bytes import (
    CAN_FD_MESSAGE,
    CAN_MESSAGE,
    HEADER_SIZE,
    blf_file,
    blf_object,
    classic,
    container,
    joined,
)
from logs.log_files import Row, mixed_frames, rows_by_python_can, rows_in, write_log

from typedcan.logs.read.blf import BlfSource
from typedcan.logs.read.source import Damage

PLACES = 200
OBJECT_SIZES = {"error": 64, "fd": 116, "other": 48}  # as python-can writes them, no padding


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A log of many containers."""
    path = tmp_path_factory.mktemp("blf") / "bus.blf"
    return write_log(path, mixed_frames(1500), max_container_size=4000)


def read(path: Path) -> tuple[list[Row], Damage | None]:
    with BlfSource(path, 500) as source:
        return rows_in(source), source.damage


def object_ends(rows: list[Row]) -> list[int]:
    """Where the object of each frame ends in what the containers hold together."""
    end, found = 0, []
    for row in rows:
        end += OBJECT_SIZES["error" if row[2] & 4 else "fd" if row[2] & 8 else "other"]
        found.append(end)
    return found


def frames_within(content: bytes, rows: list[Row]) -> int:
    """How many frames can be had from these first bytes of a log, by zlib alone."""
    held, at = 0, HEADER_SIZE
    while at + 32 <= len(content):
        size = struct.unpack_from("<L", content, at + 8)[0]
        held += len(zlib.decompressobj().decompress(content[at + 32 : at + size]))
        at += size + size % 4
    return bisect.bisect_right(object_ends(rows), held)


def next_container(content: bytes, place: int) -> int:
    """Where the first container begins that is not before this place."""
    at = HEADER_SIZE
    while at < place:
        size = struct.unpack_from("<L", content, at + 8)[0]
        at += size + size % 4
    return at


def damaged(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path


def lost_bytes(damage: Damage) -> int:
    return int(damage.lost.removesuffix(" bytes").replace(",", ""))


def test_a_log_cut_anywhere_gives_every_frame_before_the_cut(log: Path, tmp_path: Path) -> None:
    content, rows = log.read_bytes(), rows_by_python_can(log)
    assert frames_within(content, rows) == len(rows) == 1500
    for place in random.Random(5).sample(range(HEADER_SIZE, len(content)), PLACES):
        found, damage = read(damaged(tmp_path / "cut.blf", content[:place]))
        assert found == rows[: frames_within(content[:place], rows)]
        assert damage is not None
        assert place - 32 < int(damage.where.removeprefix("byte ")) <= place
        assert len(content) - place <= lost_bytes(damage) < len(content) - place + 32


def test_a_log_cut_within_its_header_gives_no_frames(log: Path, tmp_path: Path) -> None:
    content = log.read_bytes()
    for place in (0, 1, 4, 71, 72, 143):
        found, damage = read(damaged(tmp_path / "cut.blf", content[:place]))
        assert found == []
        assert damage is not None


def test_overwritten_bytes_leave_every_frame_before_them(log: Path, tmp_path: Path) -> None:
    content, rows = log.read_bytes(), rows_by_python_can(log)
    noise = random.Random(6)
    unnoticed = 0
    for place in noise.sample(range(HEADER_SIZE, len(content) - 16), PLACES):
        spoilt = bytearray(content)
        size = noise.randrange(1, 17)
        spoilt[place : place + size] = noise.randbytes(size)
        found, damage = read(damaged(tmp_path / "spoilt.blf", bytes(spoilt)))
        before = frames_within(content[:place], rows)
        assert found[:before] == rows[:before]
        if damage is None:
            assert found == rows
            unnoticed += 1
        else:
            assert int(damage.where.removeprefix("byte ")) <= next_container(content, place + size)
    assert unnoticed < 5  # a few bytes mean nothing: padding, versions


def test_a_spoilt_container_is_named_with_the_bytes_from_it_on(tmp_path: Path) -> None:
    frames = [blf_object(CAN_MESSAGE, classic(number, b"\1"), number) for number in range(100)]
    first, second, third = (joined(frames[at : at + 30]) for at in (0, 30, 60))
    spoilt = bytearray(container(second))
    spoilt[-8] ^= 0xFF  # in the checksum, or just before it
    start = len(blf_file(first))
    content = blf_file(first) + bytes(spoilt) + container(third)
    found, damage = read(damaged(tmp_path / "bus.blf", content))
    assert [row[1] for row in found[:30]] == list(range(30))
    assert damage is not None
    assert damage.where == f"byte {start}"
    assert lost_bytes(damage) == len(content) - start
    assert "frames from here on are unchecked" in damage.problem


@pytest.mark.parametrize(
    ("kind", "body", "size"),
    [
        (CAN_MESSAGE, classic(1, b""), 0),  # would be read again and again
        (CAN_MESSAGE, classic(1, b""), 15),
        (CAN_MESSAGE, classic(1, b""), 47),
        (CAN_MESSAGE, classic(1, b""), 2**32 - 1),
        (CAN_FD_MESSAGE, bytes(84), 60),
        (65, bytes(10), 30),
        (65, bytes(10), 2**32 - 1),
    ],
)
def test_an_object_of_a_wrong_size_ends_the_log(
    tmp_path: Path, kind: int, body: bytes, size: int
) -> None:
    good = [blf_object(CAN_MESSAGE, classic(number, b""), number) for number in range(50)]
    content = blf_file(joined([*good[:25], blf_object(kind, body, 0, size=size), *good[25:]]))
    found, damage = read(damaged(tmp_path / "bus.blf", content))
    assert [row[1] for row in found] == list(range(25))
    assert damage is not None


def test_a_log_that_ends_within_an_object_is_damaged(tmp_path: Path) -> None:
    frames = [blf_object(CAN_MESSAGE, classic(number, b""), number) for number in range(50)]
    stream = joined(frames)
    for missing in (1, 17, 40, 47):
        found, damage = read(damaged(tmp_path / "bus.blf", blf_file(stream[:-missing])))
        assert len(found) == 49
        assert damage is not None


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"LOGG",
        b"not a log at all" * 20,
        b"LOGG" + b"\xff" * 200,
        blf_file(b"", size=10**6),
        blf_file(b"") + b"LOBJ",
        blf_file(b"") + b"what is this? nobody knows......",
        blf_file(b"") + struct.pack("<4sHHLL", b"LOBJ", 16, 1, 0, 10) + bytes(16),
        blf_file(b"") + struct.pack("<4sHHLL", b"LOBJ", 16, 1, 20, 10) + bytes(16),
        blf_file(b"") + struct.pack("<4sHHLL", b"LOBJ", 16, 1, 40, 10) + b"\7" + bytes(23),
        blf_file(b"") + struct.pack("<4sHHLL", b"LOBJ", 16, 1, 2**31, 10) + bytes(50),
        blf_file(bytes(1000)),
    ],
)
def test_what_is_no_log_is_damage_and_no_crash(tmp_path: Path, content: bytes) -> None:
    found, damage = read(damaged(tmp_path / "bus.blf", content))
    assert found == []
    assert damage is not None
    assert "\n" not in str(damage)


def test_a_container_that_inflates_without_end_takes_little_memory(tmp_path: Path) -> None:
    frame = blf_object(CAN_MESSAGE, classic(1, b""), 0)
    bomb = container(frame + bytes(100_000_000), stated=2**32 - 1)
    path = damaged(tmp_path / "bus.blf", blf_file(b"") + bomb)
    tracemalloc.start()
    found, damage = read(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(found) == 1
    assert damage is not None
    assert peak < 8e6


def test_more_channels_than_any_bus_has_are_damage(tmp_path: Path) -> None:
    frames = [
        blf_object(CAN_MESSAGE, classic(1, b"", channel=number), 0) for number in range(40_000)
    ]
    found, damage = read(damaged(tmp_path / "bus.blf", blf_file(joined(frames), stored=True)))
    assert damage is not None
    assert [row[3] for row in found] == [number - 1 for number in range(len(found))]


def test_the_sizes_of_objects_are_those_that_python_can_writes(log: Path) -> None:
    content, held, at = log.read_bytes(), 0, HEADER_SIZE
    while at < len(content):
        size = struct.unpack_from("<L", content, at + 8)[0]
        held += len(zlib.decompress(content[at + 32 : at + size]))
        at += size + size % 4
    assert object_ends(rows_by_python_can(log))[-1] == held
