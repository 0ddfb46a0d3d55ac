"""Every kind of transfer, of a protocol that is not this standard's: its bytes, and back."""

from __future__ import annotations

from typing import Any

import pytest
from transfer.rack import project, rack

from typedcan.model.signal_state import SignalState
from typedcan.transfer import (
    Assembler,
    Blocks,
    Problem,
    Reading,
    Readings,
    Text,
    TransferError,
    Transfers,
    split,
)
from typedcan.wire.codec import Codec
from typedcan.wire.message import Message

INVALID = SignalState.INVALID
CODEC = Codec(rack())
REST: dict[int, list[Reading]] = {1: [30.0] * 3, 2: [40.0] * 2}


def frames(name: str, value: Any) -> list[str]:
    """The bytes of the frames that carry a value, in hexadecimal."""
    return [CODEC.encode(message).hex() for message in split(rack().transfer(name), value)]


def delivered(name: str, *payloads: str) -> list[Message]:
    """Frames of the first message of a transfer, as the other side has them."""
    message = rack().transfer(name).messages[0]
    return [CODEC.decode(message.FRAME_ID, bytes.fromhex(p), extended=False) for p in payloads]


def arrived(name: str, value: Any) -> list[Message]:
    """The frames that carry a value, as the other side has them."""
    return [
        CODEC.decode(type(message).FRAME_ID, CODEC.encode(message), extended=False)
        for message in split(rack().transfer(name), value)
    ]


def outcomes(name: str, messages: list[Message], step: float = 0.01) -> list[Any]:
    """What an assembler tells of messages that come one after the other."""
    assembler = Assembler[Any](rack().transfer(name))
    return [each for n, m in enumerate(messages) for each in assembler.take(m, n * step)]


def totals(shelves: int, weights: int) -> Message:
    [message] = (m for m in rack().messages if m.NAME == "TOTALS")
    return CODEC.decode(message.FRAME_ID, bytes([shelves, weights]), extended=False)


def test_the_document_shows_every_kind_and_lint_finds_nothing_in_it() -> None:
    kinds = {transfer.kind for transfer in project().protocol.transfers}
    assert kinds == {
        "text_over_frames",
        "text_over_messages",
        "readings_by_group",
        "numbered_blocks",
    }
    assert project().findings() == []


def test_a_text_over_frames_is_numbered_from_0_and_ends_at_its_fill() -> None:
    # GBK: 电 B5E7, 池 B3D8, 架 BCDC.
    own = frames("name", "电池架 1")
    assert own == ["0000b5e7b3d8bcdc", "01002031ffffffff", "0200ffffffffffff"]
    [text] = outcomes("name", delivered("name", *own, *own))
    assert text == Text("name", "电池架 1", {}, at=0.05)


def test_a_text_of_two_byte_characters_that_is_cut_in_half_is_no_text() -> None:
    own = ["0000b5e7b3ffffff", "0100ffffffffffff", "0200ffffffffffff"]
    [problem] = outcomes("name", delivered("name", *own, *own))
    assert str(problem) == "name: byte 3 is 0xB3: no gbk"


def test_a_text_over_messages_has_its_details_and_as_many_characters_as_are_told() -> None:
    text = Text("serial", "A1B2C3", {"maker": 2})
    own = frames("serial", text)
    assert own == ["0602413142320000", "43330000"]
    first, second = arrived("serial", text)
    [found] = outcomes("serial", [second, first])
    assert (found.text, dict(found.details), found.at) == ("A1B2C3", {"maker": 2}, 0.01)
    assert found.details["maker"].name == "SOUTH"


def test_ascii_is_what_can_be_printed() -> None:
    messages = split(rack().transfer("serial"), Text("serial", "A", {"maker": 0}))
    [one] = delivered("serial", "0201410700000000")
    [problem] = outcomes("serial", [one, *messages[1:]])
    assert str(problem) == "serial: character 2 is '\\x07', which is not printable"
    [high] = delivered("serial", "0201418000000000")
    [problem] = outcomes("serial", [high, *messages[1:]])
    assert str(problem) == "serial: byte 2 is 0x80: no ascii"


def test_readings_within_groups_take_the_totals_that_are_told() -> None:
    own = frames("weights", {1: [1.0, 2.0, 3.5], 2: [4.0, 5.0]})
    assert own == ["010102000400", "01020700ffff", "020108000a00"]
    found = outcomes("weights", [totals(2, 5), *delivered("weights", *own)])
    assert found == [{1: {1: 1.0, 2: 2.0, 3: 3.5}, 2: {1: 4.0, 2: 5.0}}]
    assert found[0].transfer == "weights"


def test_readings_through_groups_of_fixed_sizes_need_no_totals() -> None:
    value: dict[int, list[Reading]] = {
        0: [20.0, 21.0, 22.0, 23.0],
        1: [30.0, INVALID, 32.0],
        2: [40.0, 41.0],
    }
    own = frames("heats", value)
    # Row 0 has frames 1 and 2, row 1 frames 3 and 4, row 2 frame 5; raw is degC + 40.
    assert own == ["00013c3d0000", "00023e3f0000", "010346ff0000", "010448ff0000", "020550510000"]
    found = outcomes("heats", delivered("heats", *own))
    assert found == [{group: dict(enumerate(part, 1)) for group, part in value.items()}]


@pytest.mark.parametrize(
    ("payload", "text"),
    [
        ("000346ff0000", "frame 3 of Heats row 0; there are Heats rows 0 to 2"),
        ("010446460000", "more readings have come than the 9 that there are"),
        ("010246ff0000", "frame 2 of Heats row 1; there are Heats rows 0 to 2"),
        ("030646ff0000", "frame 6 of Heats row 3; there are Heats rows 0 to 2"),
        ("010046ff0000", "frame 0 of Heats row 1; there are Heats rows 0 to 2"),
        ("014846480000", "frame 72 of Heats row 1; there are Heats rows 0 to 2"),
    ],
)
def test_a_number_that_its_group_has_not_is_told(payload: str, text: str) -> None:
    [problem] = outcomes("heats", delivered("heats", payload))
    assert problem.text == text


def test_what_is_missing_is_named_as_it_is_numbered_and_only_the_first_of_it() -> None:
    assembler = Assembler[Any](rack().transfer("heats"))
    named = "frame 1 of Heats row 0, frame 2 of Heats row 0, frame 3 of Heats row 1"
    assert assembler.missing() == f"{named} and 2 more are missing"
    for message in delivered("heats", "00013c3d0000", "010346ff0000", "010448ff0000"):
        assembler.take(message, 0.0)
    assert assembler.missing() == "frame 2 of Heats row 0, frame 5 of Heats row 2 are missing"
    [problem] = assembler.expire(1.0)
    assert problem.text == f"not complete within 1 s: {assembler.missing()}"


def test_blocks_are_counted_in_frames_by_their_own_frames() -> None:
    value = Blocks("key", tuple(range(10)), {"id": 0x1234})
    own = frames("key", value)
    assert own == ["0103341200010203", "0203341204050607", "0303341208090000"]
    [found] = outcomes("key", delivered("key", own[1], own[0], own[2]))
    assert bytes(found) == bytes([*range(10), 0, 0])
    assert found.details == {"id": 0x1234}


def test_blocks_of_other_numbers_are_a_conflict() -> None:
    three, two = frames("key", bytes(range(10))), frames("key", bytes(range(8)))
    found = outcomes("key", delivered("key", *three[:2], *two, *two))
    assert [each.text for each in found if isinstance(each, Problem)] == ["2 items in place of 3"]
    assert [bytes(each) for each in found if isinstance(each, Blocks)] == [bytes(range(8))]


def test_a_number_of_blocks_that_cannot_be_is_told() -> None:
    [problem] = outcomes("key", delivered("key", "0100000000000000"))
    assert (problem.kind, problem.text) == ("length", "Key_Blocks is 0: that cannot be")


def test_blocks_hold_values_in_the_units_of_their_signals() -> None:
    own = frames("curve", [1.0, 2.0, 3.5, -99.0, 500.0])
    # (value + 100) / 0.01: 10100 is 2774, little end first; the fill is raw 0.
    assert own == ["017427d82700", "026e28640000", "0360ea0000"[:10] + "00"]
    [found] = outcomes("curve", delivered("curve", *own))
    assert found.values == (1.0, 2.0, 3.5, -99.0, 500.0)
    with pytest.raises(ValueError, match="not all of its items are bytes"):
        bytes(found)


@pytest.mark.parametrize(
    ("name", "value", "problem"),
    [
        ("name", "x" * 19, "the frames carry 1 to 18 items, not 19"),
        ("name", "xä", "character 2, 'ä', is no gbk"),
        ("serial", "é", "character 1, 'é', is no ascii"),
        ("serial", "123456789", "the frames carry 1 to 8 items, not 9"),
        ("key", b"", "the frames carry 1 to 0 items, not 0"),
        ("curve", [1.0] * 4, "the frames carry 5 items, not 4"),
        ("curve", [1.0, 2.0, 3.0, 4.0, 501.0], "501 % is out of range"),
        ("weights", {256: [1.0]}, "Weights shelf 256; Weights shelfs are numbered 1 to 254"),
        ("heats", {0: [211.0] * 4, **REST}, "Heats row 0 number 1: 211 degC is out of range"),
        ("heats", {0: [20.0] * 3, **REST}, "Heats row 0 has 4 readings, not 3"),
        ("heats", {0: [20.0] * 4, **REST, 3: [1.0]}, "Heats row 3 has 0 readings, not 1"),
        ("heats", {0: [20.0] * 4}, "Heats row 1 has 3 readings, not 0"),
    ],
)
def test_what_the_frames_cannot_carry_is_refused(name: str, value: Any, problem: str) -> None:
    with pytest.raises(TransferError) as error:
        split(rack().transfer(name), value)
    assert problem in str(error.value)


def test_all_transfers_of_a_protocol_are_put_together_without_being_named() -> None:
    transfers = Transfers(rack())
    assert list(transfers.assemblers) == [
        *("name", "serial", "weights", "heats", "key", "curve"),
    ]
    values = {
        "serial": Text("serial", "A", {"maker": 1}),
        "heats": {0: [1.0] * 4, 1: [2.0] * 3, 2: [3.0] * 2},
        "key": bytes(range(4)),
        "curve": [0.0] * 5,
    }
    messages = [m for name, value in values.items() for m in split(rack().transfer(name), value)]
    found = [each for n, m in enumerate(messages) for each in transfers.take(m, n / 100)]
    assert [type(each) for each in found] == [Text, Readings, Blocks, Blocks]
    assert [transfers.result_of(each.transfer) for each in found] == [*map(type, found)]
