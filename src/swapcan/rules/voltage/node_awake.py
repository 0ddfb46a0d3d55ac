"""Nodes of this standard are awake while others are, high voltage on or off."""

from __future__ import annotations

from collections.abc import Sequence

from swapcan.rules.voltage.known_silences import KnownSilence, Silences
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings
from typedcan.judge.measure.presence import Silence
from typedcan.judge.rules.timing.node_awake import NodeAwake

PACK, CHARGER = "BMU", "CHG"


class NodeAwakeHere(NodeAwake):
    """As for any protocol, but for the charger, and for what `node-silence` tells.

    A charger is gone once the BMU tells that its gun is off, or a pack is no longer there. The BMU
    sleeps after high voltage is off (5.2.1.4), and `node-silence` looks at it before.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings, may_sleep=frozenset({PACK}))
        self._silences = Silences()
        self._known: dict[Silence, KnownSilence] = {}

    def feed(self, chunk: Chunk) -> None:
        """Note what is known of the silences that end here."""
        self._known |= {each.silence: each for each in self._silences.feed(chunk)}

    def finish(self, end: LogEnd) -> None:
        """Judge all silences."""
        self._known |= {each.silence: each for each in self._silences.finish(end)}
        super().finish(end)

    def excused(self, silence: Silence, awake: Sequence[str]) -> bool:
        """Whether a charger was taken off, or another rule tells of the silence."""
        found = self._known[silence]
        if silence.node == CHARGER and (found.unplugged or PACK not in awake):
            return True
        return found.told
