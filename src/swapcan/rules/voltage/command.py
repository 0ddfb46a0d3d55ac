"""The command of the VCU that is in force."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import V2B_CMD
from typedcan.judge.chunk import Chunk
from typedcan.judge.series import Series, latest

_NEVER = 15  # an alive counter without meaning


class Commands:
    """The commands that a pack can believe: whole, and with an alive counter that moves."""

    def __init__(self) -> None:
        self._time = -math.inf
        self._code = 0

    def at(self, chunk: Chunk, at: Series) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
        """For each row whether one is in force, and its V2B_CMD_HV_OnOff.

        To be called once for each chunk.
        """
        commands = chunk.sound(V2B_CMD)
        if not len(commands):
            return np.zeros(len(at), np.bool_), np.zeros(len(at), np.int64)
        moves = moving(commands)
        rows = np.maximum.accumulate(np.where(moves, np.arange(len(commands)), -1))
        time = np.where(rows >= 0, commands.time[rows], self._time)
        code = np.where(rows >= 0, commands.raw("hv_on_off")[rows], self._code)
        self._time, self._code = float(time[-1]), int(code[-1])
        beside = latest(commands, at)
        known = (beside >= 0) & (at.time - time[beside] <= commands.lasts)
        return known, code[beside]


def moving(commands: Series) -> NDArray[np.bool_]:
    """The commands whose alive counter differs from the one before; not the row of before."""
    counter = commands.raw("aliv")
    moves: NDArray[np.bool_] = counter != _NEVER
    moves[1:] &= counter[1:] != counter[:-1]
    moves[: commands.first] = False
    return moves
