"""What is received is checked at once and decoded when it is read."""

from __future__ import annotations

from unittest.mock import ANY

import can
import cantools
import pytest
from cantools.database.can import Database
from defaults import default_of
from hypothesis import given
from hypothesis import strategies as st

import swapcan
from swapcan import ChecksumError, Codec, DecodeError, LengthError, Message, Received
from swapcan.messages import B2V_ST1, B2V_ST2, B2V_ST3, MESSAGES
from swapcan.wire import Receiver

DATABASE = cantools.database.load_string(swapcan.dbc_text(), "dbc")


def soc(raw: int) -> can.Message:
    """A frame of B2V_ST2 that holds this state of charge in its first byte."""
    data = swapcan.encode(B2V_ST2(soc=raw * 0.4))
    return can.Message(arbitration_id=B2V_ST2.FRAME_ID, data=data)


def taken(receiver: Receiver, frame: can.Message) -> Received[Message]:
    """What a receiver makes of a frame that is in order."""
    received = receiver.take(frame)
    assert isinstance(received, Received)
    return received


def test_it_holds_what_came_though_the_frame_is_changed_before_it_is_read() -> None:
    """As a gateway does that sends the frame on with another value."""
    frame = soc(100)
    received = taken(Receiver(), frame)
    frame.data[:] = soc(200).data
    assert received.message == B2V_ST2(soc=40.0)
    assert received.data == bytes(soc(100).data)


def test_its_kind_is_that_of_its_message() -> None:
    received = taken(Receiver(), soc(1))
    assert received.kind is type(received.message) is B2V_ST2
    assert Received(B2V_ST3(), soc(1)).kind is B2V_ST3


def test_it_is_equal_to_one_with_the_same_message_frame_and_faults() -> None:
    frame = soc(50)
    received = taken(Receiver(), frame)
    same = Received(B2V_ST2(soc=20.0), frame)
    assert received == same
    assert hash(received) == hash(same)
    assert received != Received(B2V_ST2(soc=20.4), frame)
    assert received != received.message
    assert received == ANY  # which says so itself, where it is asked
    assert repr(received) == repr(same)


def test_its_message_cannot_be_replaced() -> None:
    received = taken(Receiver(), soc(50))
    with pytest.raises(AttributeError):
        received.message = B2V_ST2()  # type: ignore[misc]


@given(st.lists(st.tuples(st.integers(0, 255), st.integers(0, 255)), max_size=400))
def test_what_was_decoded_before_changes_no_message(raws: list[tuple[int, int]]) -> None:
    assert isinstance(DATABASE, Database)
    codec = Codec()
    for first, second in raws:
        data = bytes((first, second, *[0] * 6))
        message = codec.decode(B2V_ST2.FRAME_ID, data)
        plain = DATABASE.decode_message(B2V_ST2.FRAME_ID, data, scaling=False, decode_choices=False)
        assert message.to_raw() == plain


def test_the_payload_of_a_class_is_decoded_as_a_frame_with_its_identifier_is() -> None:
    data = bytes(soc(50).data)
    assert swapcan.decode(B2V_ST2, data) == swapcan.decode(B2V_ST2.FRAME_ID, data)
    assert swapcan.decode(B2V_ST2, data).soc == 20.0
    wrong = bytes.fromhex("0029400000000000")
    assert swapcan.decode(B2V_ST1, wrong, verify=False).aliv == 9


def test_a_payload_that_is_none_of_the_class_is_a_decode_error() -> None:
    with pytest.raises(LengthError, match=r"B2V_ST2 has 8 bytes, the frame has 7$"):
        swapcan.decode(B2V_ST2, bytes(7))
    with pytest.raises(ChecksumError, match=r"B2V_ST1 has checksum 0x00, its bytes make 0x69$"):
        swapcan.decode(B2V_ST1, bytes.fromhex("0029400000000000"))
    for other in (Message, int):
        with pytest.raises(
            DecodeError, match=r"^frame 0x00000000 \[00\]: .+ is no message class of"
        ):
            swapcan.decode(other, bytes(1))  # type: ignore[type-var]


def test_every_message_is_decoded_by_its_class() -> None:
    for kind in MESSAGES:
        data = swapcan.Codec().encode(default_of(kind), renew=True)
        assert type(swapcan.decode(kind, data)) is kind
