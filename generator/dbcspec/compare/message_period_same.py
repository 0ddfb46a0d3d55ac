"""A message keeps its period."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_messages
from typedcan.model.protocol import Aspect

PROMISE = Promise(
    "message-period-same",
    "A message is sent as often as before.",
    Class.WIRE,
    Breaks.RECEIVER,
    in_messages(
        "period", lambda message: message.period, lambda period: f"{period} ms" if period else ""
    ),
    needs=Aspect.PERIODS,
)
