"""Classic CAN and CAN FD in one database: a property of each message, in frames that are sent."""

from __future__ import annotations

from pathlib import Path

import can
import cantools
import pytest
from cantools.database.can import Database

from typedcan.databases.dbc import read_any, read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.node.node import Node
from typedcan.wire.codec import Codec
from typedcan.wire.errors import SendingError
from typedcan.wire.link import Link
from typedcan.wire.protocol import Protocol
from typedcan.wire.receiver import Fault, Received, Receiver

FIXTURES = Path(__file__).parents[1] / "fixtures"
FORMATS = {
    "Classic": (False, False, 8),
    "Short": (True, True, 8),
    "Between": (True, False, 12),
    "Whole": (True, True, 64),
    "Empty": (False, False, 0),
    "Wake": (True, True, 0),
}
"""Of each message: whether it has CAN FD, the second bit rate, and how long its frames are."""


@pytest.fixture(scope="module")
def protocol() -> Protocol:
    return typed_protocol(read_dbc(FIXTURES / "databases" / "formats.dbc"))


def _filled(protocol: Protocol, name: str) -> dict[str, int]:
    return dict.fromkeys(protocol.message(name).FIELDS, 3)


@pytest.mark.parametrize("name", FORMATS)
def test_a_message_goes_out_in_frames_of_its_own_format(
    name: str, protocol: Protocol, near: can.BusABC, far: can.BusABC
) -> None:
    kind = protocol.message(name)
    Link(near, Codec(protocol)).send(kind(**_filled(protocol, name)))
    frame = far.recv(1.0)
    assert frame is not None
    assert (frame.is_fd, frame.bitrate_switch, len(frame.data)) == FORMATS[name]
    theirs = cantools.database.load_file(FIXTURES / "databases" / "formats.dbc")
    assert isinstance(theirs, Database)
    message = theirs.get_message_by_name(name)
    assert message.is_fd == frame.is_fd
    encoded = message.encode(dict.fromkeys((each.name for each in message.signals), 3))
    assert bytes(frame.data) == encoded.ljust(len(frame.data), b"\0")


def test_a_node_sends_in_the_format_of_each_message(
    protocol: Protocol, near: can.BusABC, far: can.BusABC
) -> None:
    with Node(protocol, "ECU", near) as node:
        for name in ("Classic", "Short", "Between"):
            node.set(protocol.message(name)(**_filled(protocol, name)))
            frame = far.recv(1.0)
            assert frame is not None
            assert (frame.is_fd, frame.bitrate_switch, len(frame.data)) == FORMATS[name]


def test_each_of_several_senders_sends_the_message(protocol: Protocol, near: can.BusABC) -> None:
    between = protocol.message("Between")
    assert between in protocol.sent_by("GATE")
    assert between in protocol.sent_by("ECU")
    assert between not in protocol.sent_by("BMS")
    with (
        Node(protocol, "BMS", near) as node,
        pytest.raises(SendingError, match="GATE or ECU does"),
    ):
        node.set(between(**_filled(protocol, "Between")))


def test_no_frame_carries_a_classic_message_of_twelve_bytes(
    tmp_path: Path, near: can.BusABC
) -> None:
    text = (FIXTURES / "databases" / "formats.dbc").read_text()
    path = tmp_path / "long.dbc"
    path.write_text(text.replace("Classic: 8", "Classic: 12"))
    protocol = typed_protocol(read_dbc(path))
    with pytest.raises(SendingError, match="Classic: no frame of classic CAN carries 12 bytes"):
        Link(near, Codec(protocol)).send(
            protocol.message("Classic")(**_filled(protocol, "Classic"))
        )


def test_what_says_nothing_of_formats_has_can_fd_where_nothing_else_carries_the_bytes(
    tmp_path: Path,
) -> None:
    path = tmp_path / "silent.kcd"
    path.write_text(
        '<NetworkDefinition xmlns="http://kayak.2codeornot2code.org/1.0">'
        '<Document name="x" version="1" author="a" company="c" date="2020-01-01"/><Bus name="B">'
        '<Message id="0x100" name="Short" length="8"/><Message id="0x101" name="Long" length="9"/>'
        "</Bus></NetworkDefinition>"
    )
    found = {each.name: (each.is_fd, each.bit_rate_switch) for each in read_any(path).messages}
    assert found == {"Short": (False, False), "Long": (True, True)}


@pytest.mark.parametrize(
    ("definition", "value", "switches"),
    [
        ("", "", True),
        ('BA_DEF_ BO_ "CANFD_BRS" ENUM "0","1";\nBA_DEF_DEF_ "CANFD_BRS" "0";', "", False),
        ('BA_DEF_ BO_ "CANFD_BRS" ENUM "0","1";\nBA_DEF_DEF_ "CANFD_BRS" "0";', "1", True),
        ('BA_DEF_ BO_ "CANFD_BRS" ENUM "yes","no";\nBA_DEF_DEF_ "CANFD_BRS" "yes";', "1", False),
        ('BA_DEF_ BO_ "CANFD_BRS" INT 0 1;\nBA_DEF_DEF_ "CANFD_BRS" 1;', "0", False),
    ],
)
def test_the_second_bit_rate_is_what_the_attribute_says(
    definition: str, value: str, switches: object, tmp_path: Path
) -> None:
    text = (FIXTURES / "cases" / "fdlen.dbc").read_text()
    given = f'BA_ "CANFD_BRS" BO_ 257 {value};' if value else ""
    path = tmp_path / "switch.dbc"
    path.write_text(f"{text}\n{definition}\n{given}\n")
    long, short = read_dbc(path).messages
    assert (long.is_fd, short.is_fd) == (True, True)
    assert short.bit_rate_switch == switches


def _sent(protocol: Protocol, name: str) -> can.Message:
    return Codec(protocol).frame(protocol.message(name)(**_filled(protocol, name)))


@pytest.mark.parametrize("name", FORMATS)
def test_a_frame_of_another_format_is_a_fault_and_its_message_is_there(
    name: str, protocol: Protocol
) -> None:
    receiver = Receiver(Codec(protocol))
    frame = _sent(protocol, name)
    right = receiver.take(frame)
    assert isinstance(right, Received)
    assert right.faults == ()
    frame.is_fd = not frame.is_fd
    received = receiver.take(frame)
    assert isinstance(received, Received)
    assert received.message == right.message
    assert [fault.kind for fault in received.faults] == ["format"]
    assert ("classic" in received.faults[0].text) == (not frame.is_fd)
    assert (receiver.counts.received, receiver.counts.format, receiver.counts.faults) == (2, 1, 1)


def test_nothing_is_wrong_with_a_format_of_which_the_database_says_nothing() -> None:
    silent = typed_protocol(read_dbc(FIXTURES / "databases" / "tiny.dbc"))
    receiver, frame = Receiver(Codec(silent)), _sent(silent, "STD")
    frame.is_fd = True
    received = receiver.take(frame)
    assert isinstance(received, Received)
    assert received.faults == ()


@pytest.mark.parametrize(
    ("length", "there"), [(9, False), (10, True), (11, False), (12, True), (16, False)]
)
def test_a_can_fd_payload_has_its_length_or_is_filled_up_to_the_next_one(
    length: int, there: object, protocol: Protocol
) -> None:
    receiver, frame = Receiver(Codec(protocol)), _sent(protocol, "Between")
    data = bytes(frame.data)[:10].ljust(length, b"\xff")[:length]
    frame.data, frame.dlc = bytearray(data), length
    taken = receiver.take(frame)
    assert isinstance(taken, Received) == there
    if isinstance(taken, Received):
        assert taken.data == data[:10]
        assert taken.message == Codec(protocol).decode_frame(frame)
        assert taken.message == protocol.message("Between")(**_filled(protocol, "Between"))
    else:
        assert isinstance(taken, Fault)
        assert taken.kind == "length"
