"""The model against the text of the standard itself, where that stands beside the checkout.

The text is recovered from a PDF: cells are parted by tabs, names wrap over lines and lose
underscores. So white space and underscores are taken out of both sides before they are compared.
"""

from __future__ import annotations

import re
from decimal import Decimal
from pathlib import Path

import pytest

from dbcspec.project import Project
from dbcspec.spec.folder import read_spec
from dbcspec.spec.rows import Spec
from typedcan.model.protocol import Protocol

LOST_IN_PRINT = {
    "B2V_ST0_Flt_FeedbackChgOC",  # its last letter became a formula
    "B2V_ST3_Neg_InsRes",  # shares a cell with the row above
    "B2V_ST4_Max_Temp",  # length and start bit wrapped away
    "B2V_ST4_MinTemp_CSCNo",  # E03
    "B2V_ST4_MinTemp_Position",  # E03
    "TMS_FaultLv",  # E02: no start bit
}
"""Signals whose row of annex A.1 is damaged; the layout of all others must be as printed."""

CUT_NAMES = {"C2B_ACStatus": "E04"}
"""Message names that the print does not have whole, and the erratum that completes them."""

PRINTED_AS = {
    "factor": r"分辨率:(-?[\d.]+)",
    "offset": r"偏移量:(-?[\d.]+)",
    "range": r"范围:\s*(-?[\d.]+~-?[\d.]+)",
    "route": r"(?:BMU|VCU|BSS|Chg|TMS)>(?:BMU|VCU|Chg|TMS)",
}
"""How the tables print what a row has under these keys."""

_FIELD = re.compile(r"B2V|V2B|B2C|C2B|BMS|TMS|BSU|Reserved")


def bare(text: str) -> str:
    return re.sub(r"[\s_]", "", text)


@pytest.fixture(scope="module")
def text(root: Path) -> str:
    path = root.parent / "shared" / "standard" / "caamtb-part3-draft.txt"
    if not path.is_file():
        pytest.skip("the text of the standard is not beside this checkout")
    return path.read_text("utf-8")


@pytest.fixture(scope="module")
def tables(text: str) -> list[str]:
    """The text from the head of each table to that of the next."""
    before_annex = text[: text.index("车辆与电池包通讯协议(Intel格式)")]
    return re.split(r"^序号\t", before_annex, flags=re.MULTILINE)[1:]


@pytest.fixture(scope="module")
def printed(root: Path) -> Spec:
    """The spec before any erratum is applied."""
    return read_spec(root / "spec", "spec")


@pytest.fixture(scope="module")
def annex(text: str) -> list[list[str]]:
    """The lines of annex A.1 as bare cells."""
    start = text.index("车辆与电池包通讯协议(Intel格式)")
    lines = text[start : text.index("修改记录单")].splitlines()
    return [[bare(cell) for cell in line.split("\t")] for line in lines if line.count("\t") > 4]


def printed_fields(annex: list[list[str]]) -> list[tuple[str, list[int]]]:
    """Names of annex A.1 with the numbers printed beside them, wrapped names joined."""
    fields: list[tuple[str, list[int]]] = []
    for cells in annex:
        words = [cell for cell in cells[4:] if cell[:1].isascii() and cell[:1].isalpha()]
        names = [word for word in words if word not in ("Event", "Cyclic")]
        if not names:
            continue
        numbers = [int(cell) for cell in cells[cells.index(names[0]) :] if cell.isdecimal()]
        if _FIELD.match(names[0]):
            fields.append((names[0], numbers))
        elif fields:
            name, above = fields[-1]
            fields[-1] = (name + names[0], numbers or above)
    return fields


def test_the_spec_has_as_many_parts_as_the_standard(project: Project) -> None:
    spec = project.spec
    fields = [field for message in spec.messages.messages for field in message.signals]
    assert len(project.protocol.messages) == 25
    assert sum(1 for _ in project.protocol.signals()) == 211
    assert sum(field.name == "Reserved" for field in fields) == 9
    assert sum(len(table.rows) for table in spec.tables) == 231


def test_every_identifier_stands_in_the_text(text: str, protocol: Protocol) -> None:
    printed = {int(number, 16) for number in re.findall(r"0[xX]([0-9A-Fa-f]{8})\b", text)}
    assert printed == {message.frame_id for message in protocol.messages}


def test_every_message_name_stands_in_the_annex(annex: list[list[str]], protocol: Protocol) -> None:
    joined = "".join(cells[1] for cells in annex)
    missing = {message.name for message in protocol.messages if bare(message.name) not in joined}
    assert missing == set(CUT_NAMES)
    assert set(CUT_NAMES.values()) <= {erratum.id for erratum in protocol.errata}


def test_every_signal_has_the_layout_printed_in_the_annex(
    annex: list[list[str]], protocol: Protocol
) -> None:
    printed = dict(printed_fields(annex))
    differing = {
        signal.name
        for _, signal in protocol.signals()
        if printed.get(bare(signal.name)) != [signal.length, signal.start]
    }
    assert differing == LOST_IN_PRINT


def test_the_annex_has_no_signal_that_the_model_lacks(
    annex: list[list[str]], protocol: Protocol
) -> None:
    known = {bare(signal.name) for _, signal in protocol.signals()}
    lost = {bare(name) for name in LOST_IN_PRINT}
    surplus = {name for name, _ in printed_fields(annex)} - known - {"Reserved"}
    # What is left is the damaged form of a lost name, or two names in one cell.
    assert len(surplus) == 4
    assert {name[:6] for name in surplus} <= {name[:6] for name in lost}


def test_the_annex_prints_nine_reserved_fields(annex: list[list[str]]) -> None:
    assert sum(cells.count("Reserved") for cells in annex) == 9


def test_every_table_has_as_many_rows_as_its_last_printed_number(
    tables: list[str], project: Project
) -> None:
    last_numbers = [re.findall(r"^\t?(\d+)\t", table, re.MULTILINE)[-1] for table in tables]
    rows = [table.rows[-1].no for table in project.spec.tables]
    assert [int(number) for number in last_numbers] == rows
    for table in project.spec.tables:
        assert [row.no for row in table.rows] == list(range(1, len(table.rows) + 1))


@pytest.mark.parametrize("key", PRINTED_AS)
def test_numbers_and_routes_are_transcribed_as_printed(
    key: str, tables: list[str], printed: Spec
) -> None:
    differing = set()
    for text, table in zip(tables, printed.tables, strict=True):
        cells = re.findall(PRINTED_AS[key], text.replace(" ", ""))
        rows = [getattr(row, key) for row in table.rows]
        if cells != [as_printed(value) for value in rows if value is not None]:
            differing.add(table.number)
    # Table 12 is broken over pages; tables 8 and 10 have a nonsense range and wrapped ones.
    assert differing == ({8, 10, 12} if key == "range" else {12})


def test_codes_and_labels_are_transcribed_as_printed(tables: list[str], printed: Spec) -> None:
    same = set()
    for text, table in zip(tables, printed.tables, strict=True):
        cells = re.findall(r'(\d+)\s*"([^"]*)"', text)
        labels = [(code, label) for row in table.rows for code, label in row.labels.items()]
        if [(int(code), bare(label)) for code, label in cells] == [
            (code, bare(label)) for code, label in labels
        ]:
            same.add(table.number)
    # In the other tables a page break or a wrapped cell tears a label apart.
    assert same == {1, 2, 3, 4, 11, 14, 15, 19, 20}


def as_printed(value: object) -> str:
    """A number, range or route as it stands in a cell."""
    match value:
        case (Decimal() as low, Decimal() as high):
            return f"{low}~{high}"
        case (sender, (receiver,)):
            return f"{sender}>{receiver}"
    return str(value)
