"""When a simulated pack that was switched off sleeps, and what wakes it."""

from __future__ import annotations

import math
from collections.abc import Sequence

from swapcan.messages import V2B_CMD, HvCommand, RelayState
from typedcan.node.node import Node

_SAVING = 3.0
"""Seconds in which the pack saves its data once it is off."""

_SILENCE = 1.0
"""Seconds after which a truck that speaks again has been asleep."""


class Sleep:
    """The sleep of 5.2.1.4: commanded off, a pack goes off, saves its data, and sleeps.

    The standard says neither how long that takes nor what wakes it. Here it sleeps where it was on,
    was commanded off, and is off for three seconds with no charger connected, whoever still says
    something. It is woken by a charger, by a truck that commands on or reports that its contactors
    are closed, and by one that speaks again after a second of silence. Asleep it sends nothing;
    before that the safe codes of what it has commanded.
    """

    def __init__(self, nodes: Sequence[Node]) -> None:
        self._nodes = nodes
        self._was_on = False
        self._off_since = math.inf
        self._heard_at = math.inf
        self.is_asleep = False

    def step(self, now: float, command: V2B_CMD | None, *, is_open: bool, plugged: bool) -> None:
        """Fall asleep or wake up, by the command that is fresh and by how the pack is now."""
        comes_back = command is not None and now - self._heard_at > _SILENCE
        if command:
            self._heard_at = now
        wanted = comes_back or plugged or not is_open or _wants_power(command)
        self._was_on |= not is_open
        if wanted:
            self._off_since = math.inf
            self._wake()
        elif self._was_on and command and command.hv_on_off == HvCommand.HV_OFF:
            self._off_since = min(self._off_since, now)
        if now - self._off_since >= _SAVING and not self.is_asleep:
            self.is_asleep = all(self._silence(node) for node in self._nodes)
            self._was_on = not self.is_asleep

    def _silence(self, node: Node) -> bool:
        """Let a node send nothing more, unless the bus does not take its safe codes."""
        if node.send_safe_codes():
            return False
        node.sends = "nothing"
        return True

    def _wake(self) -> None:
        self.is_asleep = False
        for node in self._nodes:
            if node.sends == "nothing":
                node.sends = "all"


def _wants_power(command: V2B_CMD | None) -> bool:
    """Whether a truck commands high voltage on, or has made ready for it (5.2.1.2)."""
    return command is not None and (
        command.hv_on_off == HvCommand.HV_ON or command.main_motor_con_st == RelayState.CLOSED
    )
