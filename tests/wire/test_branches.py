"""Multiplexed messages: what is sent and what is there, branch by branch, as cantools has it."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import cantools.database
import pytest
from cantools.database.can import Database

from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.wire.codec import Codec
from typedcan.wire.errors import EncodeError
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

FIXTURES = Path(__file__).parents[1] / "fixtures"
MUX = typed_protocol(read_dbc(FIXTURES / "cases" / "mux.dbc"))
NESTED = typed_protocol(read_dbc(FIXTURES / "databases" / "nested.dbc"))


def _made(protocol: Protocol, name: str, **values: object) -> Message:
    given: Any = values
    return protocol.message(name)(**given)


def _cantools(path: Path, name: str) -> Any:
    database = cantools.database.load_file(path, sort_signals=None)
    assert isinstance(database, Database)
    return database.get_message_by_name(name)


@pytest.mark.parametrize(
    ("values", "data"),
    [
        ({"sel": 0, "x": 4660.5}, "000db6"),
        ({"sel": 1, "y": -2, "z": 7}, "01fe07"),
    ],
)
def test_each_branch_is_sent_and_received(values: dict[str, Any], data: str) -> None:
    codec, message = Codec(MUX), _made(MUX, "MUX", **values)
    payload = codec.encode(message)
    assert payload == bytes.fromhex(data).ljust(8, b"\0")
    names = {"sel": "Sel", "x": "X", "y": "Y", "z": "Z"}
    theirs = _cantools(FIXTURES / "cases" / "mux.dbc", "MUX")
    assert payload == theirs.encode({names[name]: value for name, value in values.items()})
    assert codec.decode(256, payload) == message


def test_a_selector_without_a_branch_is_there_alone_and_can_be_sent() -> None:
    codec = Codec(MUX)
    message = codec.decode(256, bytes([0xF7]) * 8)
    assert message == _made(MUX, "MUX", sel=7)
    assert codec.encode(message) == bytes([7]).ljust(8, b"\0")


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ({"sel": 1, "y": 1}, r"MUX\.z: has to be given where sel is 1"),
        ({"sel": 1}, r"MUX\.y: has to be given where sel is 1"),
        ({"sel": 0, "x": 1.0, "y": 1}, r"MUX\.y: is of another branch: sel is 0"),
        ({"sel": 7, "x": 1.0}, r"MUX\.x: is of another branch: sel is 7"),
        ({"sel": 16}, r"MUX\.sel: 16 is out of range"),
    ],
)
def test_only_the_fields_of_the_branch_are_taken_and_all_of_them(
    values: dict[str, Any], problem: str
) -> None:
    with pytest.raises(EncodeError, match=problem):
        Codec(MUX).encode(_made(MUX, "MUX", **values))


PAYLOADS = random.Random(5)


@pytest.mark.parametrize("outer", range(4))
@pytest.mark.parametrize("inner", range(6))
def test_branches_in_branches_are_those_that_cantools_finds(outer: int, inner: int) -> None:
    """Outer 0 has Inner with branches 0 to 2 and 4; 1 a float, 2 one of 64 bits, 3 nothing."""
    theirs, codec = _cantools(FIXTURES / "databases" / "nested.dbc", "Nested"), Codec(NESTED)
    kind = NESTED.message("Nested")
    for _ in range(20):
        data = bytes([outer | inner << 2]) + PAYLOADS.randbytes(kind.LENGTH - 1)
        mine = codec.decode(kind.FRAME_ID, data)
        there = {
            field.dbc_name: getattr(mine, field.name)
            for field in kind.FIELDS.values()
            if getattr(mine, field.name) is not None
        }
        if outer == 3 or (outer == 0 and inner in (3, 5)):
            assert there.keys() == ({"Outer", "Always"} if outer else {"Outer", "Always", "Inner"})
            continue
        values: Any = theirs.decode(data, decode_choices=False)
        assert there == values
        if outer == 1 and not abs(there["Ratio"]) < float("inf"):
            continue
        again = codec.encode(mine)
        assert again == theirs.encode(values, strict=False)
        assert codec.decode(kind.FRAME_ID, again) == mine


def test_a_selector_behind_the_signals_of_its_branch_selects_them() -> None:
    """Also where its raw values have no labels, and where it is in a branch itself."""
    codec = Codec(typed_protocol(read_dbc(FIXTURES / "dbc" / "selectors_behind.dbc")))
    decoded = codec.decode(256, bytes.fromhex("2A00070000C80000"))  # Outer is 200, Inner 7
    assert decoded == _made(codec.protocol, "Pages", outer=200, inner=7, detail=42)
    decoded = codec.decode(256, bytes.fromhex("FE00FF0000800000"))
    assert decoded == _made(codec.protocol, "Pages", outer=128, inner=255, depth=-4.0)
    decoded = codec.decode(256, bytes.fromhex("0000341201020304"))
    assert decoded == _made(codec.protocol, "Pages", outer=2, last=1, deep=0x0304)


def test_labels_that_are_letters_make_letters_where_nothing_is_scaled() -> None:
    codec = Codec(typed_protocol(read_dbc(FIXTURES / "dbc" / "selectors_behind.dbc")))
    message = codec.decode(257, bytes.fromhex("41414141FF000000"))
    made = _made(
        codec.protocol, "Letters", scaled=33.5, moved=55.0, plain="A", numbers=65, signed=-1
    )
    assert message == made
    assert codec.encode(message) == bytes.fromhex("41414141FF000000")
    shown = {each.name: each.text(getattr(message, each.name)) for each in message.FIELDS.values()}
    assert shown == {
        "scaled": "33.5",
        "moved": "55",
        "plain": "A",
        "numbers": "66",
        "signed": "0xFF",
    }
