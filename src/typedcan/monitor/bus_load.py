"""How busy a bus is: frames per second, and an estimate of the load from the lengths of frames."""

from __future__ import annotations

import math
from collections import deque

import can

from typedcan.model.frame_time import usual_bits

_BUCKET = 0.25
_BUCKETS = 8
"""The rates are those of the last two seconds, in steps of a quarter."""


class BusLoad:
    """Counts frames and their bits; times are seconds that never go back.

    Parameters
    ----------
    now
        When counting begins.
    bitrate
        Of the bus, in bit/s; None where it is not known.
    """

    def __init__(self, now: float, bitrate: float | None) -> None:
        self._began = now
        self._bitrate = bitrate
        self._buckets: deque[list[float]] = deque()  # number of the bucket, frames, bits

    def add(self, frame: can.Message, now: float) -> None:
        """Count a frame that came at ``now``."""
        number = now // _BUCKET
        if not self._buckets or self._buckets[-1][0] != number:
            self._buckets.append([number, 0, 0])
            if len(self._buckets) > _BUCKETS:
                self._buckets.popleft()
        bucket = self._buckets[-1]
        bucket[1] += 1
        length = 0 if frame.is_remote_frame else len(frame.data)
        bucket[2] += usual_bits(length, extended=frame.is_extended_id)

    def rates(self, now: float) -> tuple[float, float | None]:
        """Frames per second, and the estimated share of the time that the bus is busy.

        The share is None where the bit rate is not known.
        """
        first = now // _BUCKET - _BUCKETS + 1
        span = now - max(first * _BUCKET, self._began)
        if not span > 0:
            return 0.0, None if self._bitrate is None else 0.0
        counted = [bucket for bucket in self._buckets if bucket[0] >= first]
        frames = math.fsum(bucket[1] for bucket in counted)
        bits = math.fsum(bucket[2] for bucket in counted)
        return frames / span, None if self._bitrate is None else bits / span / self._bitrate
