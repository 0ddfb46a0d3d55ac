"""A made-up protocol with what the standard has not: 11-bit frames, signs, mixed byte orders."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

from typedcan.model.naming import snake_case
from typedcan.model.protocol import (
    Bus,
    ByteOrder,
    Code,
    Message,
    Node,
    Protocol,
    SendType,
    Signal,
    ValueTable,
)

GEARS = ValueTable("Gears", (Code(0, "Leerlauf", "Neutral"), Code(7, "Rückwärts", "Reverse")))
TEXTS = ValueTable("Texts", (Code(1, "Eins", "One"), Code(60000, "Viele", "Very many")))
LETTERS = ValueTable("Letters", (Code(65, "A", "A"), Code(90, "Z", "Z"), Code(255, "-", "None")))
SLOTS = ValueTable("Slots", (Code(1, "Slot1", "Slot1"), Code(2, "Slot2", "Slot2")))
LEVELS = ValueTable("Levels", (Code(0, "Leer", "Empty"),))
LONG_TABLE = ValueTable(
    "AlmostAsLongAsANameCanBeInDbc",
    (Code(0, "x", "A label of nearly as many bytes as a label may have in a DBC"),),
)


def signal(name: str, start: int, length: int, **others: Any) -> Signal:
    """A signal whose range is all that its bits hold, unless another one is given."""
    others = {"minimum": Decimal(0), "maximum": Decimal((1 << length) - 1), **others}
    return Signal(
        name=name, start=start, length=length, english=name, python_name=snake_case(name), **others
    )


SPEED = signal(
    "Wheel_Speed",
    7,
    12,
    byte_order=ByteOrder.MOTOROLA,
    signed=True,
    factor=Decimal("0.0625"),
    offset=Decimal("-2.50"),
    minimum=Decimal("-1E+2"),
    maximum=Decimal(100),
    unit="m/s",
    receivers=("ABS", "TCU"),
)
WHEELS = Message(
    name="Wheels",
    english="Wheels",
    frame_id=0x123,
    extended=False,
    length=8,
    sender="ECU",
    period=100_000,
    send_type=SendType.CYCLIC,
    signals=(
        SPEED,
        signal("Level", 8, 4, factor=Decimal("0.5"), maximum=Decimal("7.5"), value_table=LEVELS),
        signal("Gear", 16, 3, maximum=Decimal(5), value_table=GEARS, start_value=7),
        signal("Text", 24, 16, value_table=TEXTS),
        signal("Letter", 40, 8, value_table=LETTERS, invalid_code=255, start_value=255),
        signal("Slot", 48, 8, value_table=SLOTS),
        signal("Count", 56, 8),
    ),
)
LONG_NAMES = Message(
    name="A_Message_With_A_Rather_Long_Nam",
    frame_id=0x7FE,
    extended=False,
    length=8,
    sender="ECU",
    signals=(
        signal(
            "A_Signal_With_As_Long_A_Name_AsX",
            0,
            16,
            factor=Decimal("0.001"),
            offset=Decimal(-1000),
            minimum=Decimal(-1000),
            maximum=Decimal("-934.465"),
            invalid_code=65535,
            abnormal_code=65534,
            start_value=65535,
            unit="V",
            receivers=tuple(f"RECEIVER_{number}" for number in range(9)),
        ),
        signal("Another_Signal_With_A_Long_Name", 16, 2, value_table=LONG_TABLE),
    ),
)
HELLO = Message(
    name="Hello", english="Hello", frame_id=0x7FF, extended=False, length=2, sender="ABS"
)
OTHER = Protocol(
    name="other-car",
    english="Another car",
    title="Ein anderes Auto",
    nodes=(Node(name="ECU", english="Engine", address=1), Node(name="ABS"), Node(name="TCU")),
    buses=(
        Bus(name="body", bit_rate=125_000, nodes=("ECU",)),
        Bus(name="chassis", bit_rate=500_000, nodes=("ECU", "ABS")),
    ),
    messages=(WHEELS, LONG_NAMES, HELLO),
    value_tables=(LEVELS, GEARS, TEXTS, LETTERS, SLOTS, LONG_TABLE),
)
PLAIN = Protocol(
    name="plain",
    nodes=(Node(name="ECU"),),
    messages=(Message(name="Plain", frame_id=1, length=8, sender="ECU", signals=(SPEED,)),),
)
"""One message and no codes at all."""
