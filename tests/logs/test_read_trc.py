"""TRC logs of every version give the frames that python-can gives, and the error frames."""

from __future__ import annotations

import random
from pathlib import Path

import can
import pytest
from can.io.trc import TRCFileVersion, TRCWriter
from logs.log_files import mixed_frames, rows_by_python_can, write_log
from logs.text_log_files import read_text, sound_rows

from typedcan.logs.frames import FrameFlag as Flag

START = b";$STARTTIME=43008.920986006946\n"
DAY = 24 * 60 * 60
STARTED = 43008.920986006946 * DAY - 25569 * DAY
"""Seconds since 1970; PEAK counts days from 1899-12-30."""

V1_0 = b"""\
;   Start time: 30.09.2017 22:06:13.191.000
     1)      1841 0001 8 00 00 00 00 00 00 00 FF
     2)      2034 00001234 3 01 02 0A
     3)      2035 0002 0
     4)      2036 0003 8 RTR
     5)      2037 FFFFFFFF 4 00 00 00 08
"""
V1_1 = b""";$FILEVERSION=1.1
%s;
     1)        17.535  Rx         0300  8  00 00 00 00 04 00 00 00
     2)       700.315  Tx     18EFC034  8  3D 54 AB 01 02 03 04 F5
     3)       873.2    Rx         0100  2  0A 0B
     4)       874.2    Rx         0100  0
     5)       875.2    Rx         0100  8  RTR
     6)       895.2    Warng  FFFFFFFF  4  00 00 00 08  BUSHEAVY
     7)       896.2    Error      0008  4  00 19 08 08
"""
V1_3 = b""";$FILEVERSION=1.3
%s;   a comment
     1)      1059.900 1  Rx        0300 -  8    00 00 00 00 04 00 00 FF
     2)      1283.231 2  Tx    18EFC034 -  2    0A 0B
     3)      1298.945 1  Rx        0400 -  8    RTR
     4)      1323.201 1  Warng FFFFFFFF -  4    00 00 00 08  BUSHEAVY
"""
V2_0 = b""";$FILEVERSION=2.0
%s;$COLUMNS=N,O,T,I,d,l,D
      1      1059.900 DT     0300 Rx 7  00 00 00 00 04 00 00
      2      1283.231 FB     0400 Tx 12 00 11 22 33 44 55 66 77 88 99 AA BB
      3      1298.945 FE 18EFC034 Tx 8  01 02 03 04 05 06 07 08
      4      1298.946 DT     0123 Rx 0
      5      1323.201 ST          Rx    00 00 00 08
      6      1334.416 ER          Rx    04 00 02 00 00
      7      1334.417 RR     0100 Rx 8
"""
V2_1 = b""";$FILEVERSION=2.1
%s;$COLUMNS=N,O,T,B,I,d,R,L,D
      1      1059.900 DT 1      0300 Rx -  7    00 00 00 00 04 00 FF
      2      1283.231 DT 2      0400 Tx -  8    00 11 22 33 44 55 66 77
      3      1298.945 BI 1  18EFC034 Rx -  9    00 11 22 33 44 55 66 77 88 99 AA BB
      4      1323.201 ST 1         - Rx -  4    00 00 00 08
      5      1334.416 ER 1         - Rx -  5    04 00 02 00 00
"""


@pytest.mark.parametrize("version", [TRCFileVersion.V1_0, TRCFileVersion.V2_1])
@pytest.mark.parametrize("block_size", [1, 100, 65_536])
def test_logs_of_python_can_are_read_as_it_reads_them(
    tmp_path: Path, version: TRCFileVersion, block_size: int
) -> None:
    path = tmp_path / "bus.trc"
    with TRCWriter(path) as writer:
        writer.file_version = version
        for frame in mixed_frames(700, kinds="classic"):
            writer.on_message_received(frame)
    assert sound_rows(path, block_size) == rows_by_python_can(path)


@pytest.mark.parametrize("log", [V1_0, V1_1, V1_3, V2_0, V2_1])
@pytest.mark.parametrize("times", [1, 40])
@pytest.mark.parametrize("start", [START, b""])
def test_every_version_is_read_as_python_can_reads_it(
    tmp_path: Path, log: bytes, times: int, start: bytes
) -> None:
    lines = log.replace(b"%s", start).splitlines(keepends=True)
    header = [line for line in lines if line.startswith(b";")]
    frames = [line for line in lines if not line.startswith(b";")] * times
    path = tmp_path / "bus.trc"
    path.write_bytes(b"".join([*header, *frames]))
    rows = sound_rows(path)
    data = [row for row in rows if not row[2] & Flag.ERROR]
    assert data == rows_by_python_can(path)
    assert len(data) >= 3 * times
    # python-can leaves error frames out
    assert len(rows) - len(data) == times * sum(
        b"Error" in line or b" ER " in line for line in lines
    )


def test_a_log_tells_direction_bus_and_time(tmp_path: Path) -> None:
    path = tmp_path / "bus.trc"
    path.write_bytes(V2_1.replace(b"%s", START))
    first, second, third, error = sound_rows(path)
    assert first[0] == pytest.approx(STARTED + 1.0599, abs=1e-6)
    assert first[1:] == (0x300, 0, 1, 7, bytes([0, 0, 0, 0, 4, 0, 255]))
    assert second[1:] == (0x400, Flag.SENT, 2, 8, bytes(range(0, 0x88, 0x11)))
    fd = Flag.EXTENDED | Flag.FD | Flag.ERROR_STATE
    assert third[1:] == (0x18EFC034, fd, 1, 12, bytes(range(0, 0xCC, 0x11)))
    assert error[1:] == (0, Flag.ERROR | Flag.EXTENDED, 1, 5, bytes.fromhex("0400020000"))


def test_long_offsets_are_rounded_as_python_can_rounds_them(tmp_path: Path) -> None:
    noise = random.Random(1)
    times = sorted(1.6e9 + noise.random() * 4e6 for _ in range(3000))
    frames = [can.Message(timestamp=time, data=noise.randbytes(8)) for time in times]
    path = write_log(tmp_path / "bus.trc", frames)
    assert sound_rows(path) == rows_by_python_can(path)


@pytest.mark.parametrize(
    "line",
    [
        b"  1  5.0 DT 1 0300 Rx -  2  0A",
        b"  1  5.0 DT 1 0300 Rx -  2  0A 0G",
        b"  1  5.0 DT 1 0300 Rx -  2",
        b"  1  5.0 DT 1 0300",
        b"  1  5.0 DT 1 03G0 Rx -  2  0A 0B",
        b"  1  5.0 DT x 0300 Rx -  2  0A 0B",
        b"  1  5.x DT 1 0300 Rx -  2  0A 0B",
        b"  1  5.0 DT 1 FFFFFFFF Rx -  2  0A 0B",
        b"garbage",
    ],
)
@pytest.mark.parametrize("good", [1, 40])
def test_a_line_without_a_frame_is_counted_and_the_others_are_read(
    tmp_path: Path, line: bytes, good: int, caplog: pytest.LogCaptureFixture
) -> None:
    header = b";$FILEVERSION=2.1\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n"
    frame = b"  1  5.0 DT 1 0300 Rx -  2  0A 0B\n"
    path = tmp_path / "bus.trc"
    path.write_bytes(header + frame * good + line + b"\n" + frame + line + b"\n" + frame)
    rows, damage = read_text(path)
    assert rows == [(0.005, 0x300, 0, 1, 2, b"\x0a\x0b")] * (good + 2)
    assert damage is not None
    assert (damage.where, damage.lost) == (f"line {good + 3}", "2 lines")
    assert caplog.records == []


def test_a_header_that_makes_no_sense_is_damage(tmp_path: Path) -> None:
    path = tmp_path / "bus.trc"
    frame = b"  1)  5.0 Rx 0300 2  0A 0B\n"
    path.write_bytes(b";$FILEVERSION=1.1\n;$STARTTIME=noon\n" + frame)
    rows, damage = read_text(path)
    assert rows == [(0.005, 0x300, 0, 1, 2, b"\x0a\x0b")]
    assert damage is not None
    assert damage.where == "line 2"
    path.write_bytes(b";$FILEVERSION=2.1\n" + frame)  # which columns are there?
    rows, damage = read_text(path)
    assert rows == []
    assert damage is not None
    assert damage.where == "line 2"
