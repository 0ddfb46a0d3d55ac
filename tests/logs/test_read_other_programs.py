"""Logs as programs other than python-can write them: small ones by hand, with what is right.

Where can-utils and python-can read a file otherwise than this package, the reason is here:

==============================  ====================  ====================  ====================
what                            python-can            can-utils' asc2log    here, because
==============================  ====================  ====================  ====================
ASC, ``timestamps relative``    as absolute           from the line before  as can-utils: the
                                                                            format says so
ASC, TxRq                       a frame that was sent no frame              as can-utils: it was
                                                                            not on the bus yet
ASC without header              first line dropped    none is read          all: nothing is odd
ASC with names                  not read              names read as hex     by ``ID =`` behind
CANFD line without flag EDL     CAN FD                classic               as can-utils: the
                                                                            flags say so
CANFD line without payload      remote frame          no payload            as can-utils, unless
                                                                            flags say remote
TRC, error frames               left out              (reads none)          error frames
candump, bus errors             without id, bytes and (reads its own)       kept as written
                                channel
CSV of more than 8 bytes        classic               (reads none)          CAN FD: no other
                                                                            frame is so long
BLF, object types 2 and 104     left out              (reads none)          error frames
BLF, requests to send           sent frames           (reads none)          no frame on the bus
==============================  ====================  ====================  ====================
"""

from __future__ import annotations

import shutil
import subprocess
from collections import Counter
from datetime import datetime
from pathlib import Path

import pytest
from logs.log_files import Row, mixed_frames, rows_in, write_log

from typedcan.logs.frames import FrameFlag as Flag
from typedcan.logs.read import open_log
from typedcan.logs.read.source import LogSource, Start

CASES = Path(__file__).parent / "other_programs"
PAYLOAD = bytes.fromhex("C8204E204EFFFFFF")
EXT = Flag.EXTENDED


def read(path: Path, block_size: int = 100) -> tuple[list[Row], LogSource]:
    """The frames of a log, and what read it."""
    with open_log(path, block_size) as source:
        return rows_in(source), source


def sound(path: Path) -> list[Row]:
    """The frames of a log without damage."""
    rows, source = read(path)
    assert source.damage is None, source.damage
    return rows


def written(tmp_path: Path, text: str, name: str = "bus.txt") -> Path:
    """A log of this text."""
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def by_clock(wall: datetime, *, counted: bool) -> Start:
    """When a log began by the clock of its recorder."""
    return Start(wall, is_utc=False, counted=counted)


NEEDS_CAN_UTILS = pytest.mark.skipif(
    shutil.which("asc2log") is None, reason="can-utils, a package of Debian, is not installed"
)


def by_asc2log(tmp_path: Path, path: Path) -> list[Row]:
    """What asc2log makes of an ASC log; it numbers buses from 0 as names."""
    output = tmp_path / "asc2log.log"
    subprocess.run(["asc2log", "-I", path, "-O", output], check=True, env={"TZ": "UTC"})
    return sound(output)


@pytest.mark.parametrize(
    ("name", "count"),
    [
        ("asc-symbolic-names.asc", 40),
        ("asc-txrq.asc", 3),
        ("chinese-date.asc", 2),
        ("comment-gbk.asc", 2),
        ("nohead.asc", 2),
        ("candump-screen.log", 2),
        ("candump-screen-date.log", 2),
        ("candump-len8.log", 8),
        ("savvycan-gvret.csv", 2),
        ("trc-v10.trc", 4),
        ("trc-v12.trc", 2),
        ("trc-v13.trc", 3),
        ("trc-v21.trc", 5),
        ("trc-local-start.trc", 392),
        ("blf-error-type2.blf", 3),
    ],
)
def test_every_frame_is_read(name: str, count: int) -> None:
    assert len(sound(CASES / name)) == count


@pytest.mark.parametrize(
    ("name", "errors", "remote"),
    [
        ("trc-v10.trc", 1, 1),
        ("trc-v13.trc", 1, 0),
        ("trc-v21.trc", 1, 1),
        ("blf-error-type2.blf", 1, 0),
        ("candump-len8.log", 1, 1),
    ],
)
def test_error_and_remote_frames_are_counted(name: str, errors: int, remote: int) -> None:
    flags = [row[2] for row in sound(CASES / name)]
    assert sum(bool(each & Flag.ERROR) for each in flags) == errors
    assert sum(bool(each & Flag.REMOTE) for each in flags) == remote


@pytest.mark.parametrize(
    ("name", "start"),
    [
        ("asc-absolute.asc", by_clock(datetime(2025, 6, 30, 14, 5), counted=True)),
        ("chinese-date.asc", by_clock(datetime(2025, 6, 30, 14, 5), counted=True)),
        ("rotated-2.asc", by_clock(datetime(2025, 6, 30, 14, 5, 2, 456000), counted=True)),
        ("trc-v10.trc", by_clock(datetime(2025, 6, 30, 14, 5, 0, 682000), counted=True)),
        ("blf-error-type2.blf", by_clock(datetime(2025, 6, 30, 14, 5), counted=False)),
        (
            "candump-screen-date.log",
            by_clock(datetime(2025, 6, 30, 14, 5, 0, 10000), counted=False),
        ),
        ("nohead.asc", None),
        ("candump-len8.log", None),
    ],
)
def test_a_log_says_when_it_began(name: str, start: Start | None) -> None:
    assert read(CASES / name)[1].start == start


def test_what_python_can_writes_is_in_utc(tmp_path: Path) -> None:
    for suffix in (".blf", ".trc"):
        path = write_log(tmp_path / f"bus{suffix}", mixed_frames(5, kinds="classic"))
        start = read(path)[1].start
        assert start is not None
        assert start.is_utc
        assert start.wall == datetime(2023, 11, 14, 22, 13, 20)


@pytest.mark.parametrize(
    ("name", "passed"),
    [
        ("asc-txrq.asc", {"transmit requests": 2}),
        ("comment-gbk.asc", {"comments": 1}),
        ("trc-v21.trc", {"changes of the bus status": 1, "events": 1}),
        ("candump-len8.log", {}),
    ],
)
def test_what_is_no_frame_on_the_bus_is_counted_apart(name: str, passed: dict[str, int]) -> None:
    assert read(CASES / name)[1].passed == Counter(passed)


def test_damage_within_a_blf_log_ends_it_at_once() -> None:
    rows, source = read(CASES / "blf-size-zero.blf")
    assert len(rows) == 1
    assert source.damage is not None
    assert "an object of 0 bytes" in source.damage.problem


@pytest.mark.parametrize("block_size", [1, 7, 1000])
def test_relative_times_count_from_the_line_before(block_size: int) -> None:
    relative, _ = read(CASES / "asc-relative.asc", block_size)
    absolute, _ = read(CASES / "asc-absolute.asc", block_size)
    assert [row[1:] for row in relative] == [row[1:] for row in absolute]
    assert [row[0] for row in relative] == pytest.approx([row[0] for row in absolute], abs=2e-6)


@NEEDS_CAN_UTILS
@pytest.mark.parametrize(
    "name", ["asc-absolute.asc", "asc-relative.asc", "asc-txrq.asc", "rotated-2.asc"]
)
def test_asc_logs_are_read_as_asc2log_reads_them(tmp_path: Path, name: str) -> None:
    path = CASES / name
    rows, theirs = sound(path), by_asc2log(tmp_path, path)
    assert [(row[1], row[5]) for row in rows] == [(row[1], row[5]) for row in theirs]
    start = theirs[0][0] - rows[0][0]
    assert [row[0] + start for row in rows] == pytest.approx([row[0] for row in theirs], abs=2e-6)


@NEEDS_CAN_UTILS
@pytest.mark.parametrize("kinds", ["classic", "classic remote", "fd"])
def test_what_log2asc_writes_is_what_was_in_the_candump_log(tmp_path: Path, kinds: str) -> None:
    log = write_log(tmp_path / "bus.log", mixed_frames(200, kinds=kinds))
    asc = tmp_path / "bus.asc"
    names = ["can0", "can1", "can2"]
    subprocess.run(["log2asc", "-I", log, "-O", asc, *names], check=True, env={"TZ": "UTC"})
    rows, before = sound(asc), sound(log)
    assert [(row[1], f"can{row[3]}", row[5]) for row in rows] == [
        (row[1], row[3], row[5]) for row in before
    ]
    kept = ~(Flag.SENT | Flag.ERROR_STATE)  # log2asc writes no direction for all
    assert [row[2] & kept for row in rows] == [row[2] & kept for row in before]
    gaps = [row[0] - rows[0][0] for row in rows]
    assert gaps == pytest.approx([row[0] - before[0][0] for row in before], abs=2e-4)


def test_times_of_trigger_blocks_go_on(tmp_path: Path) -> None:
    head = "date Mon Jun 30 14:05:00.000 2025\nbase hex  timestamps absolute\n"
    blocks = [
        ("Mon Jun 30 14:05:00.000 2025", "  1.0 1 123 Rx d 1 01\n"),
        ("Mon Jun 30 14:06:00.000 2025", "  60.5 1 123 Rx d 1 02\n"),  # since the measurement began
        ("Mon Jun 30 14:07:00.000 2025", "  0.5 1 123 Rx d 1 03\n"),  # since the block began
        ("Mon Jun 30 14:08:00.000 2025", "  1.5 1 123 Rx d 1 04\n"),
    ]
    text = head + "".join(
        f"Begin Triggerblock {date}\n{line}End TriggerBlock\n" for date, line in blocks
    )
    for block_size in (1, 100):
        rows, source = read(written(tmp_path, text), block_size)
        assert [row[0] for row in rows] == [1.0, 60.5, 120.5, 181.5]
        assert source.start == by_clock(datetime(2025, 6, 30, 14, 5), counted=True)


@pytest.mark.parametrize(
    "date",
    [
        "Mon Jun 30 02:05:01.250 pm 2025",
        "Mon Jun 30 14:05:01.250 2025",
        "Mo Jun 30 14:05:01.250 2025",
        "Lun Juin 30 14:05:01.250 2025",
        "lun. 30 juin 2025 14:05:01.250",
        "Пн июн 30 14:05:01.250 2025",
        "周一 6月 30 14:05:01.250 2025",
        "周一 6月 30 下午 02:05:01.250 2025",
        "30.06.2025 14:05:01.250",
        "2025-06-30 14:05:01.250",
        "06/30/2025 2:05:01.250 PM",
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "utf-8-sig"])
def test_dates_of_any_locale_are_known(tmp_path: Path, date: str, encoding: str) -> None:
    text = f"date {date}\nbase hex  timestamps absolute\n  1.0 1 123x Rx d 2 01 02\n"
    path = tmp_path / "bus.asc"
    path.write_bytes(text.encode(encoding))
    rows, source = read(path)
    assert rows == [(1.0, 0x123, EXT, 0, 2, b"\x01\x02")]
    assert source.start is not None
    assert source.start.wall == datetime(2025, 6, 30, 14, 5, 1, 250000)


@pytest.mark.parametrize(
    ("month", "number"),
    [("Mär", 3), ("Mai", 5), ("Okt", 10), ("Dez", 12), ("févr", 2), ("août", 8), ("3月", 3)],
)
def test_names_of_months_are_known_in_the_encoding_of_their_system(
    tmp_path: Path, month: str, number: int
) -> None:
    encoding = "gbk" if month.endswith("月") else "cp1252"
    path = tmp_path / "bus.asc"
    path.write_bytes(f"date Die {month} 4 14:05:01 2025\n  1.0 1 1 Rx d 0\n".encode(encoding))
    start = read(path)[1].start
    assert start is not None
    assert start.wall == datetime(2025, number, 4, 14, 5, 1)


def test_negative_times_are_before_the_trigger(tmp_path: Path) -> None:
    text = "base hex  timestamps absolute\n -0.25 1 123 Rx d 1 01\n 0.25 1 123 Tx d 1 02\n"
    rows = sound(written(tmp_path, text, "bus.asc"))
    assert [(row[0], row[2]) for row in rows] == [(-0.25, 0), (0.25, Flag.SENT)]


@pytest.mark.parametrize("base", ["hex", "dec"])
@pytest.mark.parametrize("count", [1, 60])
def test_names_stand_for_the_identifier_at_the_end_of_the_line(
    tmp_path: Path, base: str, count: int
) -> None:
    line = "  1.0 1  ACC   Rx   d 2 10 11  Length = 0 BitCount = 0 ID = 419361024x\n"
    text = f"base {base}  timestamps absolute\n" + line * count
    data = b"\x10\x11" if base == "hex" else b"\x0a\x0b"
    rows = sound(written(tmp_path, text, "bus.asc"))
    assert rows == [(1.0, 419361024, EXT, 0, 2, data)] * count
    nameless = text.replace(" ID = 419361024x", "").replace("ACC", "Motor_1")
    assert read(written(tmp_path, nameless, "bus.asc"))[1].damage is not None


@pytest.mark.parametrize(
    ("line", "row"),
    [
        (" (0.5)  can0  123   [2]  01 02", None),
        (
            " (000.500000)  can0  123   [2]  01 02",
            (0.5, 0x123, 0, "can0", 2, b"\1\2"),
        ),
        (" (1.500000)  can0  TX B E  123  [02]  01 02", (1.5, 0x123, 120, "can0", 2, b"\1\2")),
        ("  can0  RX - -  18FEF100   [1]  AA   '.'", (0.0, 0x18FEF100, 1, "can0", 1, b"\xaa")),
        ("  vcan0  123   [3]  remote request", (0.0, 0x123, 2, "vcan0", 3, b"")),
        ("  can0  123   [0]", (0.0, 0x123, 0, "can0", 0, b"")),
        ("  can0  20000004   [2]  00 08   ERRORFRAME", (0.0, 4, 5, "can0", 2, b"\0\x08")),
        ("  can0  123   [2]  01", None),
        ("  can0  1234   [2]  01 02", None),
    ],
)
def test_what_candump_shows_is_read(tmp_path: Path, line: str, row: Row | None) -> None:
    rows, source = read(written(tmp_path, line + "\n", "bus.log"))
    if row is None and "(0.5)" not in line:
        assert rows == []
        assert source.damage is not None
    else:
        assert rows == [row or (0.5, 0x123, 0, "can0", 2, b"\1\2")]


def test_times_from_the_frame_before_are_added_up(tmp_path: Path) -> None:
    times = ["000.000000", "000.500000", "000.100000", "000.300000"]
    text = "".join(f" ({time})  can0  123   [1]  01\n" for time in times)
    assert [row[0] for row in sound(written(tmp_path, text))] == [0.0, 0.5, 0.6, 0.9]


BUSMASTER = """\
***BUSMASTER Ver 3.2.2***
***PROTOCOL CAN***
***[START LOGGING SESSION]***
***START DATE AND TIME 30:6:2025 23:59:58:500***
***HEX***
***{mode} MODE***
***<Time><Tx/Rx><Channel><CAN ID><Type><DLC><DataBytes>***
{times[0]} Rx 1 0x123 s 2 01 02
{times[1]} Tx 2 0x18FEF100 x 1 AA
{times[2]} Rx 1 0x124 sr 3
***END DATE AND TIME 1:7:2025 0:0:2:0***
***[STOP LOGGING SESSION]***
"""


@pytest.mark.parametrize(
    ("mode", "times", "expected"),
    [
        ("SYSTEM", ["23:59:59:0000", "0:0:0:5000", "0:0:1:2500"], [1751327999, 1.5, 2.25]),
        ("ABSOLUTE", ["0:0:1:0000", "0:0:2:5000", "0:0:3:2500"], [1, 1.5, 2.25]),
        ("RELATIVE", ["0:0:1:0000", "0:0:1:5000", "0:0:0:7500"], [1, 1.5, 2.25]),
    ],
)
def test_logs_of_busmaster_are_read(
    tmp_path: Path, mode: str, times: list[str], expected: list[float]
) -> None:
    rows, source = read(written(tmp_path, BUSMASTER.format(mode=mode, times=times)))
    first = expected[0]
    assert [row[0] for row in rows] == [first, first + expected[1], first + expected[2]]
    assert [row[1:] for row in rows] == [
        (0x123, 0, 1, 2, b"\1\2"),
        (0x18FEF100, EXT | Flag.SENT, 2, 1, b"\xaa"),
        (0x124, Flag.REMOTE, 1, 3, b""),
    ]
    assert source.damage is None
    wall = datetime(2025, 6, 30, 23, 59, 58, 500000)
    assert source.start == Start(wall, is_utc=False, counted=mode != "SYSTEM")


def test_older_logs_of_savvycan_have_no_direction(tmp_path: Path) -> None:
    head = "Time Stamp,ID,Extended,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n"
    path = written(tmp_path, head + "166064000,0000021A,false,1,2,FE,36,00,00,00,00,00,00,\n")
    assert sound(path) == [(166.064, 0x21A, 0, 1, 2, b"\xfe\x36")]


def test_savvycan_says_what_was_sent() -> None:
    assert sound(CASES / "savvycan-gvret.csv") == [
        (1.0, 0x1882D0F3, EXT, 0, 8, PAYLOAD),
        (1.1, 0x1882D0F3, EXT, 0, 8, PAYLOAD),
    ]
