"""Codes that act in the Excel matrix: out, in, and from there into behaviour.yaml."""

from __future__ import annotations

import dataclasses
import io
import shutil
from pathlib import Path
from typing import Any

import openpyxl
import pytest
from emit.acting_protocol import MOVING
from matrix.small_spec import applied, changed, lines, model
from matrix.workbooks import MATRIX, columns, edited, signal_rows, small
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.compare.run import compare
from dbcspec.errors import SpecError
from dbcspec.matrix.read import read_matrix
from dbcspec.matrix.write import emit_matrix
from dbcspec.spec.write import propose_spec
from typedcan.model.acting import ActingCodes
from typedcan.model.protocol import Aspect, Protocol, Signal

ACTING = "Acting Values (Hex)", "Safe Value (Hex)", "Acts As", "Acting Reference"
BEHAVIOUR = """\
acts:   # what moves
  # the mode
  - {signal: Mode, codes: [1], safe: 0, cite: here}   # on
  - signal: Second.Kept
    codes: [5, 0x6]
    safe: 2
"""


def acting_of(protocol: Protocol) -> dict[tuple[str, str], ActingCodes | None]:
    return {(message.name, each.name): each.acting for message, each in protocol.signals()}


def only_signal(path: Path) -> Signal:
    [(_, each)] = read_matrix(path).signals()
    return each


def test_codes_that_act_come_back_from_a_matrix_with_all_that_is_said_of_them(
    tmp_path: Path,
) -> None:
    path = tmp_path / "m.xlsx"
    path.write_bytes(emit_matrix(MOVING))
    back = read_matrix(path)
    assert acting_of(back) == acting_of(MOVING)
    assert Aspect.ACTS in back.carries
    assert compare(MOVING, back) == []


def test_the_columns_say_it_in_words_and_hexadecimal() -> None:
    sheet = openpyxl.load_workbook(io.BytesIO(emit_matrix(MOVING)))[MATRIX]
    places = columns(sheet)
    cells = [
        [sheet.cell(row, places[heading]).value for heading in ACTING]
        for row in range(2, sheet.max_row + 1)
    ]
    assert cells == [
        [None, None, None, None],
        ["0x0", "0x1", "Command", "5.1; Table 1"],
        ["0xFF, 0x01", "0x00", "Command", None],
        [", ".join(f"0x{code:02X}" for code in range(1, 26)), "0x00", "Command", "5.2"],
        [None, None, None, None],
        [None, None, None, None],
        ["0x0", "0x1", "Report", "5.3"],
        [None, None, None, None],
    ]
    assert {sheet.cell(1, places[heading]).value for heading in ACTING} == {
        "动作值\nActing Values (Hex)",
        "安全值\nSafe Value (Hex)",
        "动作类型\nActs As",
        "动作依据\nActing Reference",
    }


def test_a_protocol_that_cannot_say_what_acts_has_no_columns_for_it() -> None:
    silent = dataclasses.replace(MOVING, carries=frozenset(Aspect) - {Aspect.ACTS})
    sheet = openpyxl.load_workbook(io.BytesIO(emit_matrix(silent)))[MATRIX]
    assert not {*ACTING} & columns(sheet).keys()


@pytest.mark.parametrize("heading", ACTING)
def test_a_matrix_without_all_the_columns_is_silent_and_differs_in_nothing(
    heading: str, tmp_path: Path
) -> None:
    def edit(sheet: Worksheet) -> None:
        sheet.delete_cols(columns(sheet)[heading])

    back = read_matrix(edited(emit_matrix(MOVING), tmp_path / "m.xlsx", edit))
    assert Aspect.ACTS not in back.carries
    assert compare(MOVING, back) == []


@pytest.mark.parametrize(
    ("cells", "acting", "start"),
    [
        ({ACTING[0]: "0x1", ACTING[1]: "0x0"}, ActingCodes(codes=(1,), safe=0), 0),
        ({ACTING[0]: "2；1、A", ACTING[1]: 10}, ActingCodes(codes=(1, 2, 10), safe=16), 0),
        ({"动作值": 10, "安全值": 0}, ActingCodes(codes=(10,), safe=0), 0),
        ({ACTING[0]: "0x0", ACTING[1]: "0x3"}, ActingCodes(codes=(0,), safe=3), 3),
        (
            {ACTING[0]: "0x0", ACTING[1]: "0x3", "Initial Value": 0},
            ActingCodes(codes=(0,), safe=3),
            0,
        ),
        (
            {ACTING[0]: 1, ACTING[1]: 0, ACTING[2]: "报告", ACTING[3]: " 5.1 "},
            ActingCodes(codes=(1,), safe=0, reports=True, reference=" 5.1 "),
            0,
        ),
        ({ACTING[0]: 1, ACTING[1]: 0, ACTING[2]: "COMMAND"}, ActingCodes(codes=(1,), safe=0), 0),
        ({ACTING[0]: None, ACTING[1]: " "}, None, 0),
        ({ACTING[1]: 1}, None, 0),
        ({ACTING[0]: 1}, None, 0),
    ],
)
def test_what_acts_is_read_as_people_write_it(
    cells: dict[str, object], acting: ActingCodes | None, start: int, tmp_path: Path
) -> None:
    each = only_signal(small(tmp_path / "m.xlsx", **cells))
    assert (each.acting, each.start_value) == (acting, start)


@pytest.mark.parametrize(
    ("cells", "heading", "word"),
    [
        ({ACTING[0]: "0x1", ACTING[1]: None}, ACTING[1], "write the safe value"),
        ({ACTING[0]: "0x1, 0x2", ACTING[1]: "0x2"}, ACTING[1], "the safe value 2 acts itself"),
        ({ACTING[0]: "on", ACTING[1]: "0x2"}, ACTING[0], "expected a raw value"),
        ({ACTING[0]: "1, 0x1", ACTING[1]: "0x2"}, ACTING[0], "stands twice in '1, 0x1'"),
        ({ACTING[0]: "1", ACTING[1]: "off"}, ACTING[1], "expected a raw value"),
        ({ACTING[0]: "1", ACTING[1]: 0, ACTING[2]: "maybe"}, ACTING[2], "Command or Report"),
        ({ACTING[0]: None, ACTING[1]: 0}, ACTING[1], "no value acts here"),
        (dict.fromkeys(ACTING[:2]) | {ACTING[2]: "Report"}, ACTING[2], "no value acts here"),
        (dict.fromkeys(ACTING[:2]) | {ACTING[3]: "5.1"}, ACTING[3], "no value acts here"),
        ({ACTING[0]: "=1", ACTING[1]: 0}, ACTING[0], "a formula stands here"),
    ],
)
def test_what_contradicts_itself_is_one_fault_in_its_cell(
    cells: dict[str, object], heading: str, word: str, tmp_path: Path
) -> None:
    path = small(tmp_path / "m.xlsx", **cells)
    with pytest.raises(SpecError) as caught:
        read_matrix(path)
    [fault] = caught.value.faults
    assert word in fault.text
    sheet = openpyxl.load_workbook(path).active
    assert isinstance(sheet, Worksheet)
    assert fault.where.column == columns(sheet)[heading]


def acting(**values: Any) -> dict[str, Any]:
    facts: dict[str, Any] = {"codes": (1,), "safe": 0, "reference": "here", **values}
    return {"acting": ActingCodes(**facts)}


@pytest.fixture
def moving(spec: Path) -> Path:
    """The small spec, of which two signals act."""
    (spec / "behaviour.yaml").write_text(BEHAVIOUR, "utf-8")
    return spec


@pytest.mark.parametrize(
    ("signal", "values", "wanted"),
    [
        (
            "Mode",
            acting(codes=(1, 15)),
            [
                "-  - {signal: Mode, codes: [1], safe: 0, cite: here}   # on",
                "+  - {signal: Mode, codes: [1, 15], safe: 0, cite: here}   # on",
            ],
        ),
        (
            "Mode",
            acting(safe=2, reports=True, reference="A: b"),
            [
                "-  - {signal: Mode, codes: [1], safe: 0, cite: here}   # on",
                '+  - {signal: Mode, codes: [1], safe: 2, kind: report, cite: "A: b"}   # on',
            ],
        ),
        (
            "Kept",
            {"acting": ActingCodes(codes=(5, 6), safe=1, reference="there")},
            ["-    safe: 2", "+    safe: 1", "+    cite: there"],
        ),
        (
            "Temp",
            {"acting": ActingCodes(codes=(9,), safe=1)},
            ["+  - signal: Temp", "+    codes: [9]", "+    safe: 1"],
        ),
        (
            "Temp",
            {"acting": ActingCodes(codes=(8, 9), safe=1, reports=True, reference="5.2")},
            [
                "+  - signal: Temp",
                "+    codes: [8, 9]",
                "+    safe: 1",
                "+    kind: report",
                "+    cite: 5.2",
            ],
        ),
    ],
)
def test_what_acts_changes_in_behaviour_and_nowhere_else(
    signal: str, values: dict[str, Any], wanted: list[str], moving: Path
) -> None:
    old = model(moving)
    new = changed(old, {signal: values})
    proposal = propose_spec(moving, old, new)
    assert proposal.not_written == ()
    assert sorted(lines(moving, proposal)) == sorted(wanted)
    made = {name: each for (_, name), each in acting_of(applied(moving, proposal)).items()}
    assert made[signal] == values["acting"]


def test_what_no_longer_acts_is_for_a_person_to_delete(moving: Path) -> None:
    old = model(moving)
    proposal = propose_spec(moving, old, changed(old, {"Kept": {"acting": None}}))
    assert proposal.files == {}
    [line] = proposal.not_written
    assert line.startswith("Kept: codes that act is 5, 6 (command, safe 2, no clause), not nothing")
    assert line.endswith(": delete the row of Second.Kept in behaviour.yaml by hand")


def test_a_spec_in_which_nothing_acts_says_that_its_first_row_is_missing(spec: Path) -> None:
    old = model(spec)
    proposal = propose_spec(spec, old, changed(old, {"Mode": acting()}))
    assert proposal.files == {}
    [line] = proposal.not_written
    assert line.startswith("Mode: codes that act is nothing, not 1 (command, safe 0, here)")
    assert line.endswith(": behaviour.yaml has no acts: write the first row by hand")


def test_a_row_that_an_erratum_settles_is_left_to_the_erratum(moving: Path) -> None:
    errata = (moving / "errata.yaml").read_text("utf-8")
    change = "      - at: [behaviour/acts/Mode]\n        set: {safe: 2}\n"
    (moving / "errata.yaml").write_text(errata + change, "utf-8")
    old = model(moving)
    proposal = propose_spec(moving, old, changed(old, {"Mode": acting(safe=3)}))
    assert proposal.files == {}
    [line] = proposal.not_written
    assert line.endswith("behaviour/acts/Mode: erratum E01 settles safe; change the erratum")


def test_signals_that_share_a_row_change_it_once(moving: Path) -> None:
    messages = (moving / "messages.yaml").read_text("utf-8")
    shared = "      - name: Kept\n        length: 8\n        start: 0\n"
    twice = f"{shared}      - {{name: Mode, length: 4, start: 8}}\n"
    (moving / "messages.yaml").write_text(messages.replace(shared, twice), "utf-8")
    old = model(moving)
    proposal = propose_spec(moving, old, changed(old, {"Mode": acting(codes=(1, 14, 15))}))
    assert proposal.not_written == ()
    found = acting_of(applied(moving, proposal))
    assert found["First", "Mode"] == found["Second", "Mode"] == acting(codes=(1, 14, 15))["acting"]


def test_a_new_row_names_the_message_where_several_have_the_signal(moving: Path) -> None:
    messages = (moving / "messages.yaml").read_text("utf-8")
    shared = "      - name: Kept\n        length: 8\n        start: 0\n"
    twice = f"{shared}      - {{name: Temp, length: 8, start: 8}}\n"
    (moving / "messages.yaml").write_text(messages.replace(shared, twice), "utf-8")
    old = model(moving)
    first = changed(old, {"Temp": acting()}).messages[0]
    new = dataclasses.replace(old, messages=(first, old.messages[1]))
    proposal = propose_spec(moving, old, new)
    assert "+  - signal: First.Temp" in lines(moving, proposal)
    assert acting_of(applied(moving, proposal))["Second", "Temp"] is None


def test_a_new_signal_brings_its_row_along(moving: Path) -> None:
    old = model(moving)
    first, second = old.messages
    extra = dataclasses.replace(first.signals[0], name="Extra", start=24, **acting())
    longer = dataclasses.replace(first, signals=(*first.signals, extra))
    proposal = propose_spec(moving, old, dataclasses.replace(old, messages=(longer, second)))
    assert proposal.not_written == ()
    assert acting_of(applied(moving, proposal))["First", "Extra"] == acting()["acting"]


def test_an_edited_matrix_changes_what_acts_in_the_projects_own_spec(
    root: Path, protocol: Protocol, project_matrix: bytes, tmp_path: Path
) -> None:
    def edit(sheet: Worksheet) -> None:
        rows, places = signal_rows(sheet), columns(sheet)
        sheet.cell(rows["V2B_CMD_Heat_OnOff"], places[ACTING[0]]).value = "0x0, 0x1"
        for heading, value in zip(ACTING, ("0x2", "0x1", "Report", "5.2.4"), strict=True):
            sheet.cell(rows["BSU_Lock"], places[heading]).value = value

    folder = tmp_path / "spec"
    shutil.copytree(root / "spec", folder)
    path = edited(project_matrix, tmp_path / "m.xlsx", edit)
    proposal = propose_spec(folder, protocol, read_matrix(path))
    assert set(proposal.files) == {"behaviour.yaml"}
    assert proposal.not_written == ()
    old = "  - {signal: V2B_CMD_Heat_OnOff, codes: [1], safe: 2, cite: 5.2.1; Table 14 row 6}"
    assert lines(folder, proposal) == [
        f"-{old}",
        f"+{old.replace('[1]', '[0, 1]')}",
        "+  - signal: BSU_Lock",
        "+    codes: [2]",
        "+    safe: 1",
        "+    kind: report",
        "+    cite: 5.2.4",
    ]
