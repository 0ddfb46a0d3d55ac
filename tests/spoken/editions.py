"""A small protocol of two messages, and an edition that says nearly everything otherwise."""

from __future__ import annotations

from dataclasses import replace
from decimal import Decimal
from typing import Any

from typedcan.dynamic import typed_protocol
from typedcan.model import protocol as model
from typedcan.model.acting import ActingCodes
from typedcan.model.protection import Checksum, Counter
from typedcan.model.signal import Code, Signal, ValueTable
from typedcan.model.variants import changes_between


def table(name: str, **codes: int) -> ValueTable:
    labels = sorted((code, label.replace("_", " ")) for label, code in codes.items())
    return ValueTable(name, tuple(Code(code, label, label) for code, label in labels))


def signal(name: str, start: int, length: int, **more: Any) -> Signal:
    facts: dict[str, Any] = {
        "minimum": Decimal(0),
        "maximum": Decimal((1 << length) - 1),
        "python_name": name.lower(),
        "receivers": ("Pump",),
    }
    return Signal(name=name, start=start, length=length, **(facts | more))


HEAT = table("Heat", On=1, Off=2, Signal_Invalid=3)
FAULT = table("Fault", Normal=0, Weld=1, Open=2, Signal_Invalid=3)
MODE = table("Mode", Idle=0, Run=1, Wash=2)

COMMAND = model.Message(
    name="Command",
    frame_id=0x18FF0001,
    length=8,
    sender="Panel",
    period=50,
    send_type=model.SendType.CYCLIC,
    checksum=Checksum(signal="Sum", algorithm="xor", covered=(1, 2, 3, 4, 5, 6, 7)),
    counter=Counter(signal="Alive", modulus=16),
    signals=(
        signal("Sum", 0, 8),
        signal("Alive", 8, 4),
        signal(
            "Heat",
            12,
            2,
            value_table=HEAT,
            invalid_code=3,
            start_value=3,
            acting=ActingCodes(codes=(1,), safe=2),
        ),
        signal("Fault", 14, 2, value_table=FAULT, invalid_code=3, start_value=3),
        signal(
            "Speed",
            16,
            16,
            factor=Decimal("0.5"),
            maximum=Decimal(30000),
            invalid_code=0xFFFF,
            abnormal_code=0xFFFE,
            start_value=0xFFFF,
        ),
        signal("Mode", 32, 2, value_table=MODE),
        signal("Gear", 48, 4, invalid_code=15, start_value=15, abnormal_code=14),
        signal("Spare", 40, 8, maximum=Decimal(200), invalid_code=255, start_value=255),
    ),
)
REPORT = model.Message(
    name="Report",
    frame_id=0x18FF0002,
    length=2,
    sender="Pump",
    period=100,
    send_type=model.SendType.CYCLIC,
    signals=(signal("Level", 0, 8, invalid_code=255, start_value=255, receivers=("Panel",)),),
)
USUAL = model.Protocol(
    name="pump",
    nodes=(model.Node(name="Panel"), model.Node(name="Pump")),
    messages=(COMMAND, REPORT),
    value_tables=(FAULT, HEAT, MODE),
)

# Places, scale, codes, checksum, counter and period are others; Spare is not there, Extra is.
OTHER_COMMAND = replace(
    COMMAND,
    period=20,
    checksum=Checksum(signal="Sum", algorithm="sum", covered=(1, 2, 3, 4, 5, 6, 7)),
    counter=Counter(signal="Alive", modulus=15, first=1),
    signals=(
        signal("Sum", 0, 8),
        signal("Alive", 8, 4),
        signal(
            "Heat",
            14,
            2,
            value_table=table("Heat", Off=1, On=2, Signal_Invalid=3),
            invalid_code=3,
            start_value=3,
            acting=ActingCodes(codes=(2,), safe=1),
        ),
        signal(
            "Fault",
            12,
            2,
            value_table=table("Fault", Normal=0, Open=1, Weld=2, Signal_Invalid=3),
            invalid_code=3,
            start_value=3,
        ),
        signal(
            "Speed",
            23,
            16,
            byte_order=model.ByteOrder.MOTOROLA,
            factor=Decimal("0.25"),
            maximum=Decimal(15000),
            invalid_code=0xFFF0,
            other_invalid_codes=(0xFFFF,),
            start_value=0xFFF0,
        ),
        signal("Mode", 32, 2, value_table=table("Mode", Idle=0, Run=1, Drain=3)),
        signal(
            "Gear",
            48,
            4,
            value_table=table("Gear", Neutral=0, First=1),
            invalid_code=13,
            start_value=13,
        ),
        signal("Extra", 40, 8, invalid_code=0x7F, start_value=0x7F),
    ),
)
EXTRA = model.Message(
    name="Cells",
    frame_id=0x18FF0003,
    length=1,
    sender="Pump",
    period=100,
    send_type=model.SendType.CYCLIC,
    signals=(signal("Cell", 0, 8, receivers=("Panel",)),),
)
LAMP = replace(EXTRA, name="Lamp", frame_id=0x18FF0004)
OTHER = replace(USUAL, messages=(OTHER_COMMAND, REPORT, EXTRA))
MODEL = replace(
    USUAL,
    variants=(
        model.Variant(
            name="maker",
            is_edition=True,
            english="A maker's",
            changes=changes_between(USUAL, OTHER),
        ),
        model.Variant(
            name="third",
            is_edition=True,
            english="Another maker's",
            changes=changes_between(USUAL, replace(USUAL, messages=(COMMAND, REPORT, LAMP))),
        ),
    ),
)
PUMP = typed_protocol(MODEL)
"""The protocol with the classes of a program; its edition is called ``maker``."""

Command: Any = PUMP.message("Command")
Report: Any = PUMP.message("Report")


def code(message: Any, field: str, label: str) -> Any:
    """The member of a field's enum with a label."""
    part = message.FIELDS[field]
    return next(part.enum(raw) for raw, text in part.labels.items() if text == label)
