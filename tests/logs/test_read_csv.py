"""CSV logs of python-can give the frames that python-can gives; damaged lines are counted."""

from __future__ import annotations

import base64
import random
from pathlib import Path

import can
import pytest
from logs.log_files import Row, long_is_fd, mixed_frames, rows_by_python_can, write_log
from logs.text_log_files import read_text, sound_rows


def agreed(path: Path, content: bytes) -> list[Row]:
    """What both readers give; python-can does not know which frames are CAN FD."""
    path.write_bytes(content)
    found = sound_rows(path)
    assert found == long_is_fd(rows_by_python_can(path))
    return found


HEADER = b"timestamp,arbitration_id,extended,remote,error,dlc,data\n"
FRAME = b"1.5,0x123,0,0,0,3,3q2+\n"
ROW = (1.5, 0x123, 0, None, 3, bytes.fromhex("DEADBE"))


@pytest.mark.parametrize("kinds", ["classic", "classic remote", "fd", "classic remote error fd"])
@pytest.mark.parametrize("block_size", [1, 100, 65_536])
def test_logs_of_python_can_are_read_as_it_reads_them(
    tmp_path: Path, kinds: str, block_size: int
) -> None:
    path = write_log(tmp_path / "bus.csv", mixed_frames(700, kinds=kinds))
    assert sound_rows(path, block_size) == long_is_fd(rows_by_python_can(path))


def test_every_bit_of_times_and_payloads_is_kept(tmp_path: Path) -> None:
    noise = random.Random(1)
    times = [1.7e9 * noise.random() for _ in range(2000)]
    times += [1.7e9 + noise.randrange(10**9) * 1e-9 for _ in range(2000)]
    times += [noise.random() * 10.0**-power for power in range(8) for _ in range(200)]
    frames = [can.Message(timestamp=time, data=noise.randbytes(8)) for time in times]
    rows = sound_rows(write_log(tmp_path / "bus.csv", frames))
    assert [row[0] for row in rows] == times
    assert [row[5] for row in rows] == [bytes(frame.data) for frame in frames]


@pytest.mark.parametrize("length", range(65))
def test_payloads_of_every_length_are_read(tmp_path: Path, length: int) -> None:
    noise = random.Random(length)
    payloads = [noise.randbytes(length) for _ in range(40)]
    lines = [
        b"%d.5,0x1f,1,0,0,%d,%s\n" % (number, length, base64.b64encode(payload))
        for number, payload in enumerate(payloads, 10)
    ]
    rows = agreed(tmp_path / "bus.csv", HEADER + b"".join(lines))
    assert [row[5] for row in rows] == payloads


@pytest.mark.parametrize(
    ("length", "text"), [(7, b"AAAAAAAAAP=="), (8, b"AAAAAAAAAAD="), (10, b"AAAAAAAAAAAAAP==")]
)
def test_bits_behind_a_payload_are_no_part_of_it(tmp_path: Path, length: int, text: bytes) -> None:
    line = b"1.5,0x1f,1,0,0,%d,%s\n" % (length, text)
    rows = agreed(tmp_path / "bus.csv", HEADER + line * 50)
    assert rows[0][5] == bytes(length)


def test_a_log_without_header_keeps_its_first_frame(tmp_path: Path) -> None:
    path = write_log(tmp_path / "bus.csv", [can.Message(timestamp=2.5)], append=True)
    assert [row[0] for row in sound_rows(path)] == [2.5]


@pytest.mark.parametrize(
    "line",
    [
        b"1.5,0x123,0,0,0,3,3q2",
        b"1.5,0x123,0,0,0,2,3q2+",
        b"1.5,0x123,0,0,0,3",
        b"1.5,0x123,0,0,0,3,3q2+,",
        b"1.5;0x123;0;0;0;3;3q2+",
        b"1.5,0x12G,0,0,0,3,3q2+",
        b"1.5,0x20000000,1,0,0,3,3q2+",
        b"1.5,-1,1,0,0,3,3q2+",
        b"inf,0x123,0,0,0,3,3q2+",
        b"1.5,0x123,0,1,0,300,",
        b"garbage",
    ],
)
@pytest.mark.parametrize("good", [1, 40])
def test_a_line_without_a_frame_is_counted_and_the_others_are_read(
    tmp_path: Path, line: bytes, good: int
) -> None:
    path = tmp_path / "bus.csv"
    path.write_bytes(HEADER + FRAME * good + line + b"\n" + FRAME + line + b"\n" + FRAME)
    rows, damage = read_text(path)
    assert rows == [ROW] * (good + 2)
    assert damage is not None
    assert (damage.where, damage.lost) == (f"line {good + 2}", "2 lines")


def test_a_letter_that_is_none_of_base64_is_found(tmp_path: Path) -> None:
    path = tmp_path / "bus.csv"
    for code in range(0x21, 0x100):
        letter = bytes([code])
        if letter.isalnum() or letter in b"+/":
            continue
        path.write_bytes(HEADER + FRAME * 20 + FRAME.replace(b"q", letter) + FRAME * 20)
        rows, damage = read_text(path)
        assert rows == [ROW] * 40
        assert damage is not None
