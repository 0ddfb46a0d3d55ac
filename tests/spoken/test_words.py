"""A codec that speaks an edition: its bytes are what the edition says, worked out by hand."""

from __future__ import annotations

from functools import reduce
from operator import xor
from typing import Any

import can
import pytest
from spoken.editions import PUMP, Command, Report, code

from typedcan.model.errors import ReadError
from typedcan.model.signal_state import SignalState
from typedcan.spoken.codec import SpokenCodec, words_of
from typedcan.wire.codec import Codec
from typedcan.wire.errors import EncodeError, UnknownMessageError
from typedcan.wire.link import Link

CODEC = SpokenCodec(PUMP, ["maker"])


def command(**values: object) -> Any:
    usual = {
        "heat": code(Command, "heat", "On"),
        "fault": code(Command, "fault", "Weld"),
        "speed": 100.0,
        "mode": code(Command, "mode", "Run"),
    }
    return Command(**(usual | values))


def test_what_is_said_is_the_edition_s_place_scale_code_checksum_and_counter() -> None:
    # Alive 1, Fault Weld = 2 at bit 12, Heat On = 2 at bit 14; 100 / 0.25 = 400, high byte first;
    # Run at bit 32; Extra, which only the edition has, starts at 0x7F; Gear has no value there: 13.
    body = bytes([0x01 | 2 << 4 | 2 << 6, 0x01, 0x90, 0x01, 0x7F, 0x0D, 0x00])
    expected = bytes([sum(body) & 0xFF]) + body
    assert CODEC.encode(command()) == expected
    frame = CODEC.frame(command(), counter=1)
    assert (frame.arbitration_id, bytes(frame.data)) == (0x18FF0001, expected)


def test_the_standard_s_own_words_are_not_changed_by_that() -> None:
    body = bytes([0x00 | 1 << 4 | 1 << 6, 200, 0, 1, 255, 15, 0])
    assert Codec(PUMP).encode(command()) == bytes([reduce(xor, body)]) + body


def test_what_is_heard_is_what_was_meant() -> None:
    heard: Any = CODEC.decode(0x18FF0001, CODEC.encode(command()))
    assert type(heard) is Command
    expected: Any = Command
    assert heard == expected(
        sum=CODEC.encode(command())[0],
        alive=1,
        heat=code(Command, "heat", "On"),
        fault=code(Command, "fault", "Weld"),
        speed=100.0,
        mode=code(Command, "mode", "Run"),
        gear=SignalState.INVALID,
        spare=SignalState.INVALID,
    )
    assert heard.heat is code(Command, "heat", "On")
    assert type(heard.speed) is float


@pytest.mark.parametrize("raw", [b"\xff\xf0", b"\xff\xff"])
def test_each_invalid_code_of_the_edition_comes_in_as_invalid(raw: bytes) -> None:
    data = bytearray(CODEC.encode(command(speed=SignalState.INVALID)))
    assert data[2:4] == b"\xff\xf0"
    data[2:4] = raw
    heard: Any = CODEC.decode(Command, bytes(data), verify=False)
    assert heard.speed is SignalState.INVALID


def mode_in(data: bytes) -> int:
    heard: Any = CODEC.decode(Command, data, verify=False)
    return int(heard.mode)


def test_a_code_without_a_word_is_no_code_of_the_vocabulary() -> None:
    data = bytearray(CODEC.encode(command()))
    data[4] = 3  # Drain, which only the edition knows; the vocabulary has no invalid code for Mode
    assert mode_in(bytes(data)) == ~3
    data[4] = 2  # without a label in the edition, where it does not mean Wash
    assert mode_in(bytes(data)) == ~2


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ({"mode": 2}, "Command.mode: maker has no code for Wash"),
        ({"mode": 3}, "Command.mode: maker has no code for 3"),
        ({"speed": SignalState.ABNORMAL}, "Command.speed: maker has no code for Abnormal"),
        ({"gear": SignalState.ABNORMAL}, "Command.gear: maker has no code for Abnormal"),
        ({"spare": 5}, "Command.spare: maker has no such signal: 5 cannot be said"),
        ({"speed": 20000.0}, "Command.speed: 20000 is out of range; allowed are 0 to 15000"),
    ],
)
def test_what_the_edition_cannot_say_is_refused_before_anything_is_sent(
    values: dict[str, object], problem: str
) -> None:
    with can.Bus("words", interface="virtual") as bus, can.Bus("words", "virtual") as far:
        with pytest.raises(EncodeError) as caught:
            Link(bus, CODEC).send(command(**values))
        assert str(caught.value) == problem
        assert far.recv(0) is None


def test_an_enum_of_another_signal_is_refused_as_always() -> None:
    with pytest.raises(EncodeError, match="is no Heat"):
        CODEC.encode(command(heat=code(Command, "fault", "Weld")))


def test_a_link_speaks_and_hears_the_edition_and_follows_its_counters() -> None:
    faults: list[str] = []
    with can.Bus("link", interface="virtual") as bus, can.Bus("link", "virtual") as far:
        link = Link(bus, CODEC)
        other = Link(far, CODEC, on_fault=lambda fault: faults.append(str(fault)))
        for _ in range(17):  # the edition counts 1 to 15
            link.send(command())
        got: list[Any] = [other.receive(Command).message for _ in range(17)]
    counters = [message.alive for message in got]
    assert counters == [*range(1, 16), 1, 2]
    assert faults == []


def test_messages_that_only_the_edition_has_come_in_classes_of_its_own() -> None:
    heard: Any = CODEC.decode(0x18FF0003, b"\x07")
    assert (heard.NAME, heard.cell) == ("Cells", 7)
    assert CODEC.encode(heard) == b"\x07"
    assert CODEC.kind(0x18FF0003, extended=True) is type(heard)
    assert CODEC.kind(0x18FF0002, extended=True) is Report


def test_a_message_that_the_edition_has_not_is_refused() -> None:
    reverse = SpokenCodec(CODEC.protocol, [])
    with pytest.raises(UnknownMessageError, match="no message class"):
        reverse.reader(Command)
    with pytest.raises(ReadError, match="did you mean 'maker'"):
        SpokenCodec(PUMP, ["make"])


def test_a_number_may_have_labels_in_the_edition_and_is_the_same_number() -> None:
    data = CODEC.encode(command(gear=1))
    assert data[6] == 1
    heard: Any = CODEC.decode(Command, data)
    assert heard.gear == 1


def test_the_gist_leaves_out_what_cannot_be_said() -> None:
    words = words_of(CODEC)
    said: Any = words.gist(command(spare=5, gear=SignalState.INVALID))
    assert said == words.said(command())
    fault = words.gist(command(speed=SignalState.INVALID))
    assert fault == words.said(command(speed=SignalState.INVALID))
    with pytest.raises(EncodeError, match="has no code for Wash"):  # and none for invalid either
        words.gist(command(mode=2))


def test_what_there_is_in_the_edition_is_known() -> None:
    words = words_of(CODEC)
    cells = CODEC.protocol.message("Cells")
    lamp = type("Lamp", (), {"NAME": "Lamp", "FRAME_ID": 1, "EXTENDED": True})
    assert [words.has(kind) for kind in (Command, cells)] == [True, True]
    assert not words.has(lamp)
    with pytest.raises(UnknownMessageError, match="maker has no message Lamp"):
        words.kind(lamp)


def test_where_nothing_is_chosen_words_are_what_they_are() -> None:
    same, message = words_of(Codec(PUMP)), command()
    assert same.said(message) is same.gist(message) is same.heard(message) is message
    assert same.kind(Command) is same.own(Command) is same.wanted(Command) is Command
    assert same.has(Command)
    assert Codec(PUMP).said(message) is message


def test_a_safe_code_is_the_edition_s() -> None:
    assert CODEC.encode(command(), safe=True)[1] >> 6 == 1
    assert Codec(PUMP).encode(command(), safe=True)[1] >> 4 & 3 == 3  # nobody knows which is spoken
