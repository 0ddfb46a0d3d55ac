"""Signals that are let pass as bits: nothing that is wrong with their values goes unsaid."""

from __future__ import annotations

from decimal import Decimal

import cantools
import pytest
from cantools.database.can import Database
from supervise.arrivals import frame

import swapcan
from swapcan import Message, Received
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import MESSAGES
from typedcan.model.protocol import Signal
from typedcan.model.signal_state import SignalState
from typedcan.supervise import SignalChanged
from typedcan.supervise.bit_places import bit_places, byte_order
from typedcan.supervise.right_codes import right_codes
from typedcan.supervise.signal_watch import WatchedField, watched_fields
from typedcan.supervise.tracked_message import TrackedMessage
from typedcan.wire.fields import PhysicalField

DATABASE = cantools.database.load_string(swapcan.dbc_text(), "dbc")
WATCHED = [(kind, field) for kind in MESSAGES for field in watched_fields(PROTOCOL, kind).values()]


def raw_bounds(field: WatchedField) -> tuple[int, int]:
    """The lowest and the highest raw value that are let pass."""
    unit = field.mask & -field.mask
    return field.low // unit, field.high // unit


@pytest.mark.parametrize(("kind", "field"), WATCHED, ids=lambda each: getattr(each, "name", ""))
def test_a_signal_is_reported_exactly_where_its_decoded_value_is_wrong(
    kind: type[Message], field: WatchedField
) -> None:
    signal = kind.FIELDS[field.name]
    last = (1 << signal.length) - 1
    edges = {0, last, *raw_bounds(field), *signal.states}
    near = {raw + step for raw in edges for step in (-1, 0, 1)}
    values = {1 << bit for bit in range(signal.length)} | {raw for raw in near if 0 <= raw <= last}
    # What tells the frames apart of a message that takes several.
    numbers = {"FrameNo": 1} if kind.NAME in ("B2V_Ucell", "B2V_Temp", "V2B_VIN") else {}
    for raw in range(last + 1) if last < 256 else sorted(values):
        came = frame(kind.NAME, **(numbers | {signal.dbc_name: raw}))
        message = swapcan.decode(kind.FRAME_ID, bytes(came.data), verify=False)
        events = TrackedMessage(kind, PROTOCOL).take(Received(message, came), 0.0, 0.0)
        told = [
            event.kind
            for event in events
            if isinstance(event, SignalChanged) and event.field == field.name
        ]
        wrong = field.judge(getattr(message, field.name))
        assert told == ([] if wrong is None else [wrong]), raw


@pytest.mark.parametrize("field", [field for _, field in WATCHED], ids=lambda field: field.name)
def test_an_ordinary_value_needs_no_decoding(field: WatchedField) -> None:
    low, high = raw_bounds(field)
    assert low <= high


def test_the_lowest_values_that_are_right_are_let_pass() -> None:
    """Raw 0 to 1000 without 300 and 301: those below."""
    field = PhysicalField(
        signal=Signal(name="X", start=0, length=12, minimum=Decimal(0), maximum=Decimal(1000)),
        name="x",
        dbc_name="X",
        title="",
        length=12,
        minimum=0,
        maximum=1000,
        states={300: SignalState.INVALID, 301: SignalState.ABNORMAL},
    )
    assert right_codes(field, lambda _: None) == range(300)


def test_where_signals_stand_is_where_cantools_packs_them() -> None:
    assert isinstance(DATABASE, Database)
    for kind in MESSAGES:
        known = DATABASE.get_message_by_name(kind.NAME)
        zeros = {signal.name: 0 for signal in known.signals}
        for name, (mask, shift) in bit_places(PROTOCOL)[kind].items():
            field = kind.FIELDS[name]
            highest = zeros | {field.dbc_name: (1 << field.length) - 1}
            lowest = zeros | {field.dbc_name: 1}
            order = byte_order(kind)
            packed = [
                int.from_bytes(known.encode(raw, scaling=False, strict=False), order)
                for raw in (highest, lowest)
            ]
            assert packed[0] == mask
            assert shift is None or packed[1] == 1 << shift
