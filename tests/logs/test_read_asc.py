"""ASC logs of Vector's tools and of python-can give the frames that python-can gives, or better."""

from __future__ import annotations

from pathlib import Path

import can
import pytest
from logs.log_files import mixed_frames, row_of, rows_by_python_can, write_log
from logs.text_log_files import agreed, read_text, sound_rows

from typedcan.logs.frames import FrameFlag as Flag

VECTOR = b"""date Sat Sep 30 10:06:13.191 AM 2017
base hex  timestamps absolute
internal events logged
// version 9.0.0
Begin Triggerblock Sat Sep 30 10:06:13.191 AM 2017
   0.000000 Start of measurement
   0.015991 CAN 1 Status:chip status error passive - TxErr: 132 RxErr: 0
   0.015991 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%
   1.015991 1  222             Tx   d 8 01 02 03 04 05 06 07 08  Length = 240015 BitCount = 124
   1.025991 2  18EBFF00x       Rx   d 8 01 A0 0F A6 60 3B D1 40  Length = 273910 BitCount = 141 ID = 4
   1.035991 2  18EBFF00x       Rx   d 8 02 1F DE 80 25 DF C0 2B  Length = 27391 BitCount = 141 ID = 41
   2.501000 1  ErrorFrame
   2.501010 1  ErrorFrame	ECC: 10100010
   2.510001 2  100             Tx   r
   2.520002 3  200             Rx   r Length = 1704000 BitCount = 145 ID = 88888888x
   2.584921 4  300             Rx   r 8 Length = 1704000 BitCount = 145 ID = 88888888x
   3.098426 1  1F4             Rx   d 0 Length = 1704000 BitCount = 145
   3.148421 1  J1939TP FEE3p 6 0 0 - Rx d 23 A0 0F A6 60 3B D1 40 1F DE 80 25 DF C0 2B E1 00
   3.297743 1  J1939TP FEE3p 6 0 0 - Rx d 23 A0 0F A6 60 3B D1 40 1F DE 80 25 DF C0 2B E1 00
  17.876707 CANFD   1 Rx   50005x                            Name 0 0 5  0 140000  73 200050 7a60495 46500250 460a0250 20011736 20010205
  17.876708 CANFD   1 Tx   1FFx                                   1 1 8  8 00 11 22 33 44 55 66 77   102203 133   303000 e0006659 46500250
  20.105214 2  18EBFFFFx       Rx   d f 01 A0 0F A6 60 3B D1 40  Length = 273910 BitCount = 141
  20.155119 CANFD   3 Tx   1c4d80a7x                              1 0 f 64 00 01 02 03 04 05 06 07 08 09 0a 0b 0c 0d 0e 0f 10 11 12 13 14 15 16 17 18 19 1a 1b 1c 1d 1e 1f 20 21 22 23 24 25 26 27 28 29 2a 2b 2c 2d 2e 2f 30 31 32 33 34 35 36 37 38 39 3a 3b 3c 3d 3e 3f   138   40   303000 0
  20.204671 CANFD   3 Tx   ErrorFrame                             Not Acknowledge error, dominant error flag fffe c7 31ca
End TriggerBlock
"""  # noqa: E501


@pytest.mark.parametrize("kinds", ["classic", "classic remote", "fd", "classic remote error fd"])
@pytest.mark.parametrize("block_size", [1, 100, 65_536])
def test_logs_of_python_can_are_read_as_it_reads_them(
    tmp_path: Path, kinds: str, block_size: int
) -> None:
    frames = mixed_frames(700, kinds=kinds)
    path = write_log(tmp_path / "bus.asc", frames)
    # python-can takes CAN FD frames without payload for remote frames
    empty = [row[2] & Flag.FD and not row[4] for row in rows_by_python_can(path)]
    expected = [
        (*row[:2], row[2] & ~Flag.REMOTE if bare else row[2], *row[3:])
        for row, bare in zip(rows_by_python_can(path), empty, strict=True)
    ]
    assert sound_rows(path, block_size) == expected


def test_logs_of_vector_tools_hold_much_else(tmp_path: Path) -> None:
    path = tmp_path / "bus.asc"
    path.write_bytes(VECTOR)
    rows = sound_rows(path)
    with can.LogReader(path) as reader:
        frames = list(reader)
    assert frames.pop(-3).dlc == 64  # a classic frame with DLC 15
    long_dlc = rows.pop(-3)
    assert long_dlc[1:5] == (0x18EBFFFF, Flag.EXTENDED, 1, 8)
    by_python_can = [row_of(frame) for frame in frames]
    # a classic frame on a channel of CAN FD, as its flags say; python-can takes it for CAN FD
    [place] = [place for place, row in enumerate(rows) if row[1] == 0x50005]
    assert by_python_can[place] == (*rows[place][:2], rows[place][2] | Flag.FD, *rows[place][3:])
    by_python_can[place] = rows[place]
    assert rows[place] == (17.876707, 0x50005, Flag.EXTENDED | Flag.REMOTE, 0, 5, b"")
    # its direction is in the line
    assert by_python_can[-1][2] == Flag.ERROR | Flag.EXTENDED | Flag.FD | Flag.SENT
    assert rows == by_python_can
    assert rows[0] == (1.015991, 0x222, Flag.SENT, 0, 8, bytes(range(1, 9)))
    assert rows[-2][4:] == (64, bytes(range(64)))


def test_many_lines_are_read_as_few(tmp_path: Path) -> None:
    lines = VECTOR.splitlines(keepends=True)
    content = b"".join([*lines[:6], b"".join(lines[6:-1]) * 50, lines[-1]])
    few, many = tmp_path / "few.asc", tmp_path / "many.asc"
    few.write_bytes(VECTOR)
    many.write_bytes(content)
    assert sound_rows(many) == sound_rows(few) * 50


@pytest.mark.parametrize("newline", [b"\n", b"\r\n"])
def test_decimal_logs_are_read(tmp_path: Path, newline: bytes) -> None:
    lines = [b"base dec  timestamps absolute", b"no internal events logged"]
    lines += [
        b"   0.100000 1  255x   Rx   d 3 16 255   7",
        b" 0.2 2 100 Tx d 8 1 2 3 4 5 6 7 8",
    ] * 30
    rows = agreed(tmp_path / "bus.asc", newline.join(lines) + newline)
    assert rows[0] == (0.1, 255, Flag.EXTENDED, 0, 3, bytes([16, 255, 7]))
    assert len(rows) == 60


def test_a_log_without_header_keeps_its_first_frame(tmp_path: Path) -> None:
    path = tmp_path / "bus.asc"
    path.write_bytes(b"1.5 1  123  Rx   d 1 0A\n2.5 1  123  Rx   d 1 0B\n")
    assert [row[0] for row in sound_rows(path)] == [1.5, 2.5]


@pytest.mark.parametrize(
    "line",
    [
        b"1.5 1  123  Rx   d 2 0A",  # a byte is missing
        b"1.5 1  123  Rx   d 2 0A 0G",
        b"1.5 1  123  Rx   d 2 0A 1BC",
        b"1.5 1  123  Rx",
        b"1.5 1  123  Rx   d",
        b"1.5 1  12G  Rx   d 2 0A 0B",
        b"1.5 1  20000000x  Rx   d 2 0A 0B",
        b"1.5 CANFD 1 Rx",
        b"1.5 1  12\x003  Rx   d 2 0A 0B",
    ],
)
@pytest.mark.parametrize("good", [1, 40])
def test_a_line_without_a_frame_is_counted_and_the_others_are_read(
    tmp_path: Path, line: bytes, good: int
) -> None:
    frame = b"1.5 1  123  Rx   d 2 0A 0B\n"
    path = tmp_path / "bus.asc"
    path.write_bytes(b"base hex\n" + frame * good + line + b"\n" + frame + line + b"\n" + frame)
    rows, damage = read_text(path)
    assert rows == [(1.5, 0x123, 0, 0, 2, b"\x0a\x0b")] * (good + 2)
    assert damage is not None
    assert (damage.where, damage.lost) == (f"line {good + 2}", "2 lines")
