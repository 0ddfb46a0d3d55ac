"""A message is found by its whole identifier or by its PGN, as before."""

from __future__ import annotations

from dbcspec.compare.promise import Breaks, Class, Promise, in_messages
from typedcan.model.protocol import Aspect

PROMISE = Promise(
    "frame-format-same",
    "A message is found by its whole identifier, or by its PGN as SAE J1939 has it, as before.",
    Class.WIRE,
    Breaks.BOTH,
    in_messages(
        "found by", lambda message: message.by_pgn, lambda by_pgn: ("identifier", "PGN")[by_pgn]
    ),
    needs=Aspect.FRAME_FORMATS,
)
