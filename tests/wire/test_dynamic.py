"""Typed messages made of a model at run time, held against generated ones and against cantools."""

from __future__ import annotations

import random
from pathlib import Path

import can
import cantools
import pytest
from cantools.database.can import Database

from swapcan import PROTOCOL
from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.wire.codec import Codec
from typedcan.wire.database import database
from typedcan.wire.decoding import decoder_of
from typedcan.wire.errors import EncodeError
from typedcan.wire.link import Link
from typedcan.wire.message import Message

CASES = Path(__file__).parents[1] / "fixtures" / "databases"
MADE = typed_protocol(PROTOCOL.model)


@pytest.mark.parametrize("kind", PROTOCOL.messages, ids=lambda kind: kind.NAME)
def test_messages_made_at_run_time_carry_what_generated_ones_do(kind: type[Message]) -> None:
    generated, made, chance = Codec(PROTOCOL), Codec(MADE), random.Random(kind.FRAME_ID)
    decode = decoder_of(kind)
    sent = 0
    for _ in range(200):
        data = chance.randbytes(kind.LENGTH)
        one = generated.decode(kind.FRAME_ID, data, verify=False)
        other = made.decode(kind.FRAME_ID, data, verify=False)
        assert [getattr(other, name) for name in kind.FIELDS] == [
            getattr(one, name) for name in kind.FIELDS
        ]
        assert decode(database(PROTOCOL).by_type[kind].packer.unpack(data)) == one
        try:
            expected = generated.encode(one)
        except EncodeError:
            continue
        assert made.encode(other) == expected
        sent += 1
    assert sent


def test_what_would_act_has_to_be_given_here_too() -> None:
    kind = MADE.message("B2C_Charger")
    with pytest.raises(TypeError, match="charge_control"):
        kind()
    assert kind(charge_control=1).charge_control == 1  # type: ignore[call-arg, attr-defined]


def test_messages_of_11_bits_go_out_and_come_in_as_such(near: can.BusABC, far: can.BusABC) -> None:
    path = CASES / "tiny.dbc"
    protocol = typed_protocol(read_dbc(path))
    kind = protocol.message("STD")
    reader = cantools.database.load_file(path)
    assert isinstance(reader, Database)
    values = dict.fromkeys(kind.FIELDS, 1)
    Link(near, Codec(protocol)).send(kind(**values))
    frame = far.recv(1.0)
    assert frame is not None
    assert (frame.is_extended_id, frame.arbitration_id) == (False, kind.FRAME_ID)
    decoded = reader.decode_message(kind.NAME, bytes(frame.data), decode_choices=False)
    assert isinstance(decoded, dict)
    assert set(decoded.values()) == {1}
    far.send(frame)
    assert Link(near, Codec(protocol)).receive().message == kind(**values)


def test_one_number_in_both_widths_is_two_messages(near: can.BusABC, far: can.BusABC) -> None:
    protocol = typed_protocol(read_dbc(CASES / "both.dbc"))
    link, numbers = Link(far, Codec(protocol)), {kind.FRAME_ID for kind in protocol.messages}
    assert len(protocol.messages) == 2
    assert len(numbers) == 1
    for extended in (False, True):
        (kind,) = (each for each in protocol.messages if each.EXTENDED is extended)
        data = bytes(kind.LENGTH)
        near.send(can.Message(arbitration_id=kind.FRAME_ID, is_extended_id=extended, data=data))
        assert link.receive().kind is kind
