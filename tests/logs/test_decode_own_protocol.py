"""Every signal of this package's own DBC, as values, raw numbers, states and labels."""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum
from random import Random
from typing import Any

import cantools
import pytest
from cantools.database.can import Database
from logs.decode_databases import Frame, block_of, payload

import swapcan
from swapcan.log_protocol import OWN
from swapcan.messages import MESSAGES
from typedcan.logs.columns import Column, State
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameFlag
from typedcan.logs.plan import Mode
from typedcan.model.signal_state import SignalState


@pytest.fixture(scope="module")
def database() -> Database:
    loaded = cantools.database.load_string(swapcan.dbc_text(), "dbc")
    assert isinstance(loaded, Database)
    return loaded


@pytest.fixture(scope="module")
def frames() -> list[Frame]:
    """Every message with every byte the same, whatever that is, and with random bytes."""
    source = Random(1)
    payloads = [bytes([byte]) * 8 for byte in range(256)]
    payloads += [payload(source, 8) for _ in range(50)]
    found = [
        Frame(kind.FRAME_ID, data[: kind.LENGTH], FrameFlag.EXTENDED)
        for kind in MESSAGES
        for data in payloads
    ]
    source.shuffle(found)
    return found


def items(column: Column) -> list[Any]:
    """The values as Python has them, None where there is none."""
    valid = [True] * len(column.values) if column.valid is None else column.valid.tolist()
    return [v if ok else None for v, ok in zip(column.values.tolist(), valid, strict=True)]


def decoded(
    database: Database, frames: list[Frame], decoder: Decoder
) -> Iterator[tuple[Frame, dict[str, Any]]]:
    for message in decoder.decode(block_of(frames)).messages.values():
        values = {name: items(column) for name, column in message.columns.items()}
        for at, row in enumerate(message.rows):
            yield frames[row], {name: of_all[at] for name, of_all in values.items()}


@pytest.mark.parametrize("mode", [Mode.RAW, Mode.PHYSICAL])
def test_all_signals_are_as_cantools_has_them(
    database: Database, frames: list[Frame], mode: Mode
) -> None:
    seen = 0
    for frame, values in decoded(database, frames, Decoder(OWN.messages, mode=mode)):
        expected = database.decode_message(
            frame.frame_id, frame.data, decode_choices=False, scaling=mode is Mode.PHYSICAL
        )
        assert values == expected
        seen += 1
    assert seen == len(frames)


def test_reserved_codes_are_null_and_have_the_state_that_the_messages_show(
    database: Database, frames: list[Frame]
) -> None:
    states: dict[int, SignalState] = {
        State.INVALID: SignalState.INVALID,
        State.ABNORMAL: SignalState.ABNORMAL,
    }
    result = Decoder(OWN.messages, reserved=OWN.reserved).decode(block_of(frames))
    met = set()
    for name, message in result.messages.items():
        kind = next(kind for kind in MESSAGES if name == kind.NAME)
        shown = [
            swapcan.decode(kind.FRAME_ID, frames[row].data, verify=False) for row in message.rows
        ]
        for part in kind.FIELDS.values():
            column = message.columns[part.dbc_name]
            found = [0] * len(shown) if column.state is None else column.state.tolist()
            assert [value is None for value in items(column)] == [state > 0 for state in found]
            for state, stub in zip(found, shown, strict=True):
                field = getattr(stub, part.name)
                # What has labels shows such a code as one of them.
                said = part.states.get(field) if isinstance(field, IntEnum) else field
                assert states.get(state) is (said if isinstance(said, SignalState) else None)
                met.add(state)
    assert met == set(State)


def test_labelled_signals_keep_their_codes_and_carry_the_labels(
    database: Database, frames: list[Frame]
) -> None:
    decoder = Decoder(OWN.messages, mode=Mode.LABELS, reserved=OWN.reserved)
    columns = decoder.decode(block_of(frames)).messages["V2B_CMD"].columns
    relay = columns["V2B_CMD_MainPosRelayST"]
    assert relay.signal.encoded
    assert relay.signal.labels == {0: "Reserved", 1: "Open", 2: "Closed", 3: "Signal Invalid"}
    assert relay.valid is None
    assert set(relay.values.tolist()) == {0, 1, 2, 3}


def test_a_label_that_says_invalid_only_does_not_make_a_measured_value_a_label(
    database: Database, frames: list[Frame]
) -> None:
    decoder = Decoder(OWN.messages, mode=Mode.LABELS, reserved=OWN.reserved)
    columns = decoder.decode(block_of(frames)).messages["B2V_ST3"].columns
    resistance = columns["B2V_ST3_Pos_InsRes"]
    assert resistance.signal.labels == {65535: "Signal Invalid"}
    assert not resistance.signal.encoded
    assert resistance.signal.unit == "kohm"
    assert None in items(resistance)


@pytest.mark.parametrize(
    ("message", "signal", "physical", "raw"),
    [
        ("V2B_CMD", "V2B_CMD_MainPosRelayST", "u1", "u1"),
        ("B2V_ST2", "B2V_ST2_SOC", "f8", "u1"),
        ("B2V_ST2", "B2V_ST2_Current", "f8", "u2"),
    ],
)
def test_a_column_has_the_smallest_type_that_holds_its_values(
    database: Database, frames: list[Frame], message: str, signal: str, physical: str, raw: str
) -> None:
    for mode, expected in ((Mode.PHYSICAL, physical), (Mode.RAW, raw)):
        found = Decoder(OWN.messages, mode=mode).decode(block_of(frames))
        column = found.messages[message].columns[signal]
        assert column.values.dtype == expected
        assert column.values.flags.c_contiguous
