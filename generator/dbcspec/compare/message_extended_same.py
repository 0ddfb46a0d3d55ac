"""A message stays a standard or an extended frame."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_messages

PROMISE = Promise(
    "message-extended-same",
    "A message keeps the width of its identifier, 11 or 29 bits.",
    Class.WIRE,
    Breaks.BOTH,
    in_messages(
        "frame",
        lambda message: message.extended,
        lambda extended: "extended" if extended else "standard",
    ),
)
