"""Where the characters of the pack code stand, and how many of them count."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.transfer.text import PACK_CODE
from typedcan.judge.chunk import Chunk
from typedcan.judge.series import Series, latest
from typedcan.transfer import text_slots
from typedcan.wire.message import Message

ROOM = len(PACK_CODE.items)
"""How many characters the frames can carry."""

NODE = PACK_CODE.messages[0].SENDER

_SLOTS = text_slots(PACK_CODE)

if PACK_CODE.length_field is None:
    raise LookupError("the pack code has no length")
LENGTH = PACK_CODE.length_field
"""The field that tells how many characters count."""


def fields(message: type[Message]) -> tuple[str, ...]:
    """The fields of a message that hold characters."""
    return next(slot.used for slot in _SLOTS if slot.message is message)


def positions(message: type[Message]) -> NDArray[np.int64]:
    """Which characters of the code they hold, from 1."""
    before = 0
    for slot in _SLOTS:
        if slot.message is message:
            return np.arange(before + 1, before + 1 + len(slot.used))
        before += len(slot.used)
    raise LookupError(f"{message.NAME} has no characters of the pack code")


def codes(series: Series) -> NDArray[np.int64]:
    """The codes of the characters, shape (rows, characters)."""
    return np.stack([series.raw(name) for name in fields(series.message)], axis=1)


def lengths(chunk: Chunk, series: Series) -> NDArray[np.int64]:
    """How many characters count by the last frame that says so; -1 where there was none."""
    own = chunk.sound(LENGTH.message)
    told = np.concatenate([[-1], own.raw(LENGTH.field)])
    if series.message is LENGTH.message:
        return told[1:]
    return told[latest(own, series) + 1]
