"""A message keeps its send type."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_messages
from typedcan.model.protocol import Aspect

PROMISE = Promise(
    "message-send-type-same",
    "A message is sent on the same occasions, always or on events.",
    Class.WIRE,
    Breaks.RECEIVER,
    in_messages(
        "send type",
        lambda message: message.send_type,
        lambda send_type: send_type.name.lower().replace("_", " "),
    ),
    needs=Aspect.PERIODS,
)
