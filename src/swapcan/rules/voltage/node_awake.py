"""Nodes of this standard are awake while others are, high voltage on or off."""

from __future__ import annotations

from collections.abc import Sequence

from swapcan.messages import HvCommand
from swapcan.rules.voltage.known_silences import KnownSilence, Silences
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings
from typedcan.judge.measure.presence import Silence
from typedcan.judge.rules.timing.node_awake import NodeAwake

PACK, CHARGER, VEHICLE = "BMU", "CHG", "VCU"


class NodeAwakeHere(NodeAwake):
    """As for any protocol, but for charger and pack, and for what `node-silence` tells.

    A charger is gone once the BMU tells that its gun is off, or a pack is no longer there; and a
    pack once the swap controller tells that it is off. The BMU sleeps after the command to switch
    off (5.2.1.4), though not while the VCU is awake, as E64 reads it.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
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
        slept = found.known.command in (HvCommand.HV_OFF, None) and VEHICLE not in awake
        if silence.node == PACK and (found.swapped or slept):
            return True
        return found.told

    def errata(self, silence: Silence) -> tuple[str, ...]:
        """A pack that was switched off may sleep, and so may one of which that is not known."""
        known = self._known[silence].known
        may = silence.node == PACK and known.command in (HvCommand.HV_OFF, None)
        return ("E64",) if may else ()
