"""A message stays one of classic CAN, or of CAN FD with the same bit rates."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_messages
from typedcan.model.protocol import Aspect

PROMISE = Promise(
    "message-frame-format-same",
    "A message comes in frames of classic CAN, or of CAN FD with or without a second bit rate.",
    Class.WIRE,
    Breaks.BOTH,
    in_messages("frame format", lambda message: message.frame_kind),
    needs=Aspect.FRAME_FORMATS,
)
