"""The decoder and cantools agree on every frame of any database."""

from __future__ import annotations

import math
import struct
from random import Random
from typing import Any

import numpy as np
import pytest
from cantools.database.can import Message
from hypothesis import given, settings
from hypothesis import strategies as st
from logs.decode_databases import (
    Frame,
    block_of,
    databases,
    decoded_by_cantools,
    model_of,
    traffic,
)

from typedcan.logs.columns import Column, MessageColumns
from typedcan.logs.decode import Decoder
from typedcan.logs.plan import Mode


def assert_same(column: Column, row: int, expected: Any) -> None:
    value = column.values[row]
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(expected, float):
        assert isinstance(value, float)
        same = struct.pack("<d", value) == struct.pack("<d", expected)
        assert same or (math.isnan(value) and math.isnan(expected))
    else:
        assert value == expected


def assert_agrees(
    found: MessageColumns | None, message: Message, frames: list[Frame], *, scaling: bool
) -> None:
    """Those frames, and no others, that cantools decodes, with its values."""
    expected: dict[int, dict[str, Any]] = {}
    for row, frame in enumerate(frames):
        if (frame.frame_id, int(frame.flags)) == (message.frame_id, message.is_extended_frame):
            values = decoded_by_cantools(message, frame.data, scaling=scaling)
            if values is not None:
                expected[row] = values
    if found is None:
        assert not expected
        return
    assert found.rows.tolist() == list(expected)
    for at, values in enumerate(expected.values()):
        for name, column in found.columns.items():
            if column.valid is None or column.valid[at]:
                assert_same(column, at, values[name])
            else:
                assert name not in values
        assert values.keys() <= found.columns.keys()


@settings(max_examples=100)
@pytest.mark.parametrize("mode", [Mode.PHYSICAL, Mode.RAW])
@given(databases(), st.integers(0, 1 << 32), st.sampled_from([None, 64]))
def test_every_frame_decodes_as_cantools_does(
    mode: Mode, database: list[Message], seed: int, width: int | None
) -> None:
    frames = traffic(database, Random(seed), 60)
    decoder = Decoder(model_of(database), mode=mode)
    decoded = decoder.decode(block_of(frames, width))
    for message in database:
        found = decoded.messages.get(message.name)
        assert_agrees(found, message, frames, scaling=mode is Mode.PHYSICAL)
    counts = decoded.counts
    assert counts.decoded.total() + counts.too_short.total() == counts.frames == len(frames)
