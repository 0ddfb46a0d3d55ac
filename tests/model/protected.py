"""Messages with a checksum or a counter, for tests."""

from __future__ import annotations

from decimal import Decimal

from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import ByteOrder, Message, Signal

INTEL, MOTOROLA = ByteOrder.INTEL, ByteOrder.MOTOROLA


def signal(name: str, start: int, length: int, order: ByteOrder = INTEL) -> Signal:
    """An unsigned one."""
    return Signal(
        name=name,
        start=start,
        length=length,
        byte_order=order,
        minimum=Decimal(0),
        maximum=Decimal((1 << length) - 1),
        python_name=name.lower(),
    )


def message(
    *signals: Signal,
    checksum: Checksum | None = None,
    counter: Counter | None = None,
    length: int = 8,
    frame_id: int = 0x123,
) -> Message:
    """One with 11 bits of identifier."""
    return Message(
        name="Guarded",
        frame_id=frame_id,
        extended=False,
        length=length,
        sender="ECU",
        signals=signals,
        checksum=checksum,
        counter=counter,
    )
