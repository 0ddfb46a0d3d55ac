"""Nothing moves by omission: generated classes, DBC files and simulated nodes hold safe codes.

The table is written by hand from clauses 5.2.1 to 5.5; cantools alone reads files and frames.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import cantools
import pytest
from cantools.database.can import Database
from defaults import needed_by

from swapcan import Message, encode, message_type
from swapcan.messages import MESSAGES
from swapcan.simulate import Simulation
from typedcan.simulate.simulated_bus import SimulatedBus

MUST_BE_GIVEN = None
FILES = {
    "caamtb-swap": "ascii",
    "caamtb-swap-vehicle": "ascii",
    "caamtb-swap-charger": "ascii",
    "caamtb-swap.zh": "gbk",
    "caamtb-swap.zh-utf8": "utf-8",
}


class Row(NamedTuple):
    """A signal: which raw values act, which is safe, and what it holds when nobody says more.

    ``stub`` is what a message sends where the field is not given, ``dbc`` the start value of a
    file, ``simulated`` what a simulated node sends first.
    """

    message: str
    signal: str
    acts: set[int]
    safe: int
    stub: int | None
    dbc: int
    simulated: int
    reports: bool = False


TABLE = (
    Row("V2B_CMD", "V2B_CMD_HV_OnOff", {1}, 2, 3, 3, 2),
    Row("V2B_CMD", "V2B_CMD_HV_ACC_OnOff", {1}, 2, 3, 3, 2),
    Row("V2B_CMD", "V2B_CMD_Heat_OnOff", {1}, 2, 3, 3, 2),
    Row("B2C_Charger", "B2V_S_ChargeControl", {0}, 1, MUST_BE_GIVEN, 1, 1),
    Row("BMS_TMS_0", "BMS_ReqstSetTMSts", {1, 2, 3}, 0, 0, 0, 0),
    Row("BMS_TMS_0", "BMS_ReqstTMSHVon", {0}, 1, MUST_BE_GIVEN, 1, 1),
    Row("C2B_ACStatus", "C2B_St_ChargerStart", {0}, 1, MUST_BE_GIVEN, 1, 1, reports=True),
)
over_the_table = pytest.mark.parametrize("row", TABLE, ids=lambda row: row.signal)
over_the_files = pytest.mark.parametrize("name", FILES)


def database(root: Path, name: str) -> Database:
    loaded = cantools.database.load_file(root / "dbc" / f"{name}.dbc", encoding=FILES[name])
    assert isinstance(loaded, Database)
    return loaded


def raw_values(database: Database, frame_id: int, data: bytes) -> dict[str, int]:
    message = database.get_message_by_frame_id(frame_id)
    values = message.decode(data, decode_choices=False, scaling=False)
    assert isinstance(values, dict)
    return {name: int(str(value)) for name, value in values.items()}


def field_of(row: Row) -> tuple[type[Message], str]:
    kind = message_type(row.message)
    (name,) = (name for name, part in kind.FIELDS.items() if part.dbc_name == row.signal)
    return kind, name


def test_no_line_of_the_table_holds_a_code_that_acts() -> None:
    for row in TABLE:
        assert not row.acts & {row.safe, row.stub, row.dbc, row.simulated}


def test_the_table_has_every_signal_with_codes_that_act() -> None:
    named = [
        (kind.NAME, part.dbc_name)
        for kind in MESSAGES
        for part in kind.FIELDS.values()
        if part.acting
    ]
    assert sorted(named) == sorted((row.message, row.signal) for row in TABLE)


@over_the_table
def test_a_generated_class_knows_which_codes_act_and_which_is_safe(row: Row) -> None:
    kind, name = field_of(row)
    acting = kind.FIELDS[name].acting
    assert acting
    assert sorted(acting.codes) == sorted(row.acts)
    assert (acting.safe, acting.reports) == (row.safe, row.reports)


@over_the_table
def test_a_message_holds_no_code_that_acts_where_a_field_is_not_given(row: Row, root: Path) -> None:
    kind, name = field_of(row)
    given = needed_by(kind)
    if row.stub is MUST_BE_GIVEN:
        del given[name]
        with pytest.raises(TypeError, match=name):
            kind(**given)
        return
    data = encode(kind(**given))
    sent = raw_values(database(root, "caamtb-swap"), kind.FRAME_ID, data)
    assert sent[row.signal] == row.stub


def test_every_other_field_may_be_left_out() -> None:
    required = {(row.message, field_of(row)[1]) for row in TABLE if row.stub is MUST_BE_GIVEN}
    assert required == {(kind.NAME, name) for kind in MESSAGES for name in needed_by(kind)}


@pytest.mark.parametrize(
    ("message", "text"),
    [
        ("B2V_ST0", "Fields that are not given say: Normal (23 fields)."),
        ("B2V_ST1", "say: HV open, Open, No Balancing, Not connected, Reserved,"),
        ("B2C_Charger", "Table 18 (5.3). Must be given: charge_control."),
        ("C2B_ACStatus", "say: OK (3 fields), Normal (2 fields). Must be given: charger_start."),
    ],
)
def test_the_text_of_a_class_says_what_is_stated_where_nothing_is_given(
    message: str, text: str
) -> None:
    assert text in " ".join((message_type(message).__doc__ or "").split())


def test_the_text_of_a_class_of_which_all_is_invalid_says_nothing_of_it() -> None:
    assert "not given" not in (message_type("V2B_CMD").__doc__ or "")


@over_the_files
def test_every_signal_of_a_file_has_a_start_value_and_none_acts(name: str, root: Path) -> None:
    starts = {
        (message.name, signal.name): signal.raw_initial
        for message in database(root, name).messages
        for signal in message.signals
    }
    assert None not in starts.values()
    rows = [row for row in TABLE if (row.message, row.signal) in starts]
    assert rows
    for row in rows:
        assert starts[row.message, row.signal] == row.dbc


def test_the_five_files_are_all_there_are(root: Path) -> None:
    assert {path.stem for path in (root / "dbc").glob("*.dbc")} == set(FILES)


def test_what_simulated_nodes_send_first_makes_nothing_move(root: Path) -> None:
    dbc = database(root, "caamtb-swap")
    first: dict[str, dict[str, int]] = {}
    with Simulation.simulated() as five:
        ears = [SimulatedBus(wire) for wire in five.wires]
        # The charger tests itself for half a second before it reports.
        five.world.run(1.5)
        for ear in ears:
            with ear:
                while frame := ear.recv(0):
                    kind = next(each for each in MESSAGES if frame.arbitration_id == each.FRAME_ID)
                    if kind.NAME not in first:
                        first[kind.NAME] = raw_values(dbc, kind.FRAME_ID, bytes(frame.data))
    assert {row.signal: first[row.message][row.signal] for row in TABLE} == {
        row.signal: row.simulated for row in TABLE
    }
