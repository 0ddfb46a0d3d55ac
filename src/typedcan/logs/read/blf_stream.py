"""The objects of a BLF log, which go on from one container into the next."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.blf_containers import BrokenLog, Piece
from typedcan.logs.read.blf_objects import frames
from typedcan.logs.read.blf_scan import scan
from typedcan.logs.read.blocks import Channels


class ObjectStream:
    """Takes the frames out of the contents of containers.

    Parameters
    ----------
    start_time
        When the log began: seconds since 1970, or 0 where it does not say.
    """

    def __init__(self, start_time: float) -> None:
        self.passed: Counter[str] = Counter()
        """What is no frame on the bus, by kind."""
        self._start_time = start_time
        self._channels = Channels()
        self._tail = b""
        self._skip = 0

    def frames(self, batch: list[Piece]) -> Iterator[FrameBlock]:
        """The frames that are complete with these pieces; the rest waits for the next ones.

        Raises `BrokenLog`, after the frames before it.
        """
        held = len(self._tail) - self._skip  # where the batch begins in data
        data = b"".join([self._tail, *(piece.data for piece in batch)])
        if self._skip:
            data = data[self._skip :]
            self._skip = max(-held - sum(len(piece.data) for piece in batch), 0)
        found = scan(data)
        try:
            block, understood = frames(
                data, found.starts, self._start_time, self._channels, self.passed
            )
        except ValueError as error:
            raise batch[0].broken(str(error)) from None
        if block is not None:
            yield block
        if understood < len(found.starts):
            place = int(found.starts[understood])
            raise _piece(batch, place - held).broken("an object is too short for a frame")
        if found.problem:
            raise _piece(batch, found.stop - held).broken(found.problem)
        self._tail = b"" if found.missing else data[found.stop :]
        self._skip += found.missing

    def check_end(self, size: int, expected: int) -> None:
        """Raise `BrokenLog` where the log, of ``size`` bytes, ends within an object or too early.

        ``expected`` is the size that the header of the log states: 0 if it was never closed.
        """
        if self._skip or self._tail.strip(b"\0"):
            raise BrokenLog(size, "the file ends within an object")
        if expected > size:
            raise BrokenLog(size, f"the file ends, of {expected:,} bytes that it should have")


def _piece(batch: list[Piece], place: int) -> Piece:
    """The one that holds this place of the batch; the first, where it lies before them all."""
    end = 0
    for piece in batch:
        end += len(piece.data)
        if place < end:
            return piece
    return batch[-1]
