"""`swapcan convert` from the command line: output, summary, exit status."""

from __future__ import annotations

import errno
import json
import os
import signal
from pathlib import Path
from typing import Any

import can
import cantools
import pyarrow.parquet as pq
import pytest
from cantools.database.can import Database
from logs.log_files import NEEDS_ASAMMDF
from logs.table_logs import START, traffic, write_frames

import swapcan
from swapcan import cli
from swapcan.logs import tables
from swapcan.messages import B2V_ST1, B2V_ST2, MESSAGES
from typedcan.commands import log_options
from typedcan.logs.pipeline import Layout, Options
from typedcan.logs.plan import Mode
from typedcan.logs.progress import Progress
from typedcan.logs.raster import raster_step

_DBC = Path(__file__).parents[2] / "dbc" / "caamtb-swap.dbc"
_OTHER = Path(__file__).parents[1] / "fixtures" / "dbc" / "motorola.dbc"


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_frames(tmp_path_factory.mktemp("command") / "drive.blf", traffic(8))


def _run(*arguments: object) -> int:
    return cli.run(["convert", *map(str, arguments)])


def _json(capsys: pytest.CaptureFixture[str]) -> Any:
    return json.loads(capsys.readouterr().out)


def test_several_messages_become_a_folder_named_like_the_output(
    log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(log, "-o", tmp_path / "drive.parquet") == 0
    names = {path.name for path in (tmp_path / "drive").iterdir()}
    assert names == {f"{message.NAME}.parquet" for message in MESSAGES}
    said = capsys.readouterr()
    assert not said.out
    frames = len(traffic(8))
    assert f"{frames:,} frames" in said.err
    assert f"wrote {tmp_path / 'drive'}, tables: 25" in said.err


def test_one_message_becomes_one_file(log: Path, tmp_path: Path) -> None:
    assert _run(log, "-o", tmp_path / "x.parquet", "--messages", "B2V_ST2") == 0
    assert pq.read_table(tmp_path / "x.parquet").num_rows == 80


@pytest.mark.parametrize(
    ("arguments", "options"),
    [
        (["--raw"], {"mode": "RAW"}),
        (["--labels"], {"mode": "LABELS"}),
        (["--long"], {"layout": Layout.LONG}),
        (["--raster", "50ms"], {"layout": Layout.RASTER, "step": "50ms"}),
        (["--signals", "SOC,SOH", "--signals", "Current"], {"signals": ("SOC", "SOH", "Current")}),
        (["--dbc", str(_DBC)], {}),
    ],
)
def test_each_option_does_what_it_does_from_python(
    log: Path, tmp_path: Path, arguments: list[str], options: dict[str, Any]
) -> None:
    if "mode" in options:
        options["mode"] = Mode[options["mode"]]
    if "step" in options:
        options["step"] = raster_step(options["step"])
    assert _run(log, "-o", tmp_path / "x.parquet", "--messages", "B2V_ST2,V2B_CMD", *arguments) == 0
    expected = tables(log, options=Options(messages=("B2V_ST2", "V2B_CMD"), **options))
    single = tmp_path / "x.parquet"
    files = [single] if single.exists() else sorted((tmp_path / "x").iterdir())
    found = [pq.read_table(path).to_pydict() for path in files]
    assert found == [expected[name].to_pydict() for name in sorted(expected)]


def test_the_summary_as_json_counts_everything(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    st1 = [bytearray(swapcan.encode(B2V_ST1(), counter=n)) for n in (0, 1, 5, 6)]
    st1[1][0] ^= 1  # wrong checksum, and so the counter goes from 0 to 5
    frames = [
        can.Message(START + n / 10, B2V_ST1.FRAME_ID, data=data) for n, data in enumerate(st1)
    ]
    frames += [
        can.Message(START + 0.4, 0x123, is_extended_id=False, data=b"\1"),
        can.Message(START + 0.5, 0x18FFFFFF, data=b"\1"),
        can.Message(START + 0.6, 0x18FFFFFF, data=b"\1"),
        can.Message(START + 0.7, B2V_ST2.FRAME_ID, data=bytes(7)),
        can.Message(START + 2.0, B2V_ST2.FRAME_ID, data=bytes(8)),
        can.Message(START + 2.1, B2V_ST1.FRAME_ID, is_remote_frame=True, dlc=8),
    ]
    log = write_frames(tmp_path / "x.log", frames)
    assert _run(log, "-o", tmp_path / "out", "--json") == 0
    found = _json(capsys)
    assert found["frames"] == len(frames)
    assert found["decoded"] == {"B2V_ST1": 3, "B2V_ST2": 1}
    assert found["rows"] == found["decoded"]
    assert found["unknown"] == {"0x123": 1, "0x18FFFFFF": 2}
    assert found["remote"] == 1
    assert found["wrong_checksum"] == {"B2V_ST1": 1}
    assert found["wrong_counter"] == {"B2V_ST1": 1}
    assert found["wrong_length"] == {"B2V_ST2": 1}
    assert found["gaps"].keys() == {"B2V_ST1"}
    assert found["gaps"]["B2V_ST1"]["longest"] == pytest.approx(1.7)
    assert found["seconds"] == pytest.approx(2.1)
    assert found["damage"] == []


def test_the_summary_says_all_of_it_to_people(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = bytearray(swapcan.encode(B2V_ST1(), counter=0))
    wrong[0] ^= 1
    frames = [
        can.Message(START, B2V_ST1.FRAME_ID, data=wrong),
        can.Message(START + 1, 0x18FFFFFF, data=b"\1"),
        can.Message(START + 2, B2V_ST2.FRAME_ID, data=bytes(8)),
        can.Message(START + 5, B2V_ST2.FRAME_ID, data=bytes(8)),
    ]
    _run(write_frames(tmp_path / "x.log", frames), "-o", tmp_path / "out")
    said = capsys.readouterr().err
    for text in (
        "4 frames in 5.0 s, 2 decoded",
        "unknown identifiers: 0x18FFFFFF 1",
        "wrong checksum: B2V_ST1 1",
        "gaps: B2V_ST2 1, the longest 3 s",
    ):
        assert text in said


@pytest.mark.parametrize("jobs", [1, 2])
def test_several_logs_become_one_output_in_their_order(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], jobs: int
) -> None:
    logs = [write_frames(tmp_path / f"{n}.log", traffic(1 + n, START + 100 * n)) for n in range(4)]
    arguments = ("-o", tmp_path / "x.parquet", "--messages", "B2V_ST2", "--json")
    assert _run(*logs, *arguments, "--jobs", jobs) == 0
    found = _json(capsys)
    times: Any = pq.read_table(tmp_path / "x.parquet").column("timestamp").to_pylist()
    assert times == tables(*logs)["B2V_ST2"].column("timestamp").to_pylist()
    assert times == sorted(times)
    assert found["logs"] == 4
    assert found["rows"] == {"B2V_ST2": len(times)}
    assert found["gaps"] == {}  # what is between two logs is none


def test_a_damaged_log_is_converted_up_to_the_damage_and_the_exit_status_is_3(
    log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    broken = write_frames(tmp_path / "broken.log", traffic(2, START - 10))
    expected = tables(broken)["B2V_ST2"].num_rows
    with broken.open("ab") as file:
        file.write(b"(nonsense\n")
    arguments = ("-o", tmp_path / "x.parquet", "--messages", "B2V_ST2", "--json")
    assert _run(broken, log, *arguments, "--jobs", 1) == 3
    said = capsys.readouterr()
    (damage,) = json.loads(said.out)["damage"]
    assert damage["path"] == str(broken)
    assert "broken.log: damaged at line" in said.err
    assert pq.read_table(tmp_path / "x.parquet").num_rows == expected + 80


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["--from", "yesterday"], "expected seconds or a date"),
        (["--raster", "soon"], "expected a raster"),
        (["--messages", "B2V_ST9"], "no message 'B2V_ST9'"),
        (["--signals", "SOX"], "no signal 'SOX'"),
        (["--dbc", "none.dbc"], "none.dbc"),
        (["--jobs", "0"], "--jobs"),
        (["--raw", "--labels"], "--labels"),
        (["--long", "--raster", "1s"], "--raster"),
    ],
)
def test_a_wrong_option_is_said_in_one_line(
    log: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    text: str,
) -> None:
    assert _run(log, "-o", tmp_path / "x.parquet", *arguments) == 2
    said = capsys.readouterr()
    assert text in said.err
    assert said.err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_log_that_is_missing_is_said_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(tmp_path / "none.blf", "-o", tmp_path / "x.parquet") == 2
    assert capsys.readouterr().err.endswith(f"none.blf: {os.strerror(errno.ENOENT)}\n")


def test_output_that_exists_is_kept_unless_forced(
    log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "x.csv"
    output.write_text("mine")
    arguments = (log, "-o", output, "--messages", "B2V_ST2")
    assert _run(*arguments) == 2
    assert "--force" in capsys.readouterr().err
    assert output.read_text() == "mine"
    assert _run(*arguments, "--force") == 0
    assert output.read_text() != "mine"


@pytest.mark.parametrize(
    ("output", "jobs"),
    [
        ("x.parquet", 1),
        pytest.param("x.mf4", 1, marks=NEEDS_ASAMMDF),
        ("x.csv", 1),
        ("x.parquet", 2),
    ],
)
def test_ctrl_c_leaves_nothing_half_written(
    log: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, jobs: int, output: str
) -> None:
    def interrupt(progress: Progress, position: int, frames: int) -> None:
        signal.raise_signal(signal.SIGINT)

    later = write_frames(tmp_path / "later.blf", traffic(60, START + 1000))
    monkeypatch.setattr(Progress, "update", interrupt)
    assert _run(log, later, "-o", tmp_path / output, "--jobs", jobs) == 130
    assert list(tmp_path.iterdir()) == [later]


def test_a_dbc_of_somebody_elses_is_decoded_too(tmp_path: Path) -> None:
    database = cantools.database.load_file(_OTHER)
    assert isinstance(database, Database)
    message = database.messages[0]
    data = bytes(range(1, message.length + 1))
    frame = can.Message(
        START, message.frame_id, is_extended_id=message.is_extended_frame, data=data
    )
    log = write_frames(tmp_path / "x.log", [frame])
    arguments = ("-o", tmp_path / "x.parquet", "--dbc", _OTHER, "--messages", message.name)
    assert _run(log, *arguments) == 0
    table = pq.read_table(tmp_path / "x.parquet")
    (row,) = table.drop_columns(["timestamp", "channel"]).to_pylist()
    assert row == message.decode(data, decode_choices=False)
    assert table.schema.metadata[b"protocol"] == b"motorola"


def test_the_help_tells_where_tables_go_and_what_the_exit_status_means(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert _run("--help") == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "a folder, OUT without its suffix" in said
    assert "3 a log is damaged" in said


@pytest.mark.parametrize("package", ["numpy", "pyarrow"])
def test_a_missing_extra_is_named(
    log: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    package: str,
) -> None:
    monkeypatch.setattr(log_options, "find_spec", lambda name: None if name == package else name)
    assert _run(log, "-o", tmp_path / "x.parquet") == 2
    assert f"needs {package}: pip install 'swapcan[logs]'" in capsys.readouterr().err
