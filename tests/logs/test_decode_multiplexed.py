"""Multiplexed messages, by hand: a signal of a branch that a frame has not is null."""

from __future__ import annotations

from collections import OrderedDict

import pytest
from cantools.database.can import Message, Signal
from cantools.database.conversion import BaseConversion
from logs.decode_databases import Frame, block_of, model_of

from typedcan.dynamic import typed_protocol
from typedcan.logs.columns import Column, State
from typedcan.logs.decode import Decoder
from typedcan.logs.plan import Mode
from typedcan.model import protocol as model
from typedcan.wire.codec import Codec


def nested() -> tuple[model.Message, ...]:
    """Page selects Low (0), Sub (1, 2); Sub selects Deep (7) and is labelled at 3."""
    low = Signal("Low", 8, 8, multiplexer_signal="Page", multiplexer_ids=[0])
    sub = Signal("Sub", 8, 4, multiplexer_signal="Page", multiplexer_ids=[1, 2])
    sub.is_multiplexer = True
    sub.conversion = BaseConversion.factory(choices=OrderedDict({3: "nothing"}))
    deep = Signal("Deep", 12, 4, multiplexer_signal="Sub", multiplexer_ids=[7])
    page = Signal("Page", 0, 8, is_multiplexer=True)
    return model_of([Message(1, "M", 3, [page, low, sub, deep, Signal("Always", 16, 8)])])


FRAMES = [
    Frame(1, bytes([0, 0x11, 1])),
    Frame(1, bytes([1, 0x57, 2])),
    Frame(1, bytes([2, 0x03, 3])),
    Frame(1, bytes([9, 0x00, 4])),  # no such page
    Frame(1, bytes([1, 0x05, 5])),  # no such Sub
]


def items(column: Column) -> list[object]:
    valid = [True] * len(column.values) if column.valid is None else column.valid.tolist()
    return [v if ok else None for v, ok in zip(column.values.tolist(), valid, strict=True)]


def test_signals_of_other_branches_are_null() -> None:
    found = Decoder(nested()).decode(block_of(FRAMES)).messages["M"]
    assert found.rows.tolist() == [0, 1, 2, 3, 4]
    assert {name: items(column) for name, column in found.columns.items()} == {
        "Page": [0, 1, 2, 9, 1],
        "Low": [0x11, None, None, None, None],
        "Sub": [None, 7, 3, None, 5],
        "Deep": [None, 5, None, None, None],
        "Always": [1, 2, 3, 4, 5],
    }


def test_a_value_that_selects_nothing_and_has_no_label_is_counted() -> None:
    counts = Decoder(nested()).decode(block_of(FRAMES)).counts
    assert counts.without_branch == {"M": 2}
    assert counts.decoded == {"M": 5}


@pytest.mark.parametrize("mode", [Mode.PHYSICAL, Mode.RAW])
def test_a_selector_with_a_scaling_is_compared_by_its_raw_value(mode: Mode) -> None:
    page = Signal("Page", 0, 8, is_multiplexer=True)
    page.conversion = BaseConversion.factory(scale=0.5, offset=10)
    low = Signal("Low", 8, 8, multiplexer_signal="Page", multiplexer_ids=[3])
    database = model_of([Message(1, "M", 2, [page, low])])
    frames = [Frame(1, bytes([3, 7])), Frame(1, bytes([11, 8]))]
    found = Decoder(database, mode=mode).decode(block_of(frames)).messages["M"]
    assert items(found.columns["Low"]) == [7, None]
    codec = Codec(typed_protocol(model.Protocol(name="x", messages=database)))
    typed = [codec.decode(1, each.data, extended=False) for each in frames]
    assert [message.to_raw() for message in typed] == [{"Page": 3, "Low": 7}, {"Page": 11}]


@pytest.mark.parametrize("wanted", ["Deep", "Always"])
def test_which_frames_are_decoded_does_not_depend_on_the_signals_asked_for(wanted: str) -> None:
    every = Decoder(nested()).decode(block_of(FRAMES)).messages["M"]
    one = Decoder(nested(), wanted={"M": [wanted]}).decode(block_of(FRAMES)).messages["M"]
    assert list(one.columns) == [wanted]
    assert one.rows.tolist() == every.rows.tolist()
    assert items(one.columns[wanted]) == [*items(every.columns[wanted])]


def test_an_absent_signal_has_no_state() -> None:
    reserved = {("M", "Low"): {0x11: State.INVALID, 0x57: State.ABNORMAL}}
    found = Decoder(nested(), reserved=reserved).decode(block_of(FRAMES)).messages["M"]
    column = found.columns["Low"]
    assert column.state is not None
    assert column.state.tolist() == [State.INVALID, *[State.VALUE] * 4]
    assert items(column) == [None] * 5
