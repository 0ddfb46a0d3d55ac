"""A supplier's DBC becomes a first edition: what differs and nothing else, as cantools reads it."""

from __future__ import annotations

from pathlib import Path

import cantools
import pytest
from generator.command import dbcspec
from generator.small_spec import FILES, edited, write_project

from dbcspec.spec.compiled import Compiled, compile_spec
from typedcan.model.protocol import Protocol, SendType

SUPPLIER = """\
VERSION ""

NS_ :

BS_:

BU_: Oven Display

BO_ 2566848800 OvenState: 8 Oven
 SG_ OvenSum : 0|8@1+ (1,0) [0|255] "bit"  Display
 SG_ OvenLife : 8|4@1+ (1,0) [0|15] "bit"  Display
 SG_ OvenMode : 12|2@1+ (1,0) [0|3] "bit"  Display
 SG_ OvenLid : 14|2@1+ (1,0) [0|3] "bit"  Display
 SG_ OvenTemp : 16|8@1+ (1,-50) [-50|200] "degC"  Display
 SG_ OvenReserve2 : 24|4@1+ (1,0) [0|15] "bit"  Display
 SG_ OvenFan : 28|4@1+ (1,0) [0|15] "bit"  Display

BO_ 2566849040 Wish: 8 Display
 SG_ WishFine : 15|16@0- (0.01,0) [0|30] "degC"  Oven

BO_ 2566849312 OvenClock: 4 Oven
 SG_ OvenHours : 0|16@1+ (1,0) [0|65535] "h"  Display
 SG_ Spare1 : 16|16@1+ (1,0) [0|65535] ""  Display

CM_ SG_ 2566848800 OvenLid "盖子";
BA_DEF_ BO_  "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_  "GenMsgCycleTime" 0;
BA_ "GenMsgCycleTime" BO_ 2566848800 200;
BA_ "GenMsgCycleTime" BO_ 2566849312 1000;
VAL_ 2566848800 OvenMode 0 " 开" 1 " 关" 2 "eco" 3 " 无效" ;
VAL_ 2566848800 OvenLid 0 "未连接" 3 "无效" ;
VAL_ 2566848800 OvenTemp 254 "Sensor, broken wire" 255 "Invalid value" ;
"""
"""Speaks of the small spec's two messages in other words, and of one more."""

ACTS = (
    FILES["behaviour.yaml"]
    + """\
acts:
  - {signal: H_Mode, codes: [1], safe: 0}
"""
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_project(tmp_path, behaviour=ACTS)
    (tmp_path / "oven.dbc").write_text(SUPPLIER, "gb18030")
    return tmp_path


def compiled(folder: Path, choice: str = "") -> Compiled:
    return compile_spec(folder / "spec", "spec", "thermo", choice)


def imported(folder: Path, name: str = "oven") -> Protocol:
    result = dbcspec(folder, "import", "oven.dbc", "--as-edition", name)
    assert result.returncode == 0, result.stderr
    made = compiled(folder, name)
    assert not made.errata_faults
    return made.protocol


def test_every_signal_of_the_file_lies_and_counts_in_the_edition_as_cantools_reads_it(
    folder: Path,
) -> None:
    made = imported(folder)
    database = cantools.database.Database(strict=False)
    database.add_dbc_file(folder / "oven.dbc", encoding="gb18030")
    compared = 0
    for message in database.messages:
        ours = next(each for each in made.messages if each.frame_id == message.frame_id)
        places = {(each.start, each.length): each for each in ours.signals}
        for signal in message.signals:
            if signal.name in ("OvenReserve2", "Spare1"):
                assert (signal.start, signal.length) not in places
                continue
            mine = places[signal.start, signal.length]
            assert (float(mine.factor), float(mine.offset)) == (signal.scale, signal.offset)
            assert mine.signed == signal.is_signed
            compared += 1
    assert compared == 8


def test_what_the_spec_calls_things_stays_and_so_do_its_nodes(folder: Path) -> None:
    made = imported(folder)
    assert [message.name for message in made.messages] == ["Heater", "Panel", "OvenClock"]
    names = [signal.name for signal in made.message("Heater").signals]
    assert names == ["H_Sum", "H_Live", "H_Mode", "H_Temp", "OvenLid", "OvenFan"]
    assert [message.sender for message in made.messages] == ["HEATER", "PANEL", "HEATER"]
    assert made.message("OvenClock").signal("OvenHours").receivers == ("PANEL",)


def test_codes_that_change_places_take_the_acting_code_along_and_are_warned_of(
    folder: Path,
) -> None:
    mode = imported(folder).message("Heater").signal("H_Mode")
    assert mode.value_table is not None
    assert mode.value_table.labels() == {0: "On", 1: "Off", 2: "ECO", 3: "Invalid"}
    assert mode.acting is not None
    assert (mode.acting.codes, mode.acting.safe, mode.start_value) == ((0,), 1, 3)
    head = (folder / "spec/editions/oven/edition.yaml").read_text("utf-8")
    assert "Codes 0, 1 of H_Mode mean something else than in the standard." in head


def test_a_code_that_acts_and_is_gone_is_left_to_a_person(folder: Path) -> None:
    text = SUPPLIER.replace('0 " 开" 1 " 关"', '0 " 关" 1 " 无效"')
    (folder / "oven.dbc").write_text(text, "gb18030")
    mode = imported(folder).message("Heater").signal("H_Mode")
    assert mode.acting is not None
    assert mode.acting.codes == (1,)
    head = (folder / "spec/editions/oven/edition.yaml").read_text("utf-8")
    assert "H_Mode: a code that acts is not to be told by its label" in head


def test_labels_that_are_only_spelt_otherwise_stay_and_states_are_the_specs(folder: Path) -> None:
    heater = imported(folder).message("Heater")
    temperature = heater.signal("H_Temp").value_table
    assert temperature is not None
    assert temperature.labels() == {254: "Broken", 255: "Invalid"}
    assert heater.signal("OvenLid").invalid_code == 3


def test_reserved_bits_that_are_used_become_signals_and_the_rest_stays_reserved(
    folder: Path,
) -> None:
    made = imported(folder)
    assert [(each.start, each.length) for each in made.message("Heater").reserved] == [(24, 4)]
    assert [(each.start, each.length) for each in made.message("OvenClock").reserved] == [(16, 16)]


def test_periods_are_the_files_and_a_period_says_that_it_is_sent_always(folder: Path) -> None:
    made = imported(folder)
    assert [message.period for message in made.messages] == [200, None, 1000]
    assert made.message("Panel").send_type is SendType.EVENT


def test_a_signal_elsewhere_takes_the_place_of_the_specs_with_its_row(folder: Path) -> None:
    made = imported(folder)
    assert [signal.name for signal in made.message("Panel").signals] == ["WishFine"]
    assert not [row for _, row in compiled(folder, "oven").spec.rows() if row.name[:2] == "P_"]
    assert compiled(folder).protocol.message("Panel").signals[0].name == "P_WantedTemp"


def test_a_signal_that_behaviour_names_stays_and_that_is_said(folder: Path) -> None:
    text = SUPPLIER.replace(
        ' SG_ OvenLife : 8|4@1+ (1,0) [0|15] "bit"  Display\n',
        ' SG_ OvenLife : 8|3@1+ (1,0) [0|7] "bit"  Display\n',
    )
    (folder / "oven.dbc").write_text(text, "gb18030")
    result = dbcspec(folder, "import", "oven.dbc", "--as-edition", "oven")
    assert "Heater.H_Live: the file has no such signal, but behaviour.yaml" in result.stderr
    assert "Heater.OvenLife is left out: it lies on a signal that stays" in result.stderr
    names = [signal.name for signal in compiled(folder, "oven").protocol.messages[0].signals]
    assert "H_Live" in names
    assert "OvenLife" not in names


def test_a_message_that_the_file_lacks_stays_and_that_is_said(folder: Path) -> None:
    start, end = SUPPLIER.index("BO_ 2566849040"), SUPPLIER.index("BO_ 2566849312")
    (folder / "oven.dbc").write_text(SUPPLIER[:start] + SUPPLIER[end:], "gb18030")
    result = dbcspec(folder, "import", "oven.dbc", "--as-edition", "oven")
    assert "the file does not have Panel: they stay as they are" in result.stderr
    made = compiled(folder, "oven").protocol
    assert made.message("Panel") == compiled(folder).protocol.message("Panel")


def test_a_file_that_says_the_same_gives_no_deviation(tmp_path: Path) -> None:
    write_project(tmp_path)
    assert dbcspec(tmp_path, "generate").returncode == 0
    for name in ("thermo.dbc", "thermo.zh.dbc"):
        result = dbcspec(tmp_path, "import", f"out/{name}", "--as-edition", name)
        assert result.returncode == 0, result.stderr
        assert "0 deviations, 0 more messages" in result.stdout
    assert "errata: []" in (tmp_path / "spec/editions/thermo.dbc/errata.yaml").read_text("utf-8")


def test_an_edition_over_another_has_only_what_it_adds(folder: Path) -> None:
    imported(folder)
    (folder / "oven.dbc").write_text(SUPPLIER.replace("(1,-50)", "(2,-50)"), "gb18030")
    result = dbcspec(folder, "import", "oven.dbc", "--as-edition", "newer", "--over", "oven")
    assert result.returncode == 0, result.stderr
    made = compiled(folder, "newer").protocol
    assert made.message("Heater").signal("H_Temp").factor == 2
    assert "1 deviations, 0 more messages" in result.stdout


def test_what_only_shared_rows_could_say_is_left_to_a_person(folder: Path) -> None:
    messages = edited(
        "messages.yaml",
        "      - {name: P_WantedTemp, length: 16, start: 7}",
        "      - {name: H_Temp, length: 8, start: 7}",
    )
    write_project(folder, messages=messages, behaviour=ACTS)
    result = dbcspec(folder, "import", "oven.dbc", "--as-edition", "oven")
    assert "Heater.H_Temp: the file has factor 1, offset -50" in result.stderr
    assert "explains other signals too" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--as-edition", "oven", "--out", "x"], "not allowed with"),
        (["--out", "x", "--over", "oven"], "--over goes together with --as-edition"),
        (["--as-edition", "../oven"], "'../oven' is no name of an edition"),
        (["--as-edition", "taken"], "spec/editions/taken: is there already"),
        (["--as-edition", "oven", "--over", "none"], "there is no reading or edition 'none'"),
    ],
)
def test_what_cannot_be_imported_is_said_in_a_line_and_nothing_is_written(
    folder: Path, arguments: list[str], said: str
) -> None:
    (folder / "spec/editions/taken").mkdir(parents=True)
    before = sorted(folder.rglob("*"))
    result = dbcspec(folder, "import", "oven.dbc", *arguments)
    assert result.returncode == 2
    assert said in result.stderr
    assert sorted(folder.rglob("*")) == before


def test_a_code_that_no_bits_can_hold_and_a_unit_that_is_none_are_left_out(folder: Path) -> None:
    text = SUPPLIER.replace('2 "eco" 3', '2 "eco" 9 "late" 3')
    (folder / "oven.dbc").write_text(text, "gb18030")
    heater = imported(folder).message("Heater")
    table = heater.signal("H_Mode").value_table
    assert table is not None
    assert [code.value for code in table.codes] == [0, 1, 2, 3]
    assert heater.signal("OvenLid").unit == ""


def test_where_two_rows_explain_a_signal_both_get_the_codes_and_the_acts_move_once(
    folder: Path,
) -> None:
    row = FILES["tables/01-heater.yaml"].split("  - no: 3\n")[1].split("  - no: 4\n")[0]
    tables = FILES["tables/01-heater.yaml"] + "  - no: 5\n" + row
    (folder / "spec/tables/01-heater.yaml").write_text(tables, "utf-8")
    mode = imported(folder).message("Heater").signal("H_Mode")
    assert mode.acting is not None
    assert (mode.acting.codes, mode.acting.safe) == ((0,), 1)
    rows = [row for _, row in compiled(folder, "oven").spec.rows() if row.name == "H_Mode"]
    assert [row.labels[0] for row in rows] == ["开", "开"]
