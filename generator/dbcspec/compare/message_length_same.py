"""A message keeps its length."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_messages

PROMISE = Promise(
    "message-length-same",
    "A message keeps its number of bytes.",
    Class.WIRE,
    Breaks.BOTH,
    in_messages("length", lambda message: message.length, lambda length: f"{length} bytes"),
)
