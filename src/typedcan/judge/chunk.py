"""Some frames of a log as rules see them: decoded, and measured once for all rules."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from typedcan.judge.decoded import DecodedChunk
from typedcan.judge.measure.left_over import LeftOver
from typedcan.judge.measure.presence import Presence, Silence
from typedcan.judge.measure.steps import Stopped, Timing
from typedcan.judge.measure.traffic import Traffic
from typedcan.logs.transfers.cycles import CycleTable
from typedcan.wire.message import Message


class Chunk(DecodedChunk):
    """Consecutive frames of one log, and what was measured of them.

    Parameters
    ----------
    decoded
        The frames.
    timing
        The steps between them, and the silences of nodes that end here.
    nodes
        What came of each node up to the end of the chunk.
    left_over
        The frames that no message's frames hold.
    cycles
        The cycles of readings by group that are complete with this chunk, their time stamps the
        log's own; none where no rule wants them.
    """

    def __init__(
        self,
        decoded: DecodedChunk,
        *,
        timing: Timing,
        nodes: Mapping[str, Presence],
        left_over: LeftOver,
        cycles: Sequence[CycleTable],
    ) -> None:
        super().__init__(
            decoded.block,
            decoded.begin,
            decoded.first_order,
            decoded.end,
            decoded.by_message,
            decoded.sound_by_message,
            seals=decoded.seals,
        )
        self.timing = timing
        self.nodes = nodes
        self.left_over = left_over
        self.cycles = cycles


@dataclass(frozen=True, slots=True, kw_only=True)
class LogEnd:
    """What is known when a log has ended.

    Parameters
    ----------
    time
        The latest time, in seconds since the log's begin.
    nodes, messages
        What came of each node and each message.
    silent
        The nodes that are silent at the end.
    stopped
        The last frame of each message, and of each place in the cycle of those of several.
    traffic
        How many frames of each message came, and on which channel.
    by_frame
        The messages of several frames a cycle of which one frame came each period.
    """

    time: float
    nodes: Mapping[str, Presence]
    messages: Mapping[type[Message], Presence]
    silent: Sequence[Silence]
    stopped: Sequence[Stopped]
    traffic: Traffic
    by_frame: frozenset[type[Message]]
