"""New rows, texts of all kinds, and whole files in a proposal for the spec."""

from __future__ import annotations

import dataclasses
import shutil
from decimal import Decimal
from pathlib import Path

import pytest
from matrix.small_spec import FILES, TABLE, applied, changed, codes, lines, model
from matrix.workbooks import columns, edited, signal_rows
from openpyxl.worksheet.worksheet import Worksheet

from dbcspec.matrix.read import read_matrix
from dbcspec.spec.write import propose_spec
from typedcan.model.protocol import Message, Protocol, SendType, Signal


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
    for name, text in FILES.items():
        (spec / name).write_bytes(mark + text.replace("\n", end).encode())
    old = model(spec)
    new = changed(old, {"Temp": {"factor": Decimal(2), "title": "新"}, "Mode": {"title": "模式"}})
    proposal = propose_spec(spec, old, new)
    wanted = (
        TABLE.replace("factor:   0.5", "factor:   2")
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
    root: Path, protocol: Protocol, project_matrix: bytes, tmp_path: Path
) -> None:
    def edit(sheet: Worksheet) -> None:
        soc = signal_rows(sheet)["B2V_ST2_SOH"]
        sheet.cell(soc, columns(sheet)["Resolution"]).value = 0.5
        sheet.cell(soc, columns(sheet)["Description (English)"]).value = "Health"

    path = edited(project_matrix, tmp_path / "m.xlsx", edit)
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
