"""`swapcan convert --dbc`: databases of any encoding, sound or not, are read as elsewhere."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import swapcan
from swapcan import cli
from swapcan.logs import Mode, Options, tables
from swapcan.messages import B2V_ST2, BMS_TMS_0

ROOT = Path(__file__).parents[2]
CASES = ROOT / "tests" / "fixtures" / "logs"


def candump(path: Path, *frames: str) -> Path:
    """A log of frames as candump writes them, a second apart."""
    lines = [f"({at}.000000) can0 {frame}\n" for at, frame in enumerate(frames)]
    path.write_text("".join(lines), "ascii")
    return path


def standard_log(folder: Path) -> Path:
    """A log of two messages of the standard."""
    sent = (BMS_TMS_0(hv_rly_sts=1, reqst_tms_hv_on=1), B2V_ST2(soc=50.0))
    frames = [f"{each.FRAME_ID:08X}#{swapcan.encode(each).hex()}" for each in sent]
    return candump(folder / "standard.log", *frames)


def metadata(table: Any, column: str) -> dict[str, str]:
    return {key.decode(): text.decode() for key, text in table.field(column).metadata.items()}


@pytest.mark.parametrize("database", ["pack_gbk.dbc", "pack_utf8.dbc"])
def test_units_and_labels_are_read_in_the_encoding_of_the_database(database: str) -> None:
    options = Options(dbc=CASES / database, mode=Mode.LABELS)
    found = tables(CASES / "pack.log", options=options)["Pack"]
    assert metadata(found, "Temp")["unit"] == "℃"
    assert metadata(found, "Insul")["unit"] == "kΩ"
    assert found["Temp"].to_pylist() == [80, 81]
    assert found["Mode"].to_pylist() == ["充电", "放电"]
    assert found["Curr"].to_pylist() == [pytest.approx(-10.0), pytest.approx(1.0)]


def test_a_western_degree_sign_is_one(tmp_path: Path) -> None:
    log = candump(tmp_path / "log.log", "18FF0100#50")
    database = tmp_path / "degree.dbc"
    text = 'VERSION ""\nBS_:\nBU_: A\nBO_ 2566848768 M: 1 A\n SG_ T : 0|8@1+ (1,-40) [0|0] "°C" A\n'
    database.write_bytes(text.encode("cp1252"))
    assert metadata(tables(log, options=Options(dbc=database))["M"], "T")["unit"] == "°C"


def test_the_unit_of_a_database_in_utf_8_is_not_garbled(tmp_path: Path) -> None:
    log = candump(tmp_path / "log.log", "18FEF000#5000000000000000")
    found = tables(log, options=Options(dbc=CASES / "degree_sign.dbc"))
    assert metadata(found["M"], "Temp")["unit"] == "°C"


@pytest.mark.parametrize("database", ["caamtb-swap.zh.dbc", "caamtb-swap.zh-utf8.dbc"])
def test_the_chinese_databases_of_the_standard_give_chinese_labels(
    database: str, tmp_path: Path
) -> None:
    log = standard_log(tmp_path)
    options = Options(dbc=ROOT / "dbc" / database, mode=Mode.LABELS)
    chinese = tables(log, options=options)
    english = tables(log, options=Options(mode=Mode.LABELS))
    assert english["BMS_TMS_0"]["BMS_HVRlySts"].to_pylist() == ["Closed"]
    assert chinese["BMS_TMS_0"]["BMS_HVRlySts"].to_pylist() == ["闭合"]


def test_what_else_is_known_of_the_standard_counts_with_its_chinese_database_too(
    tmp_path: Path,
) -> None:
    log = standard_log(tmp_path)
    own, chinese = (
        tables(log, options=Options(dbc=database))["B2V_ST2"]
        for database in (None, ROOT / "dbc" / "caamtb-swap.zh.dbc")
    )
    assert "B2V_ST2_SOC.state" in own.column_names
    assert chinese.to_pydict() == own.to_pydict()
    assert chinese.schema.metadata == own.schema.metadata
    assert metadata(chinese, "B2V_ST2_SOC") == metadata(own, "B2V_ST2_SOC")


def test_identifiers_of_11_and_29_bits_are_told_apart(tmp_path: Path) -> None:
    log = candump(tmp_path / "log.log", "100#01", "00000100#02", "100#03")
    found = tables(log, options=Options(dbc=CASES / "one_number_twice.dbc"))
    assert found["SHORTID"]["Left"].to_pylist() == [1, 3]
    assert found["LONGID"]["Right"].to_pylist() == [2]


def test_a_message_of_29_bits_is_no_message_of_11(tmp_path: Path) -> None:
    log = candump(tmp_path / "log.log", "100#0A00000000000000", "00000100#0A00000000000000")
    found = tables(log, options=Options(dbc=CASES / "two_widths.dbc"))
    assert {name: table.num_rows for name, table in found.items()} == {"STD": 1}
    assert found["STD"]["A"].to_pylist() == [1.0]


def test_codes_of_a_signal_that_is_gone_keep_nobody_from_converting(tmp_path: Path) -> None:
    log = candump(tmp_path / "log.log", "100#0700")
    found = tables(log, options=Options(dbc=CASES / "codes_of_no_signal.dbc"))
    assert found["M1"]["P"].to_pylist() == [7]


def test_of_two_messages_with_one_identifier_the_later_counts_and_that_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = candump(tmp_path / "log.log", "100#0700", "101#0800")
    database = CASES / "same_identifier.dbc"
    output = tmp_path / "out"
    assert cli.run(["convert", str(log), "-o", str(output), "--dbc", str(database), "--json"]) == 0
    assert {path.name for path in output.iterdir()} == {"M2.parquet", "M3.parquet"}
    said = capsys.readouterr()
    assert json.loads(said.out)["hidden"] == {"M1": "M2"}
    assert said.err.count("M1") == 1


@pytest.mark.parametrize("database", ["too_many_bits.dbc", "endless_period.dbc", "nowhere.dbc"])
def test_a_database_that_cannot_be_used_is_refused_in_one_line(
    database: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = candump(tmp_path / "log.log", "100#07")
    output = tmp_path / "out.parquet"
    arguments = ["convert", str(log), "-o", str(output), "--dbc", str(CASES / database)]
    assert cli.run(arguments) == 2
    said = capsys.readouterr()
    assert said.err.count("\n") == 1
    assert database in said.err
    assert not output.exists()


def test_other_formats_are_read_too(tmp_path: Path) -> None:
    database = ROOT / "tests" / "fixtures" / "other" / "cabin.kcd"
    log = candump(tmp_path / "log.log", "010#0128")
    found = tables(log, options=Options(dbc=database, mode=Mode.LABELS))["DoorState"]
    assert found["Open"].to_pylist() == ["Open"]
    assert found["Angle"].to_pylist() == [10.0]
