"""What goes into a matrix comes out of it again, for our protocol and for others."""

from __future__ import annotations

import dataclasses
from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from emit.other_protocol import OTHER, PLAIN, signal
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from matrix.workbooks import MATRIX

from dbcspec.compare.run import compare
from dbcspec.matrix.read import read_matrix
from dbcspec.matrix.write import emit_matrix
from typedcan.databases.dbc import read_dbc
from typedcan.model.protocol import Aspect, Code, Message, Protocol, Signal, ValueTable

_DBCS = sorted((Path(__file__).parent.parent / "fixtures" / "dbc").glob("*.dbc"))
_FACTS = (
    *("name", "start", "length", "byte_order", "signed", "is_float", "factor", "offset", "unit"),
    *("minimum", "maximum", "is_selector", "multiplexer", "selectors"),
    *("invalid_code", "abnormal_code"),
)
_NOT_CARRIED = {Aspect.TRANSFERS, Aspect.PYTHON_NAMES, Aspect.ATTRIBUTES}


def through_a_workbook(protocol: Protocol, folder: Path) -> Protocol:
    path = folder / "matrix.xlsx"
    path.write_bytes(emit_matrix(protocol))
    return read_matrix(path)


def carried(protocol: Protocol) -> Protocol:
    """The protocol without what no matrix says, such as names of Python fields and reserved bits.

    Receivers stand in the order of the nodes' columns.
    """
    order = [node.name for node in protocol.nodes]
    messages = tuple(
        dataclasses.replace(
            message,
            reserved=(),
            signals=tuple(
                dataclasses.replace(
                    each,
                    python_name="",
                    receivers=tuple(sorted(each.receivers, key=lambda name: _place(order, name))),
                )
                for each in message.signals
            ),
        )
        for message in protocol.messages
    )
    used = {each.value_table for _, each in protocol.signals() if each.value_table}
    return dataclasses.replace(
        protocol,
        messages=messages,
        transfers=(),
        requests=(),
        value_tables=tuple(sorted(used, key=lambda table: table.name)),
    )


def _place(order: list[str], name: str) -> int:
    return order.index(name) if name in order else len(order)


def test_the_project_comes_back_equal_in_everything_that_a_matrix_says(
    protocol: Protocol, project_back: Protocol
) -> None:
    assert carried(project_back) == carried(protocol)
    # Where no message is of CAN FD or J1939 a matrix may just not tell, whoever wrote it.
    assert project_back.carries == frozenset(Aspect) - _NOT_CARRIED - {Aspect.FRAME_FORMATS}
    assert compare(protocol, project_back) == []


@pytest.mark.parametrize("other", [OTHER, PLAIN], ids=lambda other: other.name)
def test_a_made_up_protocol_comes_back_equal(other: Protocol, tmp_path: Path) -> None:
    assert carried(through_a_workbook(other, tmp_path)) == carried(other)


def test_there_are_at_least_twenty_foreign_databases() -> None:
    assert len(_DBCS) >= 20


@pytest.mark.parametrize("path", _DBCS, ids=lambda path: path.stem)
def test_a_foreign_database_comes_back_and_comparing_finds_nothing(
    path: Path, tmp_path: Path
) -> None:
    foreign = read_dbc(path)
    back = through_a_workbook(foreign, tmp_path)
    assert back.carries <= foreign.carries
    for (message, one), (new_message, other) in zip(foreign.signals(), back.signals(), strict=True):
        assert (message.frame_id, message.extended) == (new_message.frame_id, new_message.extended)
        for name in _FACTS:
            assert getattr(one, name) == getattr(other, name), f"{one.name}: {name}"
        codes = [each.value_table.codes if each.value_table else () for each in (one, other)]
        assert codes[0] == codes[1]
    items = compare(foreign, back)
    assert [item for item in items if not item.text.startswith("order of receivers")] == []


def test_messages_and_signals_know_their_rows(tmp_path: Path) -> None:
    back = through_a_workbook(OTHER, tmp_path)
    row = 1
    for message in back.messages:
        row += 1
        assert (message.where.path, message.where.line) == (
            f"{tmp_path / 'matrix.xlsx'}!{MATRIX}",
            row,
        )
        for each in message.signals:
            row += 1
            assert each.where.line == row


def test_a_matrix_of_a_database_that_is_silent_stays_silent(tmp_path: Path) -> None:
    silent = dataclasses.replace(PLAIN, carries=frozenset())
    assert through_a_workbook(silent, tmp_path).carries == frozenset()


_NUMBERS = st.decimals(allow_nan=False, allow_infinity=False, places=12).map(
    lambda number: number.normalize()
)


@settings(max_examples=10, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    factors=st.lists(_NUMBERS.filter(bool), min_size=5, max_size=20),
    limits=st.lists(st.tuples(_NUMBERS, _NUMBERS), min_size=5, max_size=20),
)
def test_numbers_come_back_to_the_last_digit(
    factors: list[Decimal], limits: list[tuple[Decimal, Decimal]], tmp_path: Path
) -> None:
    signals = tuple(
        signal(f"S{place}", place, 1, factor=factor, offset=low, minimum=low, maximum=high)
        for place, (factor, (low, high)) in enumerate(zip(factors, limits, strict=False))
    )
    back = through_a_workbook(_protocol_of(*signals), tmp_path)
    for (_, one), each in zip(back.signals(), signals, strict=True):
        assert (one.factor, one.offset, one.minimum, one.maximum) == (
            each.factor,
            each.offset,
            each.minimum,
            each.maximum,
        )


@settings(max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(texts=st.lists(st.text(max_size=30).filter(str.strip), min_size=4, max_size=12))
def test_titles_and_labels_come_back_letter_by_letter(texts: list[str], tmp_path: Path) -> None:
    labels = tuple(Code(place, text, text) for place, text in enumerate(texts))
    one = signal("Texts", 0, 8, title=texts[0], unit=texts[1], value_table=ValueTable("T", labels))
    [(message, back)] = through_a_workbook(
        _protocol_of(one, title=texts[2], english=texts[3]), tmp_path
    ).signals()
    assert (back.title, back.unit, message.title, message.english) == tuple(texts[:4])
    assert back.value_table
    assert back.value_table.labels() == dict(enumerate(texts))


def test_negative_codes_come_back_with_their_sign(tmp_path: Path) -> None:
    codes = (Code(-128, "low", "low"), Code(-1, "off", "off"), Code(1, "on", "on"))
    one = signal(
        "Signed",
        0,
        8,
        signed=True,
        minimum=Decimal(-128),
        maximum=Decimal(127),
        value_table=ValueTable("T", codes),
        invalid_code=-128,
        start_value=-1,
    )
    [(_, back)] = through_a_workbook(_protocol_of(one), tmp_path).signals()
    assert back.value_table == one.value_table
    assert (back.invalid_code, back.start_value) == (-128, -1)


@pytest.mark.parametrize("value", [200, 256, -200])
def test_a_start_value_that_the_bits_cannot_hold_comes_back_as_it_is(
    value: int, tmp_path: Path
) -> None:
    one = signal("Odd", 0, 8, signed=True, start_value=value)
    [(_, back)] = through_a_workbook(_protocol_of(one), tmp_path).signals()
    assert back.start_value == value


def test_more_codes_than_a_cell_holds_come_back(tmp_path: Path) -> None:
    codes = tuple(Code(value, f"第 {value} 号", f"Number {value}" * 9) for value in range(1500))
    one = signal("Many", 0, 16, value_table=ValueTable("Many", codes))
    two = signal("After", 16, 16)
    [(_, back), (_, after)] = through_a_workbook(_protocol_of(one, two), tmp_path).signals()
    assert back.value_table == one.value_table
    assert after.value_table is None


def test_nodes_that_are_called_like_columns_are_still_nodes(tmp_path: Path) -> None:
    one = signal("One", 0, 8, receivers=("Unit", "Min"))
    back = through_a_workbook(_protocol_of(one, sender="Offset"), tmp_path)
    [(message, each)] = back.signals()
    assert (message.sender, each.receivers, each.unit) == ("Offset", ("Unit", "Min"), "")


def _protocol_of(*signals: Signal, sender: str = "ECU", **others: Any) -> Protocol:
    message = Message(name="Only", frame_id=1, length=8, sender=sender, signals=signals, **others)
    return Protocol(name="small", messages=(message,))
