"""`swapcan decode`: logs that python-can's own writers made, whole and damaged."""

from __future__ import annotations

import functools
import json
import math
import operator
import random
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cantools
import pytest
from cantools.database.can import Database
from runtime.frames import DRIVE, logged, write

import swapcan
from swapcan.cli import run
from swapcan.messages import MESSAGES

Command = Callable[..., subprocess.CompletedProcess[str]]

SUMMARY = (
    "swapcan: frames 8, decoded 4, unknown 2 (identifiers 2),"
    " faults 4 (length 1, checksum 1, counter 2)\n"
)
ST1 = "  bms=HV closed  acc_relay=Open  balance=No Balancing  chg_line=Not connected"
LINES = [
    "B2V_ST2         soc=80 %  soh=100 %  current=-120.5 A  max_lmt_chg_curr=Signal Invalid",
    f"B2V_ST1         checksum=32  aliv=0{ST1}",
    "B2V_ST1         ! checksum is 0x00, the bytes make 0x21",
    "B2V_ST2         ! 7 bytes instead of 8",
    f"B2V_ST1         checksum=32  aliv=0{ST1}",
    f"B2V_ST1         checksum=47  aliv=Signal Invalid{ST1}",
]
ENDINGS = [
    "  max_lmt_dis_chg_curr=300.5 A",
    "  gbt32960_flt_num=0",
    "",
    "",
    "  gbt32960_flt_num=0  ! counter stays at 0",
    "  gbt32960_flt_num=0  ! counter is Signal Invalid, it runs 0 to 14",
]


@pytest.mark.parametrize("suffix", ["asc", "blf", "csv", "db", "log", "trc", "asc.gz"])
def test_a_log_in_any_format_decodes_to_the_same_lines(
    suffix: str, tmp_path: Path, swapcan_command: Command
) -> None:
    done = swapcan_command("decode", str(write(tmp_path / f"drive.{suffix}", DRIVE)))
    assert (done.returncode, done.stderr) == (0, SUMMARY)
    lines = done.stdout.splitlines()
    sent = [frame for frame in DRIVE if frame.arbitration_id in (0x1882D0F3, 0x1881D0F3)]
    for line, start, end, frame in zip(lines, LINES, ENDINGS, sent, strict=True):
        _, _, direction, number, data, rest = line.split(maxsplit=5)
        assert (direction, number) == ("Rx", f"{frame.arbitration_id:08X}")
        assert bytes.fromhex(data) == frame.data
        assert rest.startswith(start)
        assert line.endswith(end)


@pytest.mark.parametrize(
    ("suffix", "start", "channel"),
    [("log", 1.7e9, "can0"), ("csv", 1.7e9, "-"), ("blf", 1.7e9, "0"), ("asc", 0.0, "0")],
)
def test_a_line_starts_with_time_and_channel_as_the_log_has_them(
    suffix: str, start: float, channel: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["decode", str(write(tmp_path / f"drive.{suffix}", DRIVE))]) == 0
    heads = [line.split(maxsplit=2)[:2] for line in capsys.readouterr().out.splitlines()]
    assert {head[1] for head in heads} == {channel}
    assert [float(head[0]) - start for head in heads] == pytest.approx(
        [0, 0.1, 0.2, 0.3, 0.6, 0.7], abs=1e-5
    )


def json_lines(path: Path, capsys: pytest.CaptureFixture[str]) -> list[dict[str, Any]]:
    assert run(["decode", str(path), "--json"]) == 0
    return [json.loads(line) for line in capsys.readouterr().out.splitlines()]


def test_json_has_one_object_a_line_with_numbers_states_labels_and_faults(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, closed, checksum, length, repeated, invalid = json_lines(
        write(tmp_path / "drive.csv", DRIVE), capsys
    )
    assert status == {
        "timestamp": 1_700_000_000.0,
        "channel": None,
        "id": 0x1882D0F3,
        "message": "B2V_ST2",
        "signals": {
            "B2V_ST2_SOC": 80.0,
            "B2V_ST2_SOH": 100.0,
            "B2V_ST2_Current": -120.5,
            "B2V_ST2_MaxLmt_ChgCurr": None,
            "B2V_ST2_MaxLmt_DisChgCurr": 300.5,
        },
        "states": {"B2V_ST2_MaxLmt_ChgCurr": "Signal Invalid"},
        "faults": [],
    }
    assert closed["signals"]["B2V_ST1_BMS"] == {"value": 2, "label": "HV closed"}
    assert closed["signals"]["B2V_ST1_ALIV"] == 0
    assert checksum == {
        "timestamp": 1_700_000_000.2,
        "channel": None,
        "id": 0x1881D0F3,
        "message": "B2V_ST1",
        "data": "0021000000000000",
        "fault": {"kind": "checksum", "text": "checksum is 0x00, the bytes make 0x21"},
    }
    assert length["fault"] == {"kind": "length", "text": "7 bytes instead of 8"}
    assert repeated["faults"] == [{"kind": "counter", "text": "counter stays at 0"}]
    assert invalid["signals"]["B2V_ST1_ALIV"] is None
    assert invalid["states"] == {"B2V_ST1_ALIV": "Signal Invalid"}


def valid_payloads(source: random.Random) -> list[tuple[int, bytes]]:
    """Random payloads of all messages, with the checksum where the DBC says that there is one."""
    payloads = []
    for kind in [kind for kind in MESSAGES for _ in range(8)]:
        data = bytearray(source.randbytes(8))
        if kind.CHECKSUM and kind.CHECKSUM.algorithm == "xor":
            data[0] = functools.reduce(operator.xor, data[1:])
        payloads.append((kind.FRAME_ID, bytes(data)))
    return payloads


def test_json_says_of_every_signal_what_cantools_says(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    database = cantools.database.load_string(swapcan.dbc_text(), "dbc")
    assert isinstance(database, Database)
    payloads = valid_payloads(random.Random(7))
    frames = [logged(i, identifier, data.hex()) for i, (identifier, data) in enumerate(payloads)]
    lines = json_lines(write(tmp_path / "drive.csv", frames), capsys)
    for line, (identifier, data) in zip(lines, payloads, strict=True):
        message = database.get_message_by_frame_id(identifier)
        raw = message.decode(data, decode_choices=False, scaling=False)
        physical = message.decode(data, decode_choices=False)
        assert isinstance(raw, dict)
        assert isinstance(physical, dict)
        assert line["message"] == message.name
        assert list(line["signals"]) == [signal.name for signal in message.signals]
        for signal in message.signals:
            value = line["signals"][signal.name]
            code = raw[signal.name]
            assert isinstance(code, int)
            labels = {key: str(choice) for key, choice in (signal.choices or {}).items()}
            label = labels.get(code)
            if isinstance(value, dict):
                assert value == {"value": code, "label": label}
            elif isinstance(value, str):
                assert (value, ord(value)) == (label, code)
            elif value is None:
                assert line["states"][signal.name] == label
            else:
                expected = physical[signal.name]
                assert isinstance(expected, int | float)
                assert math.isclose(value, expected, abs_tol=1e-9)


def test_a_value_in_json_has_no_digits_of_binary_arithmetic(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = write(tmp_path / "drive.csv", [logged(0, 0x1883D0F3, "0100 0200 0300 0700")])
    (line,) = json_lines(log, capsys)  # 3 x 0.1 and 7 x 0.1 are not 0.3 and 0.7
    assert list(line["signals"].values()) == [1.0, 2.0, 0.3, 0.7]


def test_an_error_frame_is_unknown_and_has_no_identifier(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    frames = [logged(0, 0, "", is_error_frame=True), logged(1, 0x18FEF100, "00")]
    assert run(["decode", str(write(tmp_path / "drive.asc", frames))]) == 0
    assert "unknown 2 (identifiers 1)" in capsys.readouterr().err


def test_counters_of_two_channels_do_not_mix(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "".join(
        f"({1.0 + number}) can{number % 2} 1881D0F3#{counter:02X}{counter:02X}000000000000\n"
        for number, counter in enumerate((3, 9, 4, 10))
    )
    path = tmp_path / "two.log"
    path.write_text(text)
    assert run(["decode", str(path)]) == 0
    assert "faults 0" in capsys.readouterr().err


def test_a_time_that_is_no_number_is_damage_as_for_every_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "drive.csv"
    header = "timestamp,arbitration_id,extended,remote,error,dlc,data\n"
    path.write_text(f"{header}nan,0x18fff8a7,1,0,0,8,AAAAAAAAAAA=\n")
    assert run(["decode", str(path), "--json"]) == 2
    out, errors = capsys.readouterr()
    assert not out
    assert "damaged at line 2: " in errors


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_an_output_that_cannot_be_written_is_one_line(
    tmp_path: Path, environment: dict[str, str]
) -> None:
    path = write(tmp_path / "drive.csv", DRIVE)
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [*python(), "decode", str(path)],
            env=environment,
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 2
    assert done.stderr.splitlines()[-1].startswith("swapcan: cannot write the output: ")
    assert "Traceback" not in done.stderr


def python() -> list[str]:
    return [sys.executable, "-m", "swapcan"]


def test_a_closed_pipe_is_quiet(tmp_path: Path, environment: dict[str, str]) -> None:
    path = write(tmp_path / "drive.csv", DRIVE * 500)
    process = subprocess.Popen(
        [*python(), "decode", str(path)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )
    assert process.stdout
    assert process.stderr
    process.stdout.readline()
    process.stdout.close()
    assert process.stderr.read() == "swapcan: nobody reads the output any more\n"
    process.stderr.close()
    assert process.wait(timeout=10) == 2
