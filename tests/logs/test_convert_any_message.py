"""Databases with odd messages in `convert --dbc`: what is there is there, and the rest is told."""

from __future__ import annotations

import json
import logging
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from swapcan import cli
from swapcan.logs import Options, tables

CASES = Path(__file__).parents[1] / "fixtures" / "cases"


_NAMES = """VERSION ""

BS_:

BU_: A

BO_ 256 M1: 1 A
 SG_ P : 0|4@1+ (1,0) [0|15] "" A
 SG_ P : 4|4@1+ (1,0) [0|15] "" A

BO_ 257 M1: 1 A
 SG_ R : 0|8@1+ (1,0) [0|255] "" A
"""


def _log(folder: Path, *frames: str) -> Path:
    path = folder / "log.log"
    path.write_text("".join(f"({at}.000000) can0 {each}\n" for at, each in enumerate(frames)))
    return path


def _signals(table: Any) -> dict[str, list[Any]]:
    columns: dict[str, list[Any]] = table.drop_columns(["timestamp", "channel"]).to_pydict()
    return columns


@pytest.mark.parametrize(
    ("case", "frames", "expected"),
    [
        (
            "mux",
            ["100#000DB60000000000", "100#01FE070000000000", "100#0F11223344556677"],
            {
                "Sel": [0, 1, 15],
                "X": [4660.5, None, None],
                "Y": [None, -2, None],
                "Z": [None, 7, None],
            },
        ),
        ("overlap", ["100#0102000005000000"], {"Group": [0x0201], "Part1": [1], "Other": [5]}),
        ("outside", ["100#07FF"], {"P": [7]}),
        ("unusedval", ["100#0700"], {"P": [7]}),
        ("dup", ["100#0709"], {"Q": [7]}),
        ("channel", ["100#0708"], {"channel_2": [7], "timestamp_2": [8]}),
        ("zero", ["100#0708000000000000"], {"Pxx": [7], "Qxx": [8]}),
        ("wide", ["100#ff00000000000080"], {"Serial": [0x80000000000000FF]}),
        ("wide", ["101#ffffffffffffff07"], {"Time": [(1 << 56) - 1], "Kind": [7]}),
        ("fdlen", [f"100##1{'01' * 64}", "100##101020304"], {"Pos": [0x01010101]}),
        ("enumname", ["101#", "101#R", "101#"], {}),
    ],
)
def test_what_can_be_decoded_is_in_the_table(
    case: str, frames: list[str], expected: dict[str, list[Any]], tmp_path: Path
) -> None:
    log = _log(tmp_path, *frames)
    (table,) = tables(log, options=Options(dbc=CASES / f"{case}.dbc")).values()
    assert _signals(table) == expected
    assert table.num_rows == len(next(iter(expected.values()), [0, 1]))


@pytest.mark.parametrize(
    ("case", "frames", "said"),
    [
        ("mux", ["100#0F11223344556677"], "selector without a branch: MUX 1"),
        ("dup", ["100#0709"], "M1 has the identifier of M2"),
        ("channel", ["100#0708"], "M.timestamp is in the column timestamp_2"),
        ("fdlen", ["100##101020304"], "wrong length: LONGMSG 1"),
    ],
)
def test_what_is_not_as_one_might_think_is_told(
    case: str,
    frames: list[str],
    said: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    log, out = _log(tmp_path, *frames), tmp_path / "out.parquet"
    arguments = ["convert", str(log), "--dbc", str(CASES / f"{case}.dbc"), "-o", str(out)]
    assert cli.run(arguments) == 0
    shown = capsys.readouterr()
    assert said in shown.out + shown.err


@pytest.mark.parametrize("command", ["decode", "convert"])
def test_two_of_one_name_are_told_by_both_decoders(
    command: str, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "names.dbc").write_text(_NAMES)
    log = _log(tmp_path, "100#07", "101#09")
    output = ["-o", str(tmp_path / "out")] if command == "convert" else []
    with caplog.at_level(logging.WARNING, "typedcan"):
        assert cli.run([command, str(log), "--dbc", str(tmp_path / "names.dbc"), *output]) == 0
    told = "names: M1: a second signal P is called P_2; a second message M1 is called M1_2"
    assert told in [each.getMessage() for each in caplog.records]
    if output:
        table = pq.read_table(tmp_path / "out" / "M1.parquet")
        assert _signals(table) == {"P": [7], "P_2": [0]}


_FORMATS = """VERSION ""

BS_:

BU_: A

BO_ 256 Short: 4 A
 SG_ P : 0|8@1+ (1,0) [0|255] "" A

BO_ 257 Empty: 0 A

BO_ 258 Long: 12 A
 SG_ Q : 88|8@1+ (1,0) [0|255] "" A
 SG_ Q : 80|8@1+ (1,0) [0|255] "" A

BA_DEF_ BO_ "VFrameFormat" ENUM "StandardCAN","StandardCAN_FD";
BA_DEF_DEF_ "VFrameFormat" "StandardCAN";
BA_ "VFrameFormat" BO_ 258 1;
"""


def test_both_decoders_refuse_and_doubt_the_same_frames(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "formats.dbc").write_text(_FORMATS)
    twelve = "0102030405060708090A0B0C"
    log = _log(
        tmp_path,
        *("100#01020304", "100#0102030405", "100#010203", "100##101020304", "100#0102030405060708"),
        *("101#", "101#01"),
        *(f"102##1{twelve}", "102#0102030405060708", f"102##1{twelve}0D0E0F10"),
    )
    database = ["--dbc", str(tmp_path / "formats.dbc")]
    assert cli.run(["decode", str(log), *database]) == 0
    told = capsys.readouterr()
    assert "faults 7 (length 6, checksum 0, counter 0, format 1)" in told.err
    assert "! came in a CAN FD frame" in told.out
    out = ["-o", str(tmp_path / "out"), "--json"]
    assert cli.run(["convert", str(log), *database, *out]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["wrong_length"] == {"Short": 3, "Empty": 1, "Long": 2}
    assert found["wrong_format"] == {"Short": 1}
    assert found["rows"] == {"Short": 2, "Empty": 1, "Long": 1}
    assert pq.read_table(tmp_path / "out" / "Long.parquet").column("Q_2").to_pylist() == [11]
    out = ["-o", str(tmp_path / "all"), "--keep-faulty"]
    assert cli.run(["convert", str(log), *database, *out]) == 0
    assert "in frames of another format: Short 1" in capsys.readouterr().err
    assert pq.read_table(tmp_path / "all" / "Short.parquet").num_rows == 4  # not that of 3 bytes


def test_the_columns_that_have_other_names_and_the_rest_are_there_for_programs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log, out = _log(tmp_path, "100#0708"), tmp_path / "out.parquet"
    arguments = ["convert", str(log), "--dbc", str(CASES / "channel.dbc"), "-o", str(out), "--json"]
    assert cli.run(arguments) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["renamed"] == {"M.channel": "channel_2", "M.timestamp": "timestamp_2"}
    assert summary["without_branch"] == {}
    table = pq.read_table(out)
    assert table.column_names == ["timestamp", "channel", "channel_2", "timestamp_2"]
    assert table["timestamp"].to_pylist() == [0.0]
    assert table["channel"].to_pylist() == ["can0"]
    metadata = table.schema.field("channel_2").metadata or {}
    assert metadata[b"signal"] == b"channel"


def test_a_signal_called_like_the_source_address_of_a_frame_gets_another_column(
    tmp_path: Path,
) -> None:
    text = (CASES / "j1939-truck.dbc").read_text().replace("WheelBasedVehicleSpeed", "priority")
    (tmp_path / "truck.dbc").write_text(text)
    log = _log(tmp_path, "18FEF117#FF0008FFFFFFFFFF")
    (table,) = tables(log, options=Options(dbc=tmp_path / "truck.dbc")).values()
    assert table["priority"].to_pylist() == [6]
    assert table["priority_2"].to_pylist() == [8.0]


def test_a_raster_has_its_times_and_the_signal_of_that_name(tmp_path: Path) -> None:
    log, out = _log(tmp_path, "100#0708", "100#090A"), tmp_path / "raster.csv"
    arguments = ["convert", str(log), "--dbc", str(CASES / "channel.dbc"), "-o", str(out)]
    assert cli.run([*arguments, "--raster", "1s"]) == 0
    lines = out.read_text().splitlines()
    assert lines == ['"timestamp","channel","M.timestamp"', "0,7,8", "1,9,10"]


def test_a_signal_of_a_renamed_column_is_asked_for_by_its_own_name(tmp_path: Path) -> None:
    log = _log(tmp_path, "100#0708")
    options = Options(dbc=CASES / "channel.dbc", signals=("timestamp",))
    (table,) = tables(log, options=options).values()
    assert _signals(table) == {"timestamp_2": [8]}


def test_two_signals_or_messages_of_one_name_have_a_column_and_a_table_each(tmp_path: Path) -> None:
    database = tmp_path / "same.dbc"
    lines = ('VERSION ""', "NS_ :", "BS_:", "BU_: A", "BO_ 256 Same: 2 A")
    signals = (f' SG_ Level : {start}|8@1+ (1,0) [0|0] "" A' for start in (0, 8, 0))
    first, second, other = signals
    database.write_text("\n".join((*lines, first, second, "BO_ 257 Same: 1 A", other, "")))
    found = tables(_log(tmp_path, "100#0102", "101#03"), options=Options(dbc=database))
    assert {name: _signals(table) for name, table in found.items()} == {
        "Same": {"Level": [1], "Level_2": [2]},
        "Same_2": {"Level": [3]},
    }


def test_what_is_odd_in_a_database_is_one_warning(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        tables(_log(tmp_path, "100#0708"), options=Options(dbc=_copied(tmp_path, "outside")))
    said = [each.message for each in caplog.records if each.name.startswith("typedcan")]
    assert said == ["outside: SHORT.Q is left out: it lies outside of the 2 bytes of SHORT"]


def _copied(folder: Path, case: str) -> Path:
    """A database that was not read before, as those that were say nothing again."""
    path = folder / f"{case}.dbc"
    path.write_bytes((CASES / path.name).read_bytes())
    return path
