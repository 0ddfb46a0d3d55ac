"""A changed matrix becomes a change of the spec: exact lines, nothing else."""

from __future__ import annotations

import dataclasses
import difflib
import shutil
from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from matrix.workbooks import column, edited, row_of
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.emit.matrix import emit_matrix
from dbcspec.errata import apply_errata
from dbcspec.model import Code, Message, Protocol, SendType, Signal, ValueTable
from dbcspec.read.matrix import read_matrix
from dbcspec.resolve import resolve
from dbcspec.rows import read_spec
from dbcspec.write_spec import Proposal, propose_spec

_STANDARD = """\
number: T 1
title: 标准
english: Standard
nodes:
  - {name: A, english: Node A}
  - {name: B, english: Node B}
units: {℃: degC}
invalid_labels: [Invalid]
"""
_MESSAGES = """\
# the annex
annex: A.1
byte_order: Intel
messages:
  - id: 0x18FF0001   # first
    name: First
    length: 8
    type: Cyclic
    period: 100      # ms
    signals:
      - {name: Temp, length: 8, start: 0}   # in front
      - {name: Mode, length: 4, start: 8}
      - {name: Copy, length: 4, start: 12}
  # between
  - id: 0x18FF0002
    name: Second
    length: 8
    type: Event
    period: 0
    signals:
      - name: Kept
        length: 8
        start: 0
# the end
"""
_TABLE = """\
# Table 1
number: 1
clause: "1"
rows:
  - no: 1
    name: Temp
    title: '温度'  # as printed
    english: >-
      Temperature
      of the pack
    length: 8
    factor:   0.5
    offset: -40
    unit: ℃
    range: -40~87.5
    route: A>B

  - no: 2
    name: Mode   # a comment
    length: 4
    codes:
      0: OFF       # not false
      1: "on: yes"
    factor: 1
    offset: 0
    unit: ""
    range: 0~15
    route: A>B
  - {no: 3, name: Copy, length: 4, codes: {same_as: Mode}, factor: 1, offset: 0, unit: "",
     range: 0~15, route: A>B}
  - no: 4
    name: Kept
    length: 8
    factor: 1
    unit: V
    range: 0~100
    route: B>A
"""
_ERRATA = """\
errata:
  - id: E01
    kind: gap
    place: Table 1 row 4
    printed: nothing
    reading: the offset is 0, and the range stands
    because: so
    change:
      - at: [tables/01-only/4]
        set: {offset: 0}
      - at: [tables/01-only/4]
        keep: [range]
"""
_FILES = {
    "standard.yaml": _STANDARD,
    "messages.yaml": _MESSAGES,
    "tables/01-only.yaml": _TABLE,
    "errata.yaml": _ERRATA,
}


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    folder = tmp_path / "spec"
    (folder / "tables").mkdir(parents=True)
    for name, text in _FILES.items():
        (folder / name).write_bytes(text.encode())
    return folder


def model(folder: Path) -> Protocol:
    return resolve(apply_errata(read_spec(folder, "spec"))[0], "small")


def changed(
    protocol: Protocol,
    signals: Mapping[str, Mapping[str, Any]],
    messages: Mapping[str, Mapping[str, Any]] | None = None,
) -> Protocol:
    return dataclasses.replace(
        protocol,
        messages=tuple(
            dataclasses.replace(
                message,
                signals=tuple(
                    dataclasses.replace(each, **signals.get(each.name, {}))
                    for each in message.signals
                ),
                **(messages or {}).get(message.name, {}),
            )
            for message in protocol.messages
        ),
    )


def lines(folder: Path, proposal: Proposal) -> list[str]:
    """The lines that go and come, without those around them."""
    shown: list[str] = []
    for name, data in proposal.files.items():
        old, new = (folder / name).read_text("utf-8"), data.decode("utf-8")
        delta = difflib.unified_diff(old.splitlines(), new.splitlines(), lineterm="", n=0)
        shown += [line for line in delta if not line.startswith(("---", "+++", "@@"))]
    return shown


def applied(folder: Path, proposal: Proposal) -> Protocol:
    for name, data in proposal.files.items():
        (folder / name).write_bytes(data)
    return model(folder)


def codes(*labels: tuple[int, str]) -> ValueTable:
    return ValueTable("Mode", tuple(Code(code, label, label) for code, label in labels))


def test_without_a_change_nothing_is_proposed(spec: Path) -> None:
    assert propose_spec(spec, model(spec), model(spec)) == Proposal({}, ())


def test_without_a_change_nothing_is_proposed_for_the_project(
    root: Path, protocol: Protocol, tmp_path: Path
) -> None:
    path = tmp_path / "m.xlsx"
    path.write_bytes(emit_matrix(protocol))
    assert propose_spec(root / "spec", protocol, read_matrix(path)) == Proposal({}, ())


@pytest.mark.parametrize(
    ("signal", "values", "wanted"),
    [
        ("Temp", {"factor": Decimal("0.25")}, ["-    factor:   0.5", "+    factor:   0.25"]),
        ("Temp", {"offset": Decimal("-50.5")}, ["-    offset: -40", "+    offset: -50.5"]),
        ("Temp", {"unit": "V"}, ["-    unit: ℃", "+    unit: V"]),
        ("Mode", {"unit": "%"}, ['-    unit: ""', '+    unit: "%"']),
        ("Mode", {"unit": "degC"}, ['-    unit: ""', "+    unit: ℃"]),
        ("Temp", {"maximum": Decimal("1E+2")}, ["-    range: -40~87.5", "+    range: -40~100"]),
        (
            "Temp",
            {"title": "温度: 新 # 1"},
            ["-    title: '温度'  # as printed", '+    title: "温度: 新 # 1"  # as printed'],
        ),
        (
            "Temp",
            {"english": "Pack, hot"},
            [
                "-    english: >-",
                "-      Temperature",
                "-      of the pack",
                '+    english: "Pack, hot"',
            ],
        ),
        ("Mode", {"title": "模式"}, ["+    title: 模式"]),
        (
            "Temp",
            {"start": 16},
            [
                "-      - {name: Temp, length: 8, start: 0}   # in front",
                "+      - {name: Temp, length: 8, start: 16}   # in front",
            ],
        ),
        ("Temp", {"receivers": ("B", "A")}, ["-    route: A>B", "+    route: A>B,A"]),
    ],
)
def test_a_changed_value_changes_in_its_place_and_nowhere_else(
    signal: str, values: dict[str, Any], wanted: list[str], spec: Path
) -> None:
    old = model(spec)
    proposal = propose_spec(spec, old, changed(old, {signal: values}))
    assert lines(spec, proposal) == wanted
    assert proposal.not_written == ()


def test_a_changed_length_changes_in_annex_and_table(spec: Path) -> None:
    old = model(spec)
    new = changed(old, {"Temp": {"length": 7}})
    proposal = propose_spec(spec, old, new)
    assert lines(spec, proposal) == [
        "-      - {name: Temp, length: 8, start: 0}   # in front",
        "+      - {name: Temp, length: 7, start: 0}   # in front",
        "-    length: 8",
        "+    length: 7",
    ]


def test_facts_of_a_message_change_in_the_annex(spec: Path) -> None:
    old = model(spec)
    facts = {"period": 50, "length": 7, "frame_id": 0x18FF0003, "english": "One"}
    proposal = propose_spec(spec, old, changed(old, {}, {"First": facts}))
    assert sorted(lines(spec, proposal)) == sorted(
        [
            "-  - id: 0x18FF0001   # first",
            "+  - id: 0x18FF0003   # first",
            "+    english: One",
            "-    length: 8",
            "+    length: 7",
            "-    period: 100      # ms",
            "+    period: 50      # ms",
        ]
    )
    assert proposal.not_written == ()


def test_a_changed_label_leaves_the_other_labels_alone(spec: Path) -> None:
    old = model(spec)
    table = codes((0, "OFF"), (1, "ON"))
    proposal = propose_spec(
        spec, old, changed(old, {"Mode": {"value_table": table}, "Copy": {"value_table": table}})
    )
    assert lines(spec, proposal) == ['-      1: "on: yes"', "+      1: ON"]
    assert proposal.not_written == ()


def test_a_new_code_stands_in_its_order(spec: Path) -> None:
    old = model(spec)
    table = codes((0, "OFF"), (1, "on: yes"), (2, "no"))
    proposal = propose_spec(
        spec, old, changed(old, {"Mode": {"value_table": table}, "Copy": {"value_table": table}})
    )
    made = applied(spec, proposal)
    assert "      2: no" in (spec / "tables/01-only.yaml").read_text("utf-8").splitlines()
    [mode] = [each for _, each in made.signals() if each.name == "Mode"]
    assert mode.value_table
    assert mode.value_table.labels() == {0: "OFF", 1: "on: yes", 2: "no"}


def test_a_row_that_repeats_codes_gets_its_own_where_only_one_changes(spec: Path) -> None:
    old = model(spec)
    table = codes((0, "OFF"), (3, "three"))
    proposal = propose_spec(spec, old, changed(old, {"Mode": {"value_table": table}}))
    assert proposal.not_written == ()
    labels = {
        each.name: each.value_table.labels() if each.value_table else {}
        for _, each in applied(spec, proposal).signals()
    }
    assert labels["Mode"] == {0: "OFF", 3: "three"}
    assert labels["Copy"] == {0: "OFF", 1: "on: yes"}


@pytest.mark.parametrize(
    ("values", "what"),
    [({"offset": Decimal(5)}, "offset"), ({"maximum": Decimal(99)}, "range")],
    ids=["set", "kept"],
)
def test_what_an_erratum_settles_is_reported_and_not_written(
    values: dict[str, Any], what: str, spec: Path
) -> None:
    old = model(spec)
    proposal = propose_spec(spec, old, changed(old, {"Kept": values}))
    assert proposal.files == {}
    [line] = proposal.not_written
    assert line.startswith(f"Kept: {what} is ")
    assert line.endswith(f"tables/01-only/4: erratum E01 settles {what}; change the erratum")


@pytest.mark.parametrize(
    ("values", "word"),
    [
        ({"name": "Renamed"}, "name is Temp, not Renamed"),
        ({"signed": True}, "type is unsigned, not signed"),
        ({"is_selector": True}, "multiplexing"),
    ],
)
def test_what_the_spec_cannot_say_is_reported(
    values: dict[str, Any], word: str, spec: Path
) -> None:
    old = model(spec)
    proposal = propose_spec(spec, old, changed(old, {"Temp": values}))
    assert proposal.files == {}
    assert [word in line for line in proposal.not_written] == [True]


def test_nothing_is_deleted(spec: Path) -> None:
    old = model(spec)
    proposal = propose_spec(spec, old, dataclasses.replace(old, messages=old.messages[:1]))
    assert proposal.files == {}
    assert proposal.not_written == ("Second: the spec alone has the message Second",)


def test_a_new_signal_is_appended_to_annex_and_table(spec: Path) -> None:
    old = model(spec)
    extra = Signal(
        name="Extra",
        title="新",
        english="New: one",
        start=16,
        length=8,
        factor=Decimal("0.1"),
        minimum=Decimal(0),
        maximum=Decimal("25.5"),
        unit="degC",
        receivers=("B",),
        value_table=codes((255, "full")),
    )
    first, second = old.messages
    longer = dataclasses.replace(first, signals=(*first.signals, extra))
    new = dataclasses.replace(old, messages=(longer, second))
    proposal = propose_spec(spec, old, new)
    assert proposal.not_written == ()
    assert lines(spec, proposal) == [
        "+      - {name: Extra, length: 8, start: 16}",
        "+  - no: 5",
        "+    name: Extra",
        "+    title: 新",
        '+    english: "New: one"',
        "+    length: 8",
        "+    codes: {255: full}",
        "+    factor: 0.1",
        "+    offset: 0",
        "+    unit: ℃",
        "+    range: 0~25.5",
        "+    route: A>B",
    ]
    text = proposal.files["messages.yaml"].decode()
    assert text.endswith("# the end\n")
    back = applied(spec, proposal).messages[0].signals[-1]
    assert (back.name, back.start, back.factor, back.unit) == ("Extra", 16, Decimal("0.1"), "degC")


def test_a_new_message_is_appended_with_its_rows(spec: Path) -> None:
    old = model(spec)
    one = Signal(
        name="Only", start=0, length=8, minimum=Decimal(0), maximum=Decimal(255), receivers=("A",)
    )
    message = Message(
        name="Third",
        english="Third",
        frame_id=0x18FF0009,
        length=8,
        sender="B",
        period=20,
        send_type=SendType.CYCLIC,
        signals=(one,),
    )
    proposal = propose_spec(spec, old, dataclasses.replace(old, messages=(*old.messages, message)))
    assert [line for line in proposal.not_written if "title" not in line] == []
    back = applied(spec, proposal).message("Third")
    assert (back.frame_id, back.sender, back.period, back.english) == (0x18FF0009, "B", 20, "Third")
    assert [each.name for each in back.signals] == ["Only"]
    assert " \n" not in proposal.files["messages.yaml"].decode()


@pytest.mark.parametrize(
    ("end", "mark"), [("\r\n", b""), ("\n", b"\xef\xbb\xbf"), ("\r\n", b"\xef\xbb\xbf")]
)
def test_line_ends_and_byte_order_marks_stay(end: str, mark: bytes, spec: Path) -> None:
    for name, text in _FILES.items():
        (spec / name).write_bytes(mark + text.replace("\n", end).encode())
    old = model(spec)
    new = changed(old, {"Temp": {"factor": Decimal(2), "title": "新"}, "Mode": {"title": "模式"}})
    proposal = propose_spec(spec, old, new)
    wanted = (
        _TABLE.replace("factor:   0.5", "factor:   2")
        .replace("title: '温度'", "title: 新")
        .replace("name: Mode   # a comment\n", "name: Mode   # a comment\n    title: 模式\n")
    )
    made = proposal.files["tables/01-only.yaml"]
    assert made.startswith(mark)
    assert made.count(b"\r\n") == (made.count(b"\n") if end == "\r\n" else 0)
    assert model(spec) != applied(spec, proposal)
    assert proposal.not_written == ()
    assert b"# a comment" in made
    assert len(made.splitlines()) == len(wanted.splitlines())


@pytest.mark.parametrize(
    "text",
    [
        "OFF", "null", "1.0", "a: b", "a #b", "- a", "{a}", "[a", "'a", "\"a\"", "a\\b",
        "é 汉字", "~", "@a", "%", "a,b", "a]", "!x", "&x", "*x", "|", " lead", "trail ",
        "tab\tin", "two\nlines", "?", "a}",
    ],
)  # fmt: skip
def test_any_text_is_written_so_that_it_reads_back(text: str, spec: Path) -> None:
    old = model(spec)
    table = codes((0, text), (1, "on: yes"))
    new = changed(
        old,
        {
            "Temp": {"title": text},
            "Mode": {"value_table": table},
            "Copy": {"value_table": table, "title": text},
        },
    )
    proposal = propose_spec(spec, old, new)
    assert proposal.not_written == ()
    made = {each.name: each for _, each in applied(spec, proposal).signals()}
    assert made["Temp"].title == made["Copy"].title == text
    assert made["Mode"].value_table
    assert made["Mode"].value_table.labels()[0] == text


def test_a_matrix_changed_in_excel_becomes_a_change_of_the_projects_yaml(
    root: Path, protocol: Protocol, tmp_path: Path
) -> None:
    def edit(sheet: Worksheet) -> None:
        soc = row_of(sheet, "B2V_ST2_SOH")
        sheet.cell(soc, column(sheet, "Resolution")).value = 0.5
        sheet.cell(soc, column(sheet, "Description (English)")).value = "Health"

    path = edited(emit_matrix(protocol), tmp_path / "m.xlsx", edit)
    folder = tmp_path / "spec"
    shutil.copytree(root / "spec", folder)
    proposal = propose_spec(folder, protocol, read_matrix(path))
    assert lines(folder, proposal) == [
        "-    english: Pack state of health",
        "+    english: Health",
        "-    factor: 0.4",
        "+    factor: 0.5",
    ]
    assert proposal.not_written == ()
