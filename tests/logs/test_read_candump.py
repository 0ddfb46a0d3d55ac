"""candump logs give the frames that python-can gives; damaged lines are counted."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from logs.log_files import Row, mixed_frames, rows_by_python_can, write_log
from logs.text_log_files import agreed, read_text, sound_rows

from typedcan.logs.frames import FrameFlag as Flag


@pytest.mark.parametrize("kinds", ["classic", "classic remote", "fd", "classic remote error fd"])
@pytest.mark.parametrize("block_size", [1, 100, 65_536])
def test_logs_of_python_can_are_read_as_it_reads_them(
    tmp_path: Path, kinds: str, block_size: int
) -> None:
    path = write_log(tmp_path / "bus.log", mixed_frames(700, kinds=kinds))
    rows = sound_rows(path, block_size)
    # python-can drops the channel and the bytes of error frames of one class
    assert [_bare(row) for row in rows] == [_bare(row) for row in rows_by_python_can(path)]
    assert {row[3] for row in rows} == {"can0", "can1", "can2"}


def _bare(row: Row) -> Row:
    return (*row[:1], 0, row[2], None, 0, b"") if row[2] & Flag.ERROR else row


def test_logs_of_can_utils_have_names_of_channels_and_no_direction(tmp_path: Path) -> None:
    lines = (
        b"(1436509052.249713) vcan0 123#DEADBEEF\n"
        b"(1436509052.449847) can1 1F334455#1122334455667788\n"
        b"(1436509052.650004) vcan0 123#\n"
        b"(1436509052.650005) 5 7FF#R8\n"
        b"(1436509052.650006) vcan0 12345678#R\n"
        b"(1436509052.650007) vcan0 123##3112233445566778899AABBCC\n"
        b"(1436509052.650008) vcan0 123#de T\n"
    )
    rows = agreed(tmp_path / "bus.log", lines * 20)
    time = 1436509052.0
    payload = bytes.fromhex("1122334455667788")
    assert rows[:3] == [
        (time + 0.249713, 0x123, 0, "vcan0", 4, bytes.fromhex("DEADBEEF")),
        (time + 0.449847, 0x1F334455, Flag.EXTENDED, "can1", 8, payload),
        (time + 0.650004, 0x123, 0, "vcan0", 0, b""),
    ]
    fd = Flag.FD | Flag.BIT_RATE_SWITCH | Flag.ERROR_STATE
    assert rows[3:7] == [
        (time + 0.650005, 0x7FF, Flag.REMOTE, 5, 8, b""),
        (time + 0.650006, 0x12345678, Flag.EXTENDED | Flag.REMOTE, "vcan0", 0, b""),
        (time + 0.650007, 0x123, fd, "vcan0", 12, payload + bytes.fromhex("99AABBCC")),
        (time + 0.650008, 0x123, Flag.SENT, "vcan0", 1, b"\xde"),
    ]


def test_every_class_of_error_frames_is_one(tmp_path: Path) -> None:
    path = tmp_path / "bus.log"
    path.write_bytes(
        b"(1.5) can0 20000080#0000000000000000\n(2.5) can0 20000004#000C000000000000\n" * 20
    )
    bus_error, controller = sound_rows(path)[:2]
    assert bus_error == (1.5, 0x80, Flag.EXTENDED | Flag.ERROR, "can0", 8, bytes(8))
    data = bytes.fromhex("000C000000000000")
    assert controller == (2.5, 4, Flag.EXTENDED | Flag.ERROR, "can0", 8, data)


def test_an_error_frame_is_found_among_lines_like_it(tmp_path: Path) -> None:
    path = tmp_path / "bus.log"
    frame, error = b"(1.5) can0 10000004#00\n", b"(1.5) can0 20000004#00\n"
    path.write_bytes(frame * 50 + error + frame * 50)
    rows = sound_rows(path)
    assert rows[50] == (1.5, 4, Flag.EXTENDED | Flag.ERROR, "can0", 1, b"\0")
    assert rows[:50] == rows[51:] == [(1.5, 0x10000004, Flag.EXTENDED, "can0", 1, b"\0")] * 50


@given(
    st.lists(
        st.tuples(st.integers(0, 10**10 - 1), st.integers(1, 11), st.integers(0, 10**11 - 1)).map(
            lambda parts: f"{parts[0]}.{parts[2] % 10 ** parts[1]:0{parts[1]}d}"
        ),
        min_size=1,
        max_size=8,
    )
)
def test_times_are_rounded_as_float_rounds_them(
    tmp_path_factory: pytest.TempPathFactory, times: list[str]
) -> None:
    path = tmp_path_factory.mktemp("times") / "bus.log"
    path.write_text("".join(f"({time}) can0 123#00\n" for time in times * 20))
    assert [row[0] for row in sound_rows(path)] == [float(time) for time in times] * 20


@pytest.mark.parametrize(
    "line",
    [
        b"(1.5) can0 123#1Q",
        b"(1.5) can0 123#123",
        b"(1.x) can0 123#12",
        b"(1.5) can0 12G#12",
        b"(1.5) can0 FFFFFFFFF#12",
        b"(1.5) can0 123",
        b"(1.5) can0",
        b"(nan) can0 123#00",
        b"(1.5) can0 123#R99",
        b"(1.5) c\xff0 123#12",
        "(1.5) can\u200b 123#12".encode(),
        b"\x00\x01(1.5) can0 123#12",
        b"garbage",
    ],
)
@pytest.mark.parametrize("good", [1, 40])
def test_a_line_without_a_frame_is_counted_and_the_others_are_read(
    tmp_path: Path, line: bytes, good: int
) -> None:
    frame = b"(1.5) can0 123#12\n"
    path = tmp_path / "bus.log"
    path.write_bytes(frame * good + line + b"\n" + frame + line + b"\n" + frame)
    rows, damage = read_text(path)
    assert rows == [(1.5, 0x123, 0, "can0", 1, b"\x12")] * (good + 2)
    assert damage is not None
    assert (damage.path, damage.where, damage.lost) == (path, f"line {good + 1}", "2 lines")


def test_names_of_channels_that_cannot_be_shown_are_damage(tmp_path: Path) -> None:
    path = tmp_path / "bus.log"
    path.write_text("(1.5) can\u200b 123#12\n" * 50 + "(1.5) cän 123#12\n" * 50, encoding="utf-8")
    rows, damage = read_text(path)
    assert rows == [(1.5, 0x123, 0, "cän", 1, b"\x12")] * 50
    assert damage is not None
    assert (damage.where, damage.lost) == ("line 1", "50 lines")


def test_a_digit_that_is_none_is_found_at_every_column(tmp_path: Path) -> None:
    line = b"(1436509052.249713) vcan0 18FF45F4#DEADBEEF00C0FFEE R\n"
    digits = [place for place, code in enumerate(line) if code in b"0123456789ABCDEF"]
    digits.remove(line.index(b"0 "))  # the digit of the channel's name
    for place in digits:
        for wrong in b"/:@G`g\x10\x19\xb0\xff":
            bad = line[:place] + bytes([wrong]) + line[place + 1 :]
            path = tmp_path / "bus.log"
            path.write_bytes(line * 20 + bad + line * 20)
            rows, damage = read_text(path)
            assert (len(rows), len(set(rows))) == (40, 1), bad
            assert damage is not None, bad
            assert damage.where == "line 21"
