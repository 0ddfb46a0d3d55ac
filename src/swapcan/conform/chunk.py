"""Some frames of a log as rules see them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from swapcan.conform.series import Series
from typedcan.logs.cells.cycles import CycleTable
from typedcan.logs.frames import FrameBlock
from typedcan.wire.message import Message


class Chunk:
    """Consecutive frames of one log.

    Parameters
    ----------
    block
        All of them, known or not, sound or not; its time stamps are the log's own.
    begin
        Time stamp of the log's first frame: block.timestamp - begin are seconds since then.
    first_order
        Number of the block's first frame in the log, from 0.
    end
        The latest time so far, in seconds since the log's begin.
    """

    def __init__(
        self,
        block: FrameBlock,
        begin: float,
        first_order: int,
        end: float,
        frames: Mapping[type[Message], Series],
        sound: Mapping[type[Message], Series],
        cycles: Callable[[], Sequence[CycleTable]],
    ) -> None:
        self.block = block
        self.begin = begin
        self.first_order = first_order
        self.end = end
        self._frames = frames
        self._sound = sound
        self._cycles = cycles

    def frames(self, message: type[Message]) -> Series:
        """The frames of a message with the right length, whatever their checksum."""
        return self._frames[message]

    def sound(self, message: type[Message]) -> Series:
        """Those of them with the right checksum too: those that can be believed."""
        return self._sound[message]

    @property
    def cycles(self) -> Sequence[CycleTable]:
        """The cycles of cell voltages and probe temperatures that are complete with this chunk.

        Their time stamps are the log's own.
        """
        return self._cycles()
