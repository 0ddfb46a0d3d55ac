"""Transfers as other protocols have them: branches, wide characters, totals in their own frames."""

from __future__ import annotations

import random
from dataclasses import replace
from decimal import Decimal
from typing import Any

import numpy as np
import pytest
from transfer.rack import rack

from typedcan.dynamic import typed_protocol
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock
from typedcan.logs.protocol import known
from typedcan.logs.transfers.cycles import ReadingColumns
from typedcan.logs.transfers.values import ValueColumns
from typedcan.model.protocol import ByteOrder, Code, Message, Protocol, Signal, ValueTable
from typedcan.model.transfer import Counted, Ending, Numbering, Transfer
from typedcan.model.transfers.kind import MOST_ITEMS
from typedcan.transfer import Assembler, Text, TransferError, Transfers, split
from typedcan.wire.codec import Codec
from typedcan.wire.protocol import Protocol as TypedProtocol


def signal(name: str, start: int, length: int = 8, **facts: Any) -> Signal:
    facts = {"python_name": name.lower(), "minimum": Decimal(0), **facts}
    return Signal(
        name=name, start=start, length=length, maximum=Decimal((1 << length) - 1), **facts
    )


def protocol_of(transfer: Transfer, *signals: Signal, name: str = "PLATE") -> Protocol:
    message = Message(
        name=name, frame_id=0x123, extended=False, length=8, sender="A", signals=signals
    )
    return Protocol(name="other", messages=(message,), transfers=(transfer,))


def told(protocol: TypedProtocol, payloads: list[bytes], **facts: Any) -> list[Any]:
    """What an assembler tells of frames 10 ms apart."""
    codec, message = Codec(protocol), protocol.messages[0]
    assembler = Assembler[Any](protocol.transfers[0], **facts)
    frames = [codec.decode(message.FRAME_ID, data, extended=False) for data in payloads]
    return [each for n, frame in enumerate(frames) for each in assembler.take(frame, n / 100)]


def in_columns(protocol: Protocol, payloads: list[bytes]) -> FrameBlock:
    data = np.zeros((len(payloads), 8), np.uint8)
    for row, payload in zip(data, payloads, strict=True):
        row[: len(payload)] = list(payload)
    return FrameBlock(
        timestamp=np.arange(len(payloads)) / 100,
        frame_id=np.full(len(payloads), protocol.messages[0].frame_id, np.uint32),
        flags=np.zeros(len(payloads), np.uint8),
        channel=np.zeros(len(payloads), np.int16),
        length=np.array([len(payload) for payload in payloads], np.uint8),
        data=data,
        channels=("can0",),
    )


def values_of(protocol: Protocol, payloads: list[bytes]) -> list[Any]:
    """What the columns of a log have of the same frames."""
    log = known(protocol)
    decoder = Decoder(log.messages, reserved=log.reserved)
    columns = ValueColumns(log.values)
    block = decoder.decode(in_columns(protocol, payloads))
    return [*(each.value for each in columns.add(block.messages)), *columns.problems]


PLATE = Transfer(
    name="plate",
    english="Plate",
    kind="text_over_frames",
    messages=("PLATE",),
    items=("C1", "C2"),
    frame_number="NO",
    count=4,
)


def test_frames_whose_number_selects_a_branch_hold_the_items_of_that_branch() -> None:
    branches = [
        signal(f"C{n + 1}", 8 * (1 + n % 3), multiplexer="NO", selectors=(n // 3,))
        for n in range(5)
    ]
    items = tuple(each.name for each in branches)
    transfer = replace(PLATE, items=items, first_number=0, count=5)
    model = protocol_of(transfer, signal("NO", 0, is_selector=True), *branches)
    protocol = typed_protocol(model)
    frames = split(protocol.transfers[0], "AB-12")
    payloads = [Codec(protocol).encode(each) for each in frames]
    assert [data.hex() for data in payloads] == ["0041422d00000000", "0131320000000000"]
    assert told(protocol, payloads) == [Text("plate", "AB-12", {}, 0.01)]
    assert values_of(model, payloads) == [Text("plate", "AB-12", {}, 0.01)]


def test_items_of_two_bytes_are_in_the_order_of_their_signals() -> None:
    big = {"byte_order": ByteOrder.MOTOROLA}
    for facts, encoding, starts in (({}, "utf-16-le", (8, 24)), (big, "utf-16-be", (15, 31))):
        items = [signal(f"C{n}", start, 16, **facts) for n, start in enumerate(starts, 1)]
        model = protocol_of(replace(PLATE, encoding=encoding, count=4), signal("NO", 0), *items)
        protocol = typed_protocol(model)
        payloads = [Codec(protocol).encode(each) for each in split(protocol.transfers[0], "电Ab1")]
        assert b"".join(data[1:5] for data in payloads).decode(encoding) == "电Ab1"
        assert told(protocol, payloads) == values_of(model, payloads)
        assert told(protocol, payloads) == [Text("plate", "电Ab1", {}, 0.01)]


def test_characters_are_those_of_the_value_tables_where_these_name_some() -> None:
    grades = ValueTable("Grade", tuple(Code(n, letter, letter) for n, letter in enumerate("ABC")))
    items = [signal(f"C{n}", 8 * n, value_table=grades) for n in (1, 2)]
    protocol = typed_protocol(protocol_of(PLATE, signal("NO", 0), *items))
    payloads = [Codec(protocol).encode(each) for each in split(protocol.transfers[0], "CAAB")]
    assert [data[:3] for data in payloads] == [b"\1\2\0", b"\2\0\1"]
    assert told(protocol, payloads) == [Text("plate", "CAAB", {}, 0.01)]
    [problem] = told(protocol, [b"\1\2\3" + bytes(5), payloads[1]])
    assert problem.text == "character 2 is 0x03, which is none of ABC"
    with pytest.raises(TransferError, match="character 1, 'D', is none of ABC"):
        split(protocol.transfers[0], "DAAB")


def test_a_text_ends_at_a_fill_that_is_the_invalid_code_too() -> None:
    items = [signal(f"C{n}", 8 * n, invalid_code=255) for n in (1, 2)]
    transfer = replace(PLATE, length=Ending.TO_FILL, fill=255)
    model = protocol_of(transfer, signal("NO", 0), *items)
    protocol = typed_protocol(model)
    payloads = [Codec(protocol).encode(each) for each in split(protocol.transfers[0], "A1B")]
    assert [data[:3] for data in payloads] == [b"\1A1", b"\2B\xff"]
    assert (
        told(protocol, payloads) == values_of(model, payloads) == [Text("plate", "A1B", {}, 0.01)]
    )
    fixed = typed_protocol(protocol_of(PLATE, signal("NO", 0), *items))
    [problem] = told(fixed, payloads)
    assert problem.text == "character 4 is Signal Invalid, which is no ascii"


@pytest.mark.parametrize(("counted", "count"), [(Counted.ITEMS, 3), (Counted.FRAMES, 2)])
def test_each_frame_can_tell_how_many_items_or_frames_there_are(
    counted: Counted, count: int
) -> None:
    transfer = replace(PLATE, count=None, count_signal="OF", counted=counted, fill=32)
    parts = [signal("NO", 0), signal("OF", 8), signal("C1", 16), signal("C2", 24)]
    model = protocol_of(transfer, *parts)
    protocol = typed_protocol(model)
    payloads = [Codec(protocol).encode(each) for each in split(protocol.transfers[0], "ABC")]
    assert [data[:4] for data in payloads] == [bytes([1, count, 65, 66]), bytes([2, count, 67, 32])]
    expected = "ABC" if counted is Counted.ITEMS else "ABC "
    assert told(protocol, payloads) == [Text("plate", expected, {}, 0.01)]
    assert values_of(model, payloads) == [Text("plate", expected, {}, 0.01)]
    wrong = bytes([1, 0, 65, 66, 0, 0, 0, 0])
    [problem] = told(protocol, [wrong])
    assert (problem.kind, problem.text) == ("length", "OF is 0: that cannot be")


@pytest.mark.parametrize(("counted", "most"), [(Counted.ITEMS, 6), (Counted.FRAMES, 3)])
def test_there_is_no_more_than_frames_can_be_numbered(counted: Counted, most: int) -> None:
    transfer = replace(PLATE, count=None, count_signal="OF", counted=counted, fill=32)
    parts = [signal("NO", 0, 2), signal("OF", 8), signal("C1", 16), signal("C2", 24)]
    protocol = typed_protocol(protocol_of(transfer, *parts))
    assert told(protocol, [bytes([1, most, 65, 66, 0, 0, 0, 0])]) == []
    [problem] = told(protocol, [bytes([1, most + 1, 65, 66, 0, 0, 0, 0])])
    assert (problem.kind, problem.text) == ("length", f"OF is {most + 1}: that cannot be")


def test_a_number_that_another_message_tells_begins_anew_when_it_changes() -> None:
    transfer = replace(PLATE, count=None, count_signal="TOTAL", rounds=1)
    own = protocol_of(transfer, signal("NO", 0), signal("C1", 8), signal("C2", 16))
    other = Message(
        name="OTHER",
        frame_id=1,
        extended=False,
        length=1,
        sender="A",
        signals=(signal("TOTAL", 0),),
    )
    protocol = typed_protocol(replace(own, messages=(*own.messages, other)))
    assembler = Assembler[Any](protocol.transfers[0])
    plate, total = protocol.messages
    codec = Codec(protocol)

    def take(kind: Any, *data: int) -> list[Any]:
        frame = codec.decode(kind.FRAME_ID, bytes(data).ljust(kind.LENGTH, b"\0"), extended=False)
        return [*assembler.take(frame, 0.0)]

    assert take(plate, 1, 65, 66) == []
    assert assembler.missing() == "OTHER with the number of characters is missing"
    take(total, 4)
    assert take(plate, 1, 65, 66) == []
    assert take(plate, 2, 67, 68) == [Text("plate", "ABCD")]
    take(plate, 1, 65, 66)
    take(total, 2)
    assert take(plate, 1, 65, 66) == [Text("plate", "AB")]
    [problem] = take(plate, 2, 67, 68)
    assert problem.text == "frame number 2; there are 1 to 1"
    take(total, 0)
    assert take(plate, 1, 65, 66) == []


LOADS = Transfer(
    name="loads",
    english="Loads",
    kind="readings_by_group",
    messages=("LOADS",),
    items=("L1", "L2"),
    group="ROW",
    frame_number="NO",
    numbering=Numbering.THROUGH,
    groups_signal="ROWS",
    count_signal="ALL",
    period=1000,
    fill=0,
)
PARTS = [signal("ROW", 0), signal("NO", 8), signal("ROWS", 16), signal("ALL", 24)]
LOAD_SIGNALS = [*PARTS, signal("L1", 32), signal("L2", 40)]


def loads(*facts: tuple[int, ...]) -> list[bytes]:
    return [bytes([*each, 0, 0]) for each in facts]


def cycles(protocol: Protocol, payloads: list[bytes], *, assume_seen: bool) -> list[Any]:
    log = known(protocol)
    decoder = Decoder(log.messages, reserved=log.reserved)
    columns = ReadingColumns(log.readings, assume_seen=assume_seen)
    tables = columns.add(decoder.decode(in_columns(protocol, payloads)).messages)
    return [
        dict(zip(table.positions, row, strict=True))
        for table in [*tables, *columns.finish()]
        for row in table.values.tolist()
    ]


def test_readings_that_tell_their_totals_themselves_and_are_numbered_through() -> None:
    model = protocol_of(LOADS, *LOAD_SIGNALS, name="LOADS")
    payloads = loads(
        (1, 1, 2, 6, 11, 12), (1, 2, 2, 6, 13, 0), (2, 3, 2, 6, 21, 22), (2, 4, 2, 6, 23, 0)
    )
    expected = {1: {1: 11, 2: 12, 3: 13}, 2: {1: 21, 2: 22, 3: 23}}
    assert told(typed_protocol(model), payloads) == [expected]
    assert cycles(model, payloads, assume_seen=False) == [
        {(group, n): value for group, part in expected.items() for n, value in part.items()}
    ]


def test_readings_numbered_through_have_room_for_as_many_frames_as_there_are_numbers() -> None:
    transfer = typed_protocol(protocol_of(LOADS, *LOAD_SIGNALS, name="LOADS")).transfers[0]
    most = {1: [1] * 300, 2: [2] * 210}
    assert len(split(transfer, most)) == 255
    with pytest.raises(TransferError, match="ROW 2 has 211 readings, 105 frames have no room"):
        split(transfer, most | {2: [2] * 211})


def test_readings_numbered_through_that_do_not_divide_are_told_once_and_never_reported() -> None:
    model = protocol_of(LOADS, *LOAD_SIGNALS, name="LOADS")
    payloads = loads((1, 1, 2, 5, 11, 12), (1, 2, 2, 5, 13, 0), (2, 3, 2, 5, 21, 22)) * 3
    [problem] = told(typed_protocol(model), payloads)
    assert problem.kind == "totals"
    assert problem.text.startswith("5 readings of 2 ROWs, and their frames are numbered through")
    assert cycles(model, payloads, assume_seen=False) == []


def test_a_log_without_totals_shows_the_places_of_frames_that_are_numbered_through() -> None:
    lone = replace(LOADS, groups_signal="GROUPS", count_signal="COUNT")
    other = Message(
        name="TOTALS",
        frame_id=1,
        extended=False,
        length=2,
        sender="A",
        signals=(signal("GROUPS", 0), signal("COUNT", 8)),
    )
    own = protocol_of(lone, *LOAD_SIGNALS, name="LOADS")
    model = replace(own, messages=(*own.messages, other))
    once = loads(
        (1, 1, 0, 0, 11, 12), (1, 2, 0, 0, 13, 0), (2, 3, 0, 0, 21, 22), (3, 4, 0, 0, 31, 0)
    )
    found = cycles(model, once * 3, assume_seen=True)
    assert found == [{(1, 1): 11, (1, 2): 12, (1, 3): 13, (2, 1): 21, (2, 2): 22, (3, 1): 31}] * 3


def test_a_fill_that_the_spec_names_is_no_reading() -> None:
    lone = replace(LOADS, numbering=Numbering.WITHIN_GROUP)
    model = protocol_of(lone, *LOAD_SIGNALS, name="LOADS")
    once = loads((1, 1, 2, 3, 11, 12), (2, 1, 2, 3, 21, 0))
    expected = {1: {1: 11, 2: 12}, 2: {1: 21}}
    assert told(typed_protocol(model), once) == [expected]
    assert len(cycles(model, once, assume_seen=False)) == 1


@pytest.mark.parametrize(("group", "number"), [(0, 0), (0, 1), (1, 0), (1, 1)])
def test_groups_and_numbers_begin_at_0_or_1_as_the_spec_says(group: int, number: int) -> None:
    lone = replace(LOADS, numbering=Numbering.WITHIN_GROUP, first_group=group, first_number=number)
    model = protocol_of(lone, *LOAD_SIGNALS, name="LOADS")
    frames = loads(
        (group, number, 2, 5, 11, 12),
        (group, number + 1, 2, 5, 13, 0),
        (group + 1, number, 2, 5, 21, 22),
    )
    expected = {group: {1: 11, 2: 12, 3: 13}, group + 1: {1: 21, 2: 22}}
    assert told(typed_protocol(model), frames) == [expected]
    (row,) = cycles(model, frames, assume_seen=False)
    assert row == {(g, n): value for g, own in expected.items() for n, value in own.items()}


@pytest.mark.parametrize(("factor", "offset"), [("0.5", "-20"), ("-0.5", "20"), ("0.01", "7")])
def test_a_fill_is_the_code_next_to_which_readings_are_some(factor: str, offset: str) -> None:
    lone = replace(LOADS, numbering=Numbering.WITHIN_GROUP)
    scaled = [
        replace(each, factor=Decimal(factor), offset=Decimal(offset))
        if each.name in lone.items
        else each
        for each in LOAD_SIGNALS
    ]
    model = protocol_of(lone, *scaled, name="LOADS")
    frames = loads((1, 1, 2, 3, 11, 1), (2, 1, 2, 3, 21, 0))  # 1 is a reading, 0 is fill
    (readings,) = told(typed_protocol(model), frames)
    physical = [raw * float(factor) + float(offset) for raw in (11, 1, 21)]
    assert [list(each.values()) for each in readings.values()] == [
        pytest.approx(physical[:2]),
        pytest.approx(physical[2:]),
    ]
    (row,) = cycles(model, frames, assume_seen=False)
    assert row == pytest.approx(dict(zip([(1, 1), (1, 2), (2, 1)], physical, strict=True)))


def test_totals_beyond_what_any_value_has_are_none_and_take_no_memory() -> None:
    wide = [*PARTS[:2], signal("ROWS", 16, 16), signal("ALL", 32, 24), signal("L1", 56)]
    lone = replace(LOADS, items=("L1",), numbering=Numbering.WITHIN_GROUP)
    protocol = typed_protocol(protocol_of(lone, *wide, name="LOADS"))
    codec, assembler = Codec(protocol), Assembler[Any](protocol.transfers[0])
    frame = bytes([1, 1, 255, 255, *(MOST_ITEMS + 1).to_bytes(3, "little"), 7])
    assert assembler.take(codec.decode(0x123, frame, extended=False), 0.0) == ()
    assert assembler.missing() == "LOADS with the totals is missing"
    assert assembler.duplicates == 0
    frame = bytes([1, 1, 1, 0, 1, 0, 0, 7])
    assert assembler.take(codec.decode(0x123, frame, extended=False), 0.0) == ({1: {1: 7}},)


def size_of(thing: Any, seen: set[int]) -> int:
    """How many things an object holds."""
    if id(thing) in seen or isinstance(thing, type) or callable(thing):
        return 0
    seen.add(id(thing))
    parts: list[Any] = []
    if isinstance(thing, dict):
        parts = [*thing, *thing.values()]
    elif isinstance(thing, list | tuple | set | frozenset):
        parts = [*thing]
    elif hasattr(thing, "__dict__"):
        parts = [vars(thing)]
    return 1 + sum(size_of(part, seen) for part in parts)


def test_random_frames_of_every_kind_raise_nothing_and_fill_no_memory() -> None:
    protocol = rack()
    codec, transfers = Codec(protocol), Transfers(protocol)
    dice = random.Random(1)
    sizes: list[int] = []
    for n in range(3_000):
        kind = dice.choice(protocol.messages)
        data = dice.randbytes(kind.LENGTH)
        message = codec.decode(kind.FRAME_ID, data, extended=False, verify=False)
        assert all(str(outcome) for outcome in transfers.take(message, n / 1000))
        transfers.expire(n / 1000)
        if n % 1000 == 999:
            sizes.append(size_of(transfers, set()))
    assert max(sizes) < 5_000
