"""Two spellings of one protocol: matched by bits, reversed codes first, what is alike summed up."""

from __future__ import annotations

from pathlib import Path

import pytest

from dbcspec.cli import run
from dbcspec.compare.pairing import pair
from dbcspec.compare.run import RULES, compare, findings
from dbcspec.read.doors import open_side
from typedcan.databases.dbc import read_dbc
from typedcan.model.protocol import Protocol
from typedcan.report.formats import render
from typedcan.report.item import Report

OLD = """VERSION ""

NS_ :

BS_:

BU_: Pack Truck

BO_ 2550255859 CMD: 8 Truck
 SG_ Heizung : 0|2@1+ (1,0) [0|3] "bit" Pack
 SG_ Schuetz : 2|2@1+ (1,0) [0|3] "bit" Pack
 SG_ Lampe : 4|2@1+ (1,0) [0|3] "bit" Pack
 SG_ Tempo : 8|16@1+ (0.1,0) [0|250] "km/h" Pack
 SG_ Wert : 24|16@1+ (1,0) [0|65535] "bit" Pack
 SG_ SOC_wahr : 40|8@1+ (0.4,0) [0|102] "%" Pack
 SG_ Reserve1 : 48|16@1+ (1,0) [0|65535] "bit" Pack

VAL_ 2550255859 Heizung 0 " 预留" 1 " 加热断开" 2 " 加热闭合" 3 " 无效" ;
VAL_ 2550255859 Schuetz 0 " 正常" 1 " 开路故障" 2 " 粘连故障" 3 " 无效" ;
VAL_ 2550255859 Lampe 0 " 预留" 1 " 断开" 2 " 闭合" 3 " 无效" ;
"""

NEW = """VERSION ""

NS_ :

BS_:

BU_: Battery Vehicle

BO_ 2550255859 COMMAND: 8 Vehicle
 SG_ Heater : 0|2@1+ (1,0) [0|3] "" Battery
 SG_ Contactor : 2|2@1+ (1,0) [0|3] "" Battery
 SG_ Lamp : 4|2@1+ (1,0) [0|3] "" Battery
 SG_ Speed : 8|16@1+ (1,0) [0|250] "km/h" Battery
 SG_ Value : 24|16@1+ (1,0) [0|65535] "" Battery

VAL_ 2550255859 Heater 0 "Reserved" 1 "Heat On" 2 "Heat Off" 3 "Signal Invalid" ;
VAL_ 2550255859 Contactor 0 "Normal" 1 "Weld" 2 "Opened" 3 "Signal Invalid" ;
VAL_ 2550255859 Lamp 0 "Reserved" 1 "Open" 2 "Closed" 3 "Signal Invalid" ;
VAL_ 2550255859 Value 65535 "Signal Invalid" ;
"""

CASES = Path(__file__).parents[1] / "fixtures" / "cases"


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    old, new = tmp_path / "old.dbc", tmp_path / "new.dbc"
    old.write_text(OLD, "utf-8")
    new.write_text(NEW, "utf-8")
    return old, new


@pytest.fixture
def sides(files: tuple[Path, Path]) -> tuple[Protocol, Protocol]:
    old, new = (read_dbc(file) for file in files)
    return old, new


def test_another_spelling_is_recognised_and_its_signals_are_matched_by_their_bits(
    sides: tuple[Protocol, Protocol],
) -> None:
    found = pair(*sides)
    assert found.by_place
    assert [(each.old.name, each.new.name) for each in found.signals] == [
        ("Heizung", "Heater"),
        ("Schuetz", "Contactor"),
        ("Lampe", "Lamp"),
        ("Tempo", "Speed"),
        ("Wert", "Value"),
    ]


def test_codes_that_changed_places_are_told_first_and_translations_are_not_told(
    sides: tuple[Protocol, Protocol],
) -> None:
    items = compare(*sides)
    reversed_ones = [item for item in items if item.rule == "code-meaning-not-reversed"]
    assert [item.subject for item in reversed_ones] == ["Heater", "Contactor"]
    assert not [item for item in items if item.rule == "code-meaning-same"]
    lines = render(Report(title="t", items=items, rules=RULES), "text").splitlines()
    assert "codes mean the opposite (2)" in lines[2]
    assert lines[3].strip().startswith("Heater:")
    assert lines[4].strip().startswith("Contactor:")


def test_the_first_screen_says_what_the_other_two_hundred_lines_are_about(
    sides: tuple[Protocol, Protocol],
) -> None:
    text = render(Report(title="t", items=compare(*sides), rules=RULES), "text")
    screen = text.splitlines()[:40]
    assert all(len(line) <= 100 for line in screen[: screen.index("")])
    order = [
        "codes mean the opposite (2)",
        "invalid and abnormal codes differ (1)",
        "signals are gone (1)",
        "SOC_wahr",
        "scales differ (1)",
        "Speed: factor 0.1 → 1",
        "signals are called otherwise (5)",
    ]
    places = [next(i for i, line in enumerate(screen) if each in line) for each in order]
    assert places == sorted(places)


def test_names_receivers_and_units_are_one_finding_each_with_every_member(
    sides: tuple[Protocol, Protocol],
) -> None:
    by_rule = {item.rule: item for item in compare(*sides)}
    names = by_rule["signal-name-same"]
    assert names.members[0] == "COMMAND.Heizung → Heater"
    assert len(names.members) == 5
    assert len(by_rule["signal-unit-same"].members) == 4
    assert by_rule["signal-unit-same"].old == "bit"
    assert by_rule["reserved-signal-present"].subject == "Reserve1"


def test_a_sum_of_other_signals_has_another_fingerprint(
    sides: tuple[Protocol, Protocol], tmp_path: Path
) -> None:
    other = tmp_path / "other.dbc"
    other.write_text(NEW.replace('[0|65535] ""', '[0|65535] "bit"'), "utf-8")
    before = {item.rule: item for item in compare(*sides)}["signal-unit-same"]
    after = {item.rule: item for item in compare(sides[0], read_dbc(other))}["signal-unit-same"]
    assert (before.old, before.new) == (after.old, after.new)
    assert before.fingerprint != after.fingerprint


def test_the_choice_can_be_made_by_hand(sides: tuple[Protocol, Protocol]) -> None:
    listed = findings(pair(*sides, by_place=False))
    assert sum(item.rule == "signal-name-same" for item in listed) == 5
    assert not pair(sides[0], sides[0]).by_place
    assert findings(pair(sides[0], sides[0], by_place=True)) == []


def test_by_place_two_signals_that_changed_their_bits_are_two_names(
    sides: tuple[Protocol, Protocol], tmp_path: Path
) -> None:
    path = tmp_path / "swapped.dbc"
    path.write_text(
        NEW.replace("Heater", "Third").replace("Lamp", "Heater").replace("Third", "Lamp"), "utf-8"
    )
    swapped = read_dbc(path)
    by_name, by_place = (findings(pair(sides[1], swapped, by_place=b)) for b in (False, True))
    assert {item.rule for item in by_name} >= {"signal-start-same"}
    assert "signal-start-same" not in {item.rule for item in by_place}


def test_the_command_says_that_it_matched_by_place(
    files: tuple[Path, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    old, new = map(str, files)
    assert run(["compare", old, new]) == 1
    assert "Most names differ" in capsys.readouterr().out.splitlines()[1]
    assert run(["compare", old, new, "--no-by-place"]) == 1
    assert "Most names differ" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("old", "new", "rule"),
    [
        ("mixed.dbc", "mixednot.dbc", "message-frame-format-same"),
        ("mixednot.dbc", "mixed.dbc", "message-frame-format-same"),
    ],
)
def test_classic_can_against_can_fd_is_a_wire_finding(old: str, new: str, rule: str) -> None:
    before, after = (open_side(str(CASES / side)).protocol for side in (old, new))
    items = compare(before, after)
    (item,) = items
    assert (item.rule, item.level, item.subject) == (rule, "wire", "FDMSG")


def test_a_second_sender_that_is_gone_is_a_wire_finding(tmp_path: Path) -> None:
    text = (CASES / "starts.dbc").read_text("utf-8")
    assert "BO_TX_BU_ 256 : AA,CC;" in text
    path = tmp_path / "one.dbc"
    path.write_text(text.replace("BO_TX_BU_ 256 : AA,CC;", ""), "utf-8")
    (item,) = compare(read_dbc(CASES / "starts.dbc"), read_dbc(path))
    assert (item.rule, item.level) == ("message-sender-same", "wire")
    assert (item.old, item.new) == ("AA, CC", "AA")


def coded(folder: Path, name: str, labels: list[str], more: str = "") -> Protocol:
    """A file of one signal with these labels from 0 on."""
    codes = " ".join(f'{value} "{label}"' for value, label in enumerate(labels))
    text = f"""VERSION ""

NS_ :

BS_:

BU_: A

BO_ 256 M: 8 A
 SG_ S : 0|8@1+ (1,0) [0|255] "" A

{more}VAL_ 256 S {codes} ;
"""
    path = folder / name
    path.write_text(text, "utf-8")
    return read_dbc(path)


def test_a_long_table_turned_round_is_told_as_one_reversal(tmp_path: Path) -> None:
    labels = [f"Step {value}" for value in range(200)]
    (item,) = compare(coded(tmp_path, "old.dbc", labels), coded(tmp_path, "new.dbc", labels[::-1]))
    assert item.rule == "code-meaning-not-reversed"
    assert item.old.startswith('0 "Step 0", 1 "Step 1"')
    assert item.new.startswith('0 "Step 199", 1 "Step 198"')


def test_three_codes_that_moved_on_in_a_ring_have_not_changed_places(tmp_path: Path) -> None:
    items = compare(
        coded(tmp_path, "old.dbc", ["Low", "Middle", "High"]),
        coded(tmp_path, "new.dbc", ["High", "Low", "Middle"]),
    )
    assert [item.rule for item in items] == ["code-meaning-same"]


@pytest.mark.parametrize(
    ("old", "new"), [(["On", "Off"], ["off", "ON"]), (["Heat on", "Heat off"], ["Off", "On"])]
)
def test_the_words_on_and_off_are_seen_whatever_stands_beside_them(
    old: list[str], new: list[str], tmp_path: Path
) -> None:
    (item,) = compare(coded(tmp_path, "old.dbc", old), coded(tmp_path, "new.dbc", new))
    assert item.rule == "code-meaning-not-reversed"
