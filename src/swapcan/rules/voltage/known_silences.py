"""Silences of nodes, and what was known when they began."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from swapcan.messages import B2V_ST1, BmsState, C2B_ACStatus, ChargeLine, ChargeState
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.measure.presence import Silence

HV_ON = (BmsState.PRECHARGE, BmsState.HV_CLOSED)
"""States of the BMU in which high voltage is on, or coming."""


@dataclass(frozen=True, slots=True)
class Known:
    """What the BMU and the charger told last; None: nothing yet.

    Parameters
    ----------
    bms, chg_st
        Raw values of B2V_ST1.
    current
        Raw output current of C2B_ACStatus.
    """

    bms: int | None = None
    chg_st: int | None = None
    current: int | None = None

    @property
    def high_voltage_on(self) -> bool:
        """Whether high voltage is on, or coming."""
        return self.bms in HV_ON

    @property
    def charging(self) -> bool:
        """Whether the charger is at work."""
        return bool(self.current) or self.chg_st == ChargeState.CHARGING


class KnownSilence(NamedTuple):
    """A silence, what was known when it began, and whether the charging gun was off during it."""

    silence: Silence
    known: Known
    unplugged: bool

    @property
    def told(self) -> bool:
        """Whether a node fell silent under high voltage that may not: what `node-silence` tells.

        A charger may when it gives no current and the pack does not charge, and when its gun is
        off: then it cannot send any more.
        """
        if self.silence.node == "CHG" and (self.unplugged or not self.known.charging):
            return False
        return self.known.high_voltage_on


class Silences:
    """Follows the silences of one log."""

    def __init__(self) -> None:
        self._last: dict[str, Known] = {}
        self._unplugged = -1  # number of the last frame that told that the gun was off

    def feed(self, chunk: Chunk) -> list[KnownSilence]:
        """The silences that ended in the next frames."""
        found = [
            KnownSilence(
                each,
                self._when(chunk, each),
                self._was_unplugged(chunk, each.order, each.next_order),
            )
            for each in chunk.timing.silences
        ]
        for node, seen in chunk.nodes.items():
            if seen.last_order >= chunk.first_order:
                self._last[node] = _known(chunk, seen.last_order)
        status = chunk.sound(B2V_ST1)
        off = np.flatnonzero(status.raw("chg_line") == ChargeLine.NOT_CONNECTED)
        if len(off):
            self._unplugged = int(status.order[off[-1]])
        return found

    def finish(self, end: LogEnd) -> list[KnownSilence]:
        """The nodes that are silent when the log ends."""
        return [
            KnownSilence(each, self._last[each.node], self._unplugged > each.order)
            for each in end.silent
        ]

    def _when(self, chunk: Chunk, silence: Silence) -> Known:
        if silence.order >= chunk.first_order:
            return _known(chunk, silence.order)
        return self._last[silence.node]

    def _was_unplugged(self, chunk: Chunk, after: int, until: int) -> bool:
        status = chunk.sound(B2V_ST1)
        off = status.order[status.raw("chg_line") == ChargeLine.NOT_CONNECTED]
        return after < self._unplugged or bool(((off > after) & (off < until)).any())


def _known(chunk: Chunk, order: int) -> Known:
    """What was told up to a frame of the chunk."""
    known = Known()
    status, charger = chunk.sound(B2V_ST1), chunk.sound(C2B_ACStatus)
    row = int(np.searchsorted(status.order, order, "right")) - 1
    if row >= 0:
        bms, chg_st = status.raw("bms")[row], status.raw("chg_st")[row]
        known = replace(known, bms=int(bms), chg_st=int(chg_st))
    row = int(np.searchsorted(charger.order, order, "right")) - 1
    if row >= 0:
        known = replace(known, current=int(charger.raw("current_output")[row]))
    return known
