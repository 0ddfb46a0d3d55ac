"""Puts the frames of the VIN together in the sets in which they are sent."""

from __future__ import annotations

from typing import NamedTuple

from swapcan.transfer.text import VIN
from typedcan.judge.chunk import Chunk
from typedcan.transfer import text_slots

NUMBERS = tuple(slot.number for slot in text_slots(VIN))
"""The frame numbers of a set, in their order."""

_MESSAGE = VIN.messages[0]
_NUMBER = VIN.frame_number.field if VIN.frame_number else ""


class VinFrame(NamedTuple):
    """A frame: its number within the set, when it came, its number in the log, its bytes."""

    number: int
    time: float
    order: int
    data: bytes


class VinSets:
    """Divides the frames of a log into sets: each ends with the last number, or before the first.

    VIN frames are few, they come on request: they are taken one by one.
    """

    def __init__(self) -> None:
        self.open: list[VinFrame] = []
        """The frames of the set under way."""

    def feed(self, chunk: Chunk) -> list[list[VinFrame]]:
        """The sets that are over with a chunk."""
        over: list[list[VinFrame]] = []
        series = chunk.frames(_MESSAGE)
        for row in range(series.first, len(series)):
            frame = VinFrame(
                int(series.raw(_NUMBER)[row]),
                float(series.time[row]),
                int(series.order[row]),
                bytes(series.payload[row]),
            )
            if frame.number == NUMBERS[0] and self.open:
                over.append(self.open)
                self.open = []
            self.open.append(frame)
            if frame.number == NUMBERS[-1]:
                over.append(self.open)
                self.open = []
        return over


def is_whole(frames: list[VinFrame]) -> bool:
    """Whether a set has each number once, in order."""
    return tuple(frame.number for frame in frames) == NUMBERS
