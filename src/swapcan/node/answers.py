"""The answers of a pack that are no transfer, and all that a node tells."""

from __future__ import annotations

from dataclasses import dataclass

from swapcan.messages import B2V_BattInfo1, B2V_BattInfo2
from swapcan.transfer import CellVoltages, PackCode, ProbeTemperatures, Vin
from typedcan.node import events
from typedcan.wire.message import Message

Event = events.Event | Vin | PackCode | CellVoltages | ProbeTemperatures
"""All that a node tells."""


@dataclass(frozen=True, slots=True)
class BatteryInfo:
    """What the pack is: both of its messages, as they came last."""

    info1: B2V_BattInfo1
    info2: B2V_BattInfo2


class BatteryInfoCollector:
    """Waits for both messages."""

    def __init__(self) -> None:
        self._info1: B2V_BattInfo1 | None = None
        self._info2: B2V_BattInfo2 | None = None

    def take(self, message: Message, at: float) -> BatteryInfo | None:  # noqa: ARG002 - Collector
        """Take one of the messages; the answer once there are both."""
        if isinstance(message, B2V_BattInfo1):
            self._info1 = message
        elif isinstance(message, B2V_BattInfo2):
            self._info2 = message
        if self._info1 and self._info2:
            return BatteryInfo(self._info1, self._info2)
        return None

    def missing(self) -> str:
        """Which of the messages has not come."""
        names = [
            kind.NAME
            for kind, message in ((B2V_BattInfo1, self._info1), (B2V_BattInfo2, self._info2))
            if message is None
        ]
        return f"{' and '.join(names)} {'has' if len(names) == 1 else 'have'} not come"
