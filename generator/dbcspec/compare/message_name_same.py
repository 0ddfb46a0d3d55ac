"""A message keeps its name."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_messages

PROMISE = Promise(
    "message-name-same",
    "A message is called the same in code.",
    Class.SOURCE,
    Breaks.BOTH,
    in_messages("name", lambda message: message.name),
)
