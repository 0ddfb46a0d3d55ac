"""Readings by groups of a protocol that is not this standard's, from nothing but its model."""

from __future__ import annotations

from dataclasses import replace
from decimal import Decimal
from typing import Any

import pyarrow as pa
import pytest
from logs.decode_databases import Frame, block_of

from typedcan.logs.decode import Decoder
from typedcan.logs.protocol import known
from typedcan.logs.transfers.tables import TransferTables
from typedcan.model.protocol import Message, Protocol, Signal
from typedcan.model.transfer import Numbering, Transfer


def signal(name: str, start: int, length: int = 8, **facts: Any) -> Signal:
    return Signal(
        name=name,
        start=start,
        length=length,
        minimum=Decimal(0),
        maximum=Decimal((1 << length) - 1),
        **facts,
    )


LOADS = Message(
    name="Loads",
    frame_id=0x120,
    extended=False,
    length=4,
    sender="Rack",
    period=100,
    signals=(
        signal("Shelf", 0),
        signal("Part", 8),
        signal("Left", 16, factor=Decimal("0.5"), unit="kg"),
        signal("Right", 24, factor=Decimal("0.5"), unit="kg"),
    ),
)
TOTALS = Message(
    name="Totals",
    frame_id=0x121,
    extended=False,
    length=2,
    sender="Rack",
    signals=(signal("Shelves", 0), signal("Loads_", 8)),
)
SHELF_LOADS = Transfer(
    name="shelf_loads",
    english="Loads of all shelves",
    kind="readings_by_group",
    messages=("Loads",),
    items=("Left", "Right"),
    count_signal="Loads_",
    frame_number="Part",
    group="Shelf",
    groups_signal="Shelves",
    numbering=Numbering.WITHIN_GROUP,
)
RACK = Protocol(name="rack", messages=(LOADS, TOTALS), transfers=(SHELF_LOADS,))
FRAMES = [
    Frame(0x121, bytes([2, 4])),
    Frame(0x120, bytes([1, 1, 10, 20])),
    Frame(0x120, bytes([2, 1, 30, 40])),
]


def rows(frames: list[Frame] = FRAMES, **facts: Any) -> dict[str, list[dict[str, Any]]]:
    """The rows of all tables, by their names."""
    protocol = known(replace(RACK, transfers=(replace(SHELF_LOADS, **facts),)))
    block = block_of(frames)
    block.timestamp[:] = [0.0, 0.01, 0.02]
    block.channel[:] = 0
    shape = TransferTables(protocol)
    decoded = Decoder(protocol.messages, reserved=protocol.reserved).decode(block)
    batches = [*shape.take(decoded), *shape.finish()]
    return {name: pa.Table.from_batches([batch]).to_pylist() for name, batch in batches}


def test_tables_and_columns_are_called_like_the_transfer() -> None:
    [(name, [row])] = rows().items()
    assert name == "shelf_loads_2x2"
    loads = {key: value for key, value in row.items() if not key.endswith(".state")}
    assert loads == {
        "timestamp": 0.02,
        "channel": "can0",
        "shelf_loads_1_1": 5.0,
        "shelf_loads_1_2": 10.0,
        "shelf_loads_2_1": 15.0,
        "shelf_loads_2_2": 20.0,
    }


def test_tables_and_columns_have_the_names_that_are_given() -> None:
    [(name, [row])] = rows(table="loads", column="load").items()
    assert name == "loads_2x2"
    assert row["load_2_1"] == 15.0


@pytest.mark.parametrize(
    "lacking",
    [
        {"group": ""},
        {"groups_signal": ""},
        {"count_signal": ""},
        {"items": ("Left", "Gone")},
        {"items": ("Left", "Shelves")},
        {"kind": "numbered_blocks"},
    ],
)
def test_a_transfer_that_does_not_fit_its_kind_makes_no_table(lacking: dict[str, Any]) -> None:
    protocol = replace(RACK, transfers=(replace(SHELF_LOADS, **lacking),))
    assert known(protocol).readings == ()


@pytest.mark.parametrize(
    "fixed",
    [
        {"groups_signal": "", "groups": 2},
        {"count_signal": "", "count": 4},
        {"groups_signal": "", "count_signal": "", "groups": 2, "count": 4},
        {"groups_signal": "", "count_signal": "", "counts": (2, 2)},
    ],
)
def test_what_the_protocol_fixes_need_not_be_told(fixed: dict[str, Any]) -> None:
    [(name, [row])] = rows(**fixed).items()
    assert name == "shelf_loads_2x2"
    assert row["shelf_loads_2_2"] == 20.0


def test_frames_that_are_numbered_through_all_groups_are_put_in_their_place() -> None:
    numbered = [
        Frame(0x121, bytes([2, 4])),
        Frame(0x120, bytes([1, 1, 10, 20])),
        Frame(0x120, bytes([2, 2, 30, 40])),
    ]
    [(name, [row])] = rows(numbered, numbering=Numbering.THROUGH).items()
    assert name == "shelf_loads_2x2"
    assert row["shelf_loads_2_1"] == 15.0
