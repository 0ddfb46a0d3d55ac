"""A message keeps its identifier."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, hex_id, in_messages

PROMISE = Promise(
    "message-identifier-same",
    "A message keeps its identifier.",
    Class.WIRE,
    Breaks.BOTH,
    in_messages("identifier", lambda message: message.frame_id, hex_id),
)
