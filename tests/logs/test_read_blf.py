"""BLF logs give the frames that python-can gives, whoever wrote them."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import can
import pytest
from logs.blf_bytes import (
    CAN_ERROR_EXT,
    CAN_FD_MESSAGE,
    CAN_FD_MESSAGE_64,
    CAN_MESSAGE,
    CAN_MESSAGE2,
    TEN_MICROSECONDS,
    blf_file,
    blf_object,
    classic,
    fd_64,
    joined,
)
from logs.log_files import Row, mixed_frames, row_of, rows_by_python_can, rows_in, write_log

from typedcan.logs.read import inflate
from typedcan.logs.read.blf import BlfSource

LATEST = 2**64 - 1
EXTENDED = 0x8000_0000


def rows(path: Path, block_size: int = 1000) -> list[Row]:
    """What BlfSource gives for a sound log."""
    with BlfSource(path, block_size) as source:
        found = rows_in(source)
        assert source.damage is None
        assert source.position == source.size == path.stat().st_size
    return found


def agreed(path: Path, content: bytes) -> list[Row]:
    """What both readers give for this file."""
    path.write_bytes(content)
    found = rows(path)
    assert found == rows_by_python_can(path)
    return found


@pytest.mark.parametrize("kinds", ["classic", "classic remote", "fd", "classic remote error fd"])
@pytest.mark.parametrize("options", [{}, {"compression_level": 0}, {"max_container_size": 999}])
def test_logs_of_python_can_are_read_as_it_reads_them(
    tmp_path: Path, kinds: str, options: dict[str, int]
) -> None:
    frames = mixed_frames(3000, kinds=kinds)
    path = write_log(tmp_path / "bus.blf", frames, **options)
    assert rows(path) == rows_by_python_can(path)
    untimed = [row[1:] for row in rows(path)]
    # python-can's writer does not keep the direction of an error frame
    assert len(untimed) == len(frames)
    written = [row_of(frame)[1:] for frame in frames]
    assert [row for row in untimed if not row[1] & 4] == [row for row in written if not row[1] & 4]


def test_times_that_began_at_zero_stay_relative(tmp_path: Path) -> None:
    path = write_log(tmp_path / "bus.blf", mixed_frames(100, start=0.0))
    assert rows(path)[0][0] == 0.0
    assert rows(path) == rows_by_python_can(path)


def test_blocks_have_the_size_that_was_asked_for(tmp_path: Path) -> None:
    path = write_log(tmp_path / "bus.blf", mixed_frames(1050), max_container_size=5000)
    with BlfSource(path, 100) as source:
        blocks = list(source)
    assert [len(block) for block in blocks] == [100] * 10 + [50]
    assert {block.data.shape[1] for block in blocks} == {64}


def test_classic_frames_take_rows_of_eight_bytes(tmp_path: Path) -> None:
    path = write_log(tmp_path / "bus.blf", mixed_frames(100, kinds="classic"))
    with BlfSource(path) as source:
        assert [block.data.shape for block in source] == [(100, 8)]


@pytest.mark.parametrize("version", [1, 2])
@pytest.mark.parametrize("held", ["stored", "deflated"])
def test_every_kind_of_frame_in_every_kind_of_header(
    tmp_path: Path, version: int, held: str
) -> None:
    fd = "0200 01 09 23010000 00000000 00 07 0c 0000000000"  # 12 bytes valid of the 64 that follow
    remote_fd = "0200 80 09 23010000 00000000 00 01 00 0000000000"
    error = "0300 0000 00000000 00 00 04 00 0000 0000 55000080 0000 0000 0102030405060708"
    bodies = [
        (CAN_MESSAGE, classic(0x123, b"\1\2\3")),
        (CAN_MESSAGE, classic(EXTENDED | 0x18F01234, bytes(range(8)), channel=7, flags=1)),
        (CAN_MESSAGE, classic(0x321, b"", flags=0x80, dlc=5)),
        (CAN_MESSAGE, classic(0x321, b"12345678", dlc=15)),
        (CAN_MESSAGE, classic(0x321, b"12345678", channel=0)),
        (CAN_MESSAGE2, classic(0x7FF, b"\xff" * 8) + bytes(8)),
        (CAN_ERROR_EXT, bytes.fromhex(error)),
        (CAN_FD_MESSAGE, bytes.fromhex(fd) + bytes(range(64))),
        (CAN_FD_MESSAGE, bytes.fromhex(remote_fd) + bytes(64)),
        (CAN_FD_MESSAGE_64, fd_64(EXTENDED | 1, bytes(range(12)), dlc=9, flags=0x7000)),
        (CAN_FD_MESSAGE_64, fd_64(2, b"", dlc=4, flags=0x10, direction=1)),
        (CAN_FD_MESSAGE_64, fd_64(3, b"\1\2\3", dlc=15, valid=64)),
        (CAN_FD_MESSAGE_64, fd_64(4, bytes(range(48)), dlc=14, extra=b"extra data")),
    ]
    stream = joined(
        blf_object(kind, body, 1000 * number, version=version)
        for number, (kind, body) in enumerate(bodies * 20)
    )
    found = agreed(tmp_path / "bus.blf", blf_file(stream, stored=held == "stored"))
    assert len(found) == 13 * 20


@pytest.mark.parametrize("time", [0, 1, 999_999_999, 2**53 - 1, 2**53 + 1, 2**60 + 12_345, LATEST])
@pytest.mark.parametrize("unit", [TEN_MICROSECONDS, 2, 0])
def test_times_are_rounded_as_python_can_rounds_them(tmp_path: Path, time: int, unit: int) -> None:
    stream = blf_object(CAN_MESSAGE, classic(1, b""), time, unit=unit)
    assert len(agreed(tmp_path / "bus.blf", blf_file(stream))) == 1


def test_other_objects_are_passed_over(tmp_path: Path) -> None:
    objects = []
    for number in range(200):
        objects.append(blf_object(CAN_MESSAGE, classic(number, b"\1"), number))
        objects.append(blf_object(96, b"a marker"[: number % 7], number))
        objects.append(blf_object(CAN_MESSAGE, classic(number, b"\1"), number, version=3))
    other = blf_object(115, bytes(16), 0)
    found = agreed(tmp_path / "bus.blf", blf_file(joined(objects), between=other))
    assert [row[1] for row in found] == list(range(200))


def test_a_payload_may_look_like_an_object(tmp_path: Path) -> None:
    bait = b"LOBJ\x20\0\1\0"
    stream = joined(blf_object(CAN_MESSAGE, classic(number, bait), number) for number in range(100))
    found = agreed(tmp_path / "bus.blf", blf_file(stream))
    assert [row[5] for row in found] == [bait] * 100


@pytest.mark.parametrize("stated", [0, 1, 10, 10**6, 2**32 - 1])
def test_the_stated_size_of_a_container_is_not_relied_on(tmp_path: Path, stated: int) -> None:
    frames = [blf_object(CAN_MESSAGE, classic(number, b""), number) for number in range(10)]
    content = bytearray(blf_file(joined(frames)))
    content[144 + 24 : 144 + 28] = stated.to_bytes(4, "little")
    assert len(agreed(tmp_path / "bus.blf", bytes(content))) == 10


def test_without_libdeflate_zlib_does_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inflate, "_fast", lambda body, size: None)
    path = write_log(tmp_path / "bus.blf", mixed_frames(3000))
    assert rows(path) == rows_by_python_can(path)


def test_an_empty_log_has_no_blocks(tmp_path: Path) -> None:
    path = write_log(tmp_path / "bus.blf", [])
    with BlfSource(path) as source:
        assert list(source) == []
        assert source.damage is None


def test_a_log_that_was_never_closed_is_read_to_its_end(tmp_path: Path) -> None:
    path = tmp_path / "bus.blf"
    writer = can.BLFWriter(path, max_container_size=480)
    for frame in mixed_frames(100, kinds="classic"):
        writer.on_message_received(frame)
    writer.file.close()  # as if the recorder lost its power: the header is never completed
    assert len(rows(path)) == 100
    assert rows(path) == rows_by_python_can(path)


def test_memory_does_not_grow_with_the_log(tmp_path: Path) -> None:
    path = tmp_path / "bus.blf"
    part = joined(
        blf_object(CAN_MESSAGE, classic(number, bytes(8)), number) for number in range(2500)
    )
    content = blf_file(part, container_size=2**17)
    path.write_bytes(content[:144] + content[144:] * 400)
    tracemalloc.start()
    with BlfSource(path) as source:
        assert sum(map(len, source)) == 1_000_000
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 16e6


def test_an_object_of_any_size_is_passed_over_in_little_memory(tmp_path: Path) -> None:
    path = tmp_path / "bus.blf"
    frame = blf_object(CAN_MESSAGE, classic(5, b""), 0)
    path.write_bytes(
        blf_file(frame + blf_object(65, bytes(50_000_000), 0) + frame, container_size=10**9)
    )
    tracemalloc.start()
    with BlfSource(path) as source:
        assert sum(map(len, source)) == 2
        assert source.damage is None
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 8e6
