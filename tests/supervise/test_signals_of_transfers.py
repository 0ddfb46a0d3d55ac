"""Characters of a text in numbered frames: those behind its end are not watched."""

from __future__ import annotations

from decimal import Decimal

import can
import pytest

from typedcan.dynamic import typed_protocol
from typedcan.model.protocol import Code, Message, Node, Protocol, Signal, ValueTable
from typedcan.model.transfer import Counted, Transfer
from typedcan.supervise import SignalChanged, Supervisor
from typedcan.wire.codec import Codec
from typedcan.wire.receiver import Received, Receiver

LETTERS = ValueTable("Letter", tuple(Code(ord(each), each, each) for each in "ABC"))
SIGNALS = tuple(
    Signal(
        name=name,
        python_name=name.lower(),
        start=8 * place,
        length=8,
        minimum=Decimal(0),
        maximum=Decimal(255),
        value_table=LETTERS if place else None,
        receivers=("B",),
    )
    for place, name in enumerate(("NO", "C1", "C2"))
)


@pytest.mark.parametrize(
    ("first", "counted", "expected"),
    [
        (0, Counted.ITEMS, [[], []]),
        (1, Counted.ITEMS, [[], ["PLATE[1].c2: unknown code: 0x2A"]]),
        (0, Counted.FRAMES, [[], ["PLATE[1].c2: unknown code: 0x2A"]]),
    ],
)
def test_the_end_of_a_text_follows_from_where_its_numbers_begin(
    first: int, counted: Counted, expected: list[list[str]]
) -> None:
    text = Transfer(
        name="plate",
        english="Plate",
        kind="text_over_frames",
        messages=("PLATE",),
        items=("C1", "C2"),
        frame_number="NO",
        first_number=first,
        count=3,
        counted=counted,
    )
    plate = Message(
        name="PLATE", frame_id=1, extended=False, length=3, sender="A", period=100, signals=SIGNALS
    )
    nodes = (Node(name="A"), Node(name="B"))
    protocol = typed_protocol(
        Protocol(name="plates", nodes=nodes, messages=(plate,), transfers=(text,))
    )
    receiver, supervisor = Receiver(Codec(protocol)), Supervisor(protocol, "B")
    found = []
    for number, data in enumerate((bytes([0, 65, 66]), bytes([1, 67, 0x2A]))):
        frame = can.Message(arbitration_id=1, is_extended_id=False, data=data)
        received = receiver.take(frame)
        assert isinstance(received, Received)
        events = supervisor.take(received, number / 10)
        found.append([str(event) for event in events if isinstance(event, SignalChanged)])
    assert found == expected
