"""Silences of nodes, and what was known when they began."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import (
    B2V_ST1,
    BSU_BMS_0,
    V2B_CMD,
    BmsState,
    C2B_ACStatus,
    ChargeLine,
    ChargeState,
    ConnectorState,
    LockState,
)
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
    command
        Raw V2B_CMD_HV_OnOff.
    """

    bms: int | None = None
    chg_st: int | None = None
    current: int | None = None
    command: int | None = None

    @property
    def high_voltage_on(self) -> bool:
        """Whether high voltage is on, or coming."""
        return self.bms in HV_ON

    @property
    def charging(self) -> bool:
        """Whether the charger is at work."""
        return bool(self.current) or self.chg_st == ChargeState.CHARGING


class KnownSilence(NamedTuple):
    """A silence, what was known when it began, and what was told during it.

    Parameters
    ----------
    unplugged, swapped
        Whether the charging gun was off, and the pack not locked or not connected.
    """

    silence: Silence
    known: Known
    unplugged: bool
    swapped: bool

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
        # Numbers of the last frames that told that the gun, and that the pack, was off.
        self._unplugged = self._swapped = -1

    def feed(self, chunk: Chunk) -> list[KnownSilence]:
        """The silences that ended in the next frames."""
        found = [
            KnownSilence(
                each,
                self._when(chunk, each),
                _is_between(each, self._unplugged, _gun_off(chunk)),
                _is_between(each, self._swapped, _pack_off(chunk)),
            )
            for each in chunk.timing.silences
        ]
        for node, seen in chunk.nodes.items():
            if seen.last_order >= chunk.first_order:
                self._last[node] = _known(chunk, seen.last_order)
        self._unplugged = int(max(_gun_off(chunk), default=self._unplugged))
        self._swapped = int(max(_pack_off(chunk), default=self._swapped))
        return found

    def finish(self, end: LogEnd) -> list[KnownSilence]:
        """The nodes that are silent when the log ends."""
        return [
            KnownSilence(
                each,
                self._last[each.node],
                self._unplugged > each.order,
                self._swapped > each.order,
            )
            for each in end.silent
        ]

    def _when(self, chunk: Chunk, silence: Silence) -> Known:
        if silence.order >= chunk.first_order:
            return _known(chunk, silence.order)
        return self._last[silence.node]


def _gun_off(chunk: Chunk) -> NDArray[np.int64]:
    status = chunk.sound(B2V_ST1)
    found: NDArray[np.int64] = status.order[status.raw("chg_line") == ChargeLine.NOT_CONNECTED]
    return found


def _pack_off(chunk: Chunk) -> NDArray[np.int64]:
    swap = chunk.sound(BSU_BMS_0)
    off = swap.raw("lock") == LockState.UNLOCKED
    off |= swap.raw("connect_st") == ConnectorState.NOT_CONNECTED
    found: NDArray[np.int64] = swap.order[off]
    return found


def _is_between(silence: Silence, before: int, now: NDArray[np.int64]) -> bool:
    """Whether a frame came during a silence: the last one of before, or one of these."""
    during = (now > silence.order) & (now < silence.next_order)
    return before > silence.order or bool(during.any())


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
    commands = chunk.sound(V2B_CMD)
    row = int(np.searchsorted(commands.order, order, "right")) - 1
    if row >= 0:
        known = replace(known, command=int(commands.raw("hv_on_off")[row]))
    return known
