"""A made-up protocol in which codes act: few and many, signed, by no value, in two messages."""

from __future__ import annotations

from decimal import Decimal

from emit.other_protocol import signal

from typedcan.model.acting import ActingCodes
from typedcan.model.protocol import Code, Message, Node, Protocol, ValueTable


def table(name: str, *labels: str, first: int = 0) -> ValueTable:
    """Codes with these labels, from ``first`` on."""
    return ValueTable(
        name, tuple(Code(value, label, label) for value, label in enumerate(labels, start=first))
    )


SWITCH = table("Switch", "On", "Off")
PUMP = table("Pump", "Backwards", "Off", "On", "Invalid", first=-1)
STEPS = table("Steps", *(f"Step {letter}" for letter in map(chr, range(97, 97 + 26))))
LAMPS = table("Lamps", "Dark", "Lit")

ACTS = Message(
    name="Acts",
    english="What moves",
    frame_id=0x18FF0001,
    length=8,
    sender="ECU",
    period=100,
    signals=(
        signal(
            "Heater",
            0,
            2,
            value_table=SWITCH,
            start_value=1,
            acting=ActingCodes(codes=(0,), safe=1, reference="5.1; Table 1"),
        ),
        signal(
            "Pump",
            8,
            8,
            signed=True,
            minimum=Decimal(-128),
            maximum=Decimal(127),
            value_table=PUMP,
            invalid_code=2,
            start_value=2,
            acting=ActingCodes(codes=(-1, 1), safe=0),
        ),
        signal(
            "Fan",
            16,
            8,
            value_table=STEPS,
            acting=ActingCodes(codes=tuple(range(1, 26)), safe=0, reference="5.2"),
        ),
        signal("Lamp", 24, 8, value_table=LAMPS),
    ),
)
REPORTS = Message(
    name="Reports",
    english="What moved",
    frame_id=0x18FF0002,
    length=8,
    sender="MOTOR",
    signals=(
        signal(
            "Heater",
            0,
            2,
            value_table=SWITCH,
            start_value=1,
            acting=ActingCodes(codes=(0,), safe=1, reports=True, reference="5.3"),
        ),
        signal("Fan", 8, 8, value_table=STEPS),
    ),
)
MOVING = Protocol(
    name="moving",
    number="M 1",
    title="动",
    english="Moving",
    nodes=(Node(name="ECU", english="Control"), Node(name="MOTOR", english="Motor")),
    messages=(ACTS, REPORTS),
    value_tables=(SWITCH, PUMP, STEPS, LAMPS),
)
