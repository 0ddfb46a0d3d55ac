"""Messages that are found by their PGN, as SAE J1939 has it: live, with addresses as facts."""

from __future__ import annotations

import dataclasses
import random
from pathlib import Path

import can
import cantools
import pytest
from canmatrix import ArbitrationId  # type: ignore[attr-defined]
from cantools.database.can import Database
from cantools.j1939 import frame_id_unpack
from hypothesis import given
from hypothesis import strategies as st

from swapcan import PROTOCOL
from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.model import j1939
from typedcan.model.protection import Counter
from typedcan.model.protocol import Node as NodeFacts
from typedcan.node.node import Node
from typedcan.wire.codec import Codec
from typedcan.wire.errors import SendingError, UnknownFrameError
from typedcan.wire.link import Link
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol
from typedcan.wire.receiver import Fault, Received, Receiver

FIXTURES = Path(__file__).parents[1] / "fixtures"
GROUPS = FIXTURES / "databases" / "groups.dbc"
MODEL = read_dbc(GROUPS)
SPEED = bytes.fromhex("FFFFFF401FFFFFFF")
"""1000 rpm in bytes 3 and 4, 0.125 rpm a bit."""


@pytest.fixture(scope="module")
def protocol() -> Protocol:
    return typed_protocol(MODEL)


def frame(number: int, data: bytes = SPEED, *, extended: bool = True) -> can.Message:
    return can.Message(arbitration_id=number, data=data, is_extended_id=extended)


def taken(protocol: Protocol, number: int) -> Received[Message]:
    received = Receiver(Codec(protocol)).take(frame(number))
    assert isinstance(received, Received)
    return received


def test_a_speed_is_read_from_every_source_address() -> None:
    truck = typed_protocol(read_dbc(FIXTURES / "cases" / "j1939-truck.dbc"))
    receiver = Receiver(Codec(truck))
    found = {}
    with can.LogReader(FIXTURES / "logs" / "j1939-truck.log") as log:
        for each in log:
            received = receiver.take(each)
            assert isinstance(received, Received)
            found[received.source_address] = received.message.to_raw()["WheelBasedVehicleSpeed"]
    assert found == {0x00: 16 * 256, 0x03: 32 * 256, 0xFE: 48 * 256}
    assert receiver.counts.received == 3


@pytest.mark.parametrize(
    ("number", "name"),
    [
        (0x0CF00400, "EngineOfOne"),
        (0x18F00400, "EngineOfOne"),  # of another priority
        (0x0CF004FE, "EngineOfAny"),
        (0x0CF00403, "EngineOfAny"),
        (0x0C00FEFE, "Torque"),
        (0x0C002103, "Torque"),  # to the node with the address 0x21
        (0x18FECAFE, "Whole"),
        (0x18FEC213, "Fault"),
        (0x18FEC20B, "Fault"),
    ],
)
def test_the_same_identifier_goes_before_the_same_source_and_that_before_any_source(
    protocol: Protocol, number: int, name: str
) -> None:
    assert taken(protocol, number).kind is protocol.message(name)
    assert type(Codec(protocol).decode(number, SPEED)) is protocol.message(name)


@pytest.mark.parametrize(
    ("number", "extended"),
    [
        (0x18FECA03, True),  # Whole is matched by its whole identifier
        (0x0DF00400, True),  # another data page
        (0x0CF00500, True),
        (0x0C01FEFE, True),
        (0x400, False),
        (0x4FE, False),
    ],
)
def test_a_frame_with_another_pgn_is_foreign(
    protocol: Protocol, number: int, *, extended: bool
) -> None:
    receiver = Receiver(Codec(protocol))
    assert receiver.take(frame(number, extended=extended)) is None
    assert receiver.counts.foreign == 1
    with pytest.raises(UnknownFrameError):
        Codec(protocol).decode(number, SPEED, extended=extended)


def test_remote_and_error_frames_with_a_known_pgn_are_foreign(protocol: Protocol) -> None:
    receiver = Receiver(Codec(protocol))
    assert receiver.take(can.Message(arbitration_id=0x0CF00403, is_remote_frame=True)) is None
    assert receiver.take(can.Message(arbitration_id=0x0CF00403, is_error_frame=True)) is None


def test_source_destination_and_priority_are_facts_of_what_was_received(
    protocol: Protocol,
) -> None:
    def facts(number: int) -> tuple[int | None, ...]:
        received = taken(protocol, number)
        return received.source_address, received.destination, received.priority

    assert facts(0x0CF00403) == (0x03, 0xFF, 3)
    assert facts(0x0C002117) == (0x17, 0x21, 3)
    assert facts(0x18FECAFE) == (None, None, None)  # matched by its whole identifier


@given(st.integers(0, (1 << 29) - 1))
def test_identifiers_are_read_as_two_other_libraries_read_them(number: int) -> None:
    one = ArbitrationId(number, extended=True)
    other = frame_id_unpack(number)  # type: ignore[no-untyped-call]
    assert j1939.pgn(number) & 0x1FFFF == one.pgn & 0x1FFFF
    assert j1939.source_address(number) == one.j1939_source == other.source_address
    assert j1939.priority(number) == one.j1939_priority == other.priority
    if other.pdu_format < 240:
        assert j1939.destination(number) == one.j1939_destination == other.pdu_specific
    else:
        assert j1939.destination(number) == 255


def test_a_frame_from_any_source_is_decoded_as_cantools_decodes_that_message(
    protocol: Protocol,
) -> None:
    theirs = cantools.database.load_file(GROUPS)
    assert isinstance(theirs, Database)
    chance = random.Random(1)
    for _ in range(200):
        data, source = chance.randbytes(8), chance.randrange(1, 0xFE)
        received = Receiver(Codec(protocol)).take(frame(0x0CF00400 | source, data))
        assert isinstance(received, Received)
        decoded = theirs.decode_message("EngineOfAny", data, decode_choices=False)
        assert {"AnySpeed": received.message.any_speed} == decoded  # type: ignore[attr-defined]


def test_counters_of_several_sources_do_not_disturb_each_other() -> None:
    group = next(each for each in MODEL.messages if each.name == "Fault")
    counting = dataclasses.replace(group, counter=Counter(signal="FaultCode", modulus=16))
    receiver = Receiver(Codec(typed_protocol(dataclasses.replace(MODEL, messages=(counting,)))))
    faults = []
    for number, count in ((0x18FEC203, 1), (0x18FEC204, 9), (0x18FEC203, 2), (0x18FEC204, 9)):
        received = receiver.take(frame(number, bytes((count, *[255] * 7))))
        assert isinstance(received, Received)
        faults += [fault.text for fault in received.faults]
    assert faults == ["counter stays at 9"]


def test_what_is_sent_has_the_identifier_of_the_database_from_the_address_of_the_sender(
    protocol: Protocol, near: can.BusABC
) -> None:
    def sent(name: str, link: Link, destination: int | None = None) -> int:
        kind = protocol.message(name)
        message = kind(**dict.fromkeys(kind.FIELDS, 1))
        return link.send(message, destination=destination).arbitration_id

    link, tester = Link(near, Codec(protocol)), Link(near, Codec(protocol), source_address=0xF9)
    assert sent("EngineOfAny", link) == 0x0CF00400
    assert sent("EngineOfAny", tester) == 0x0CF004F9
    assert sent("EngineOfOne", tester) == 0x0CF00400  # the database says from where
    assert sent("Whole", tester, destination=0x21) == 0x18FECAFE
    assert sent("Fault", link) == 0x18FEC213
    assert sent("Torque", link) == 0x0C00FF0B  # to all
    assert sent("Torque", tester, destination=0x21) == 0x0C0021F9
    assert sent("EngineOfAny", tester, destination=0x21) == 0x0CF004F9  # always to all
    assert sent("Plain", tester) == 0x4FF


@pytest.mark.parametrize("address", [-1, 256])
def test_what_is_no_address_is_refused(protocol: Protocol, near: can.BusABC, address: int) -> None:
    kind = protocol.message("Torque")
    with pytest.raises(ValueError, match=f"{address} is no address of J1939"):
        Link(near, Codec(protocol), source_address=address).send(kind(torque_speed=1))  # type: ignore[call-arg]
    with pytest.raises(ValueError, match=f"{address} is no address of J1939"):
        Link(near, Codec(protocol)).send(kind(torque_speed=1), destination=address)  # type: ignore[call-arg]


@pytest.mark.parametrize("address", [None, 254, 255, 65535])
def test_a_node_of_which_no_address_is_known_sends_from_the_null_address(
    near: can.BusABC, address: int | None
) -> None:
    nodes = (NodeFacts(name="Engine", address=address),)
    nobody = typed_protocol(dataclasses.replace(MODEL, nodes=nodes))
    kind = nobody.message("EngineOfAny")
    sent = Link(near, Codec(nobody)).send(kind(any_speed=1))  # type: ignore[call-arg]
    assert sent.arbitration_id == 0x0CF004FE


def test_what_takes_several_frames_is_not_sent_in_one(protocol: Protocol, near: can.BusABC) -> None:
    kind = protocol.message("Long")
    with pytest.raises(SendingError, match="no frame of classic CAN carries 39 bytes"):
        Link(near, Codec(protocol)).send(kind(**dict.fromkeys(kind.FIELDS, 1)))
    fault = Receiver(Codec(protocol)).take(frame(0x18FEEA03))
    assert isinstance(fault, Fault)
    assert fault.text == "8 bytes instead of 39"


def test_a_node_sends_from_its_address_and_hears_others_with_the_same_pgn(
    protocol: Protocol, near: can.BusABC, far: can.BusABC
) -> None:
    engine = Node(protocol, "Engine", near)
    kind = protocol.message("EngineOfAny")
    engine.send(kind(any_speed=1000.0))  # type: ignore[call-arg]
    sent = far.recv(1.0)
    assert sent
    assert sent.arbitration_id == 0x0CF00400
    far.send(sent)  # as a bus does that gives back what was sent
    far.send(frame(0x0CF00403))
    far.send(frame(0x400, extended=False))
    engine.turn()
    assert engine.counts.received == 1
    last = engine.last(kind)
    assert last
    assert (last.source_address, last.message.to_raw()) == (0x03, {"AnySpeed": 8000})
    other = Node(protocol, "Engine", near, source_address=0x27)
    other.send(kind(any_speed=1000.0))  # type: ignore[call-arg]
    sent = far.recv(1.0)
    assert sent
    assert sent.arbitration_id == 0x0CF00427


def test_the_protocol_of_the_standard_is_matched_by_whole_identifiers() -> None:
    """Several of its messages share a PGN."""
    assert not any(message.by_pgn for message in PROTOCOL.model.messages)
    groups = [j1939.pgn(message.frame_id) for message in PROTOCOL.model.messages]
    assert len(set(groups)) < len(groups)
