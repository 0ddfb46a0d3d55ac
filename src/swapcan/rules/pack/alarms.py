"""The single alarms of B2V_ST1 and B2V_ST0 (tables 2 and 12), as bits of their frames.

The two messages are not sent in the same moment. So an alarm of B2V_ST0 counts as raised for a
B2V_ST1 only where all B2V_ST0 around it tell it, and as not raised where none does.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST0, B2V_ST1
from swapcan.rules.pack.surroundings import Surrounded, Surroundings, rows_of
from typedcan.judge.chunk import Chunk
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Limits
from typedcan.wire.message import Message

Words = NDArray[np.uint64]
"""The bytes of frames, or some bits of them, the first byte lowest."""


@dataclass(frozen=True, slots=True)
class AlarmBits:
    """Where the alarms of a message are.

    Parameters
    ----------
    levels, flags
        Names of the standard with the place of the lowest bit: alarms of two bits, which have a
        level, and of one, which have none.
    """

    levels: dict[str, int]
    flags: dict[str, int]

    @property
    def mask(self) -> np.uint64:
        """The bits of all of them."""
        levels = sum(3 << place for place in self.levels.values())
        return np.uint64(levels + self.flag_mask)

    @property
    def flag_mask(self) -> int:
        """The bits of those without a level."""
        return sum(1 << place for place in self.flags.values())

    def has_flag(self, words: Words) -> NDArray[np.bool_]:
        """Whether one without a level is raised."""
        raised: NDArray[np.bool_] = (words & np.uint64(self.flag_mask)) != 0
        return raised

    def highest(self, words: Words) -> NDArray[np.int64]:
        """The highest level of those that have one."""
        highest = np.zeros(len(words), np.int64)
        if words.any():
            for place in self.levels.values():
                np.maximum(highest, _bits(words, place, 3), out=highest)
        return highest

    def count(self, words: Words) -> NDArray[np.int64]:
        """How many are raised."""
        count = np.zeros(len(words), np.int64)
        if words.any():
            for place in self.levels.values():
                count += _bits(words, place, 3) != 0
            for place in self.flags.values():
                count += _bits(words, place, 1)
        return count

    def raised(self, word: int) -> dict[str, int]:
        """The names of those that are raised, with the level; 0 where one has none."""
        levels = {name: word >> place & 3 for name, place in self.levels.items()}
        flags = {name: 0 for name, place in self.flags.items() if word >> place & 1}
        return {name: level for name, level in levels.items() if level} | flags


@cache
def alarm_bits(message: type[Message]) -> AlarmBits:
    """Where the alarms of a message are."""
    alarms = [part for name, part in message.FIELDS.items() if name.startswith("flt_")]
    places = [(each.dbc_name, each.signal.start, each.length) for each in alarms]
    return AlarmBits(
        {name: place for name, place, length in places if length == 2},
        {name: place for name, place, length in places if length == 1},
    )


@dataclass(frozen=True, slots=True)
class Alarms:
    """Frames of B2V_ST1, and what is told around them; n rows.

    Parameters
    ----------
    time, order
        Seconds since the log's begin, and numbers in the log.
    level, number
        B2V_ST1_Fault_Levl and B2V_ST1_GBT32960FltNum.
    own
        The alarms of the frames themselves.
    all_around, any_around
        The alarms of B2V_ST0 that all, and that any of the frames around tell.
    known
        Whether these came; else there are no alarms in the two before.
    """

    time: NDArray[np.float64]
    order: NDArray[np.int64]
    level: NDArray[np.int64]
    number: NDArray[np.int64]
    own: Words
    all_around: Words
    any_around: Words
    known: NDArray[np.bool_]


class AlarmStream:
    """Hands out each B2V_ST1 once it is known what is told around it."""

    def __init__(self, limits: Limits) -> None:
        self._surroundings = Surroundings(limits)

    def feed(self, chunk: Chunk) -> Alarms:
        """Those that can be judged with this chunk."""
        status, relays = chunk.sound(B2V_ST1), chunk.sound(B2V_ST0)
        frames, others = rows_of(status, _words(status)), rows_of(relays, _words(relays))
        return _alarms(self._surroundings.feed(frames, others, chunk.end))

    def finish(self) -> Alarms | None:
        """What is left; None where nothing came."""
        left = self._surroundings.finish()
        return None if left is None else _alarms(left)


def _alarms(surrounded: Surrounded) -> Alarms:
    frames, around, known = surrounded
    bits = np.where(known, alarm_bits(B2V_ST0).mask, np.uint64(0))
    return Alarms(
        frames.time,
        frames.order,
        _field(frames.data, B2V_ST1.FIELDS["fault_levl"].dbc_name),
        _field(frames.data, B2V_ST1.FIELDS["gbt32960_flt_num"].dbc_name),
        frames.data & alarm_bits(B2V_ST1).mask,
        np.bitwise_and.reduce(around, axis=0) & bits,
        np.bitwise_or.reduce(around, axis=0) & bits,
        known,
    )


def _words(series: Series) -> Words:
    words: Words = np.ascontiguousarray(series.payload).view("<u8")[:, 0].astype(np.uint64)
    return words


def _field(words: Words, name: str) -> NDArray[np.int64]:
    place, mask = _place(name)
    return _bits(words, place, mask)


@cache
def _place(name: str) -> tuple[int, int]:
    """The lowest bit of a signal of B2V_ST1, and its mask there."""
    signal = B2V_ST1.MODEL.signal(name)
    return signal.start, (1 << signal.length) - 1


def _bits(words: Words, place: int, mask: int) -> NDArray[np.int64]:
    return ((words >> np.uint64(place)) & np.uint64(mask)).astype(np.int64)
