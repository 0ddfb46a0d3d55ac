"""The simulated swap controller, BSU: the lock and the connector of the pack."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import BSU_BMS_0, ConnectorState, LockState, WarningLevel
from swapcan.node import Node
from swapcan.nodes.world import Participant
from typedcan.node.clock import Clock, SystemClock
from typedcan.wire.codec import Codec

_AMBIENT = 31.0
_HOT = 100.0
"""degC of the connector, well and with the fault."""
_TIME_CONSTANT = 2.0
"""Seconds in which it comes nearer to one of them by a factor of e."""
_WARN_AT = (
    (90.0, WarningLevel.LEVEL_3),
    (80.0, WarningLevel.LEVEL_2),
    (70.0, WarningLevel.LEVEL_1),
)


class Bsu(Participant):
    """The BSU: reports that the pack is locked and connected.

    Parameters
    ----------
    bus
        The vehicle's bus.
    clock
        The system's where none is given.
    codec
        For checksum algorithms of one's own.
    """

    name = "BSU"
    faults: ClassVar[frozenset[str]] = frozenset({"connector_over_temperature"})

    def __init__(
        self, bus: can.BusABC, *, clock: Clock | None = None, codec: Codec | None = None
    ) -> None:
        clock = clock or SystemClock()
        self.node = Node(PROTOCOL, self.name, bus, codec=codec, clock=clock)
        super().__init__(self.node, codec=codec)
        self.locked = True
        self.temperature = _AMBIENT
        self._last_step = clock.now()
        self.supply(BSU_BMS_0, self._report)

    @property
    def status(self) -> str:
        """Whether the pack is locked."""
        return "locked" if self.locked else "unlocked"

    @property
    def warning(self) -> WarningLevel:
        """Of the connector's temperature."""
        levels = (level for limit, level in _WARN_AT if self.temperature >= limit)
        return next(levels, WarningLevel.INACTIVE)

    def lock(self) -> None:
        """Lock the pack and connect it."""
        self.locked = True

    def unlock(self) -> None:
        """Disconnect the pack and unlock it."""
        self.locked = False

    def step(self, now: float) -> None:
        """Let the connector's temperature follow."""
        passed, self._last_step = now - self._last_step, now
        goal = _HOT if self.has("connector_over_temperature") else _AMBIENT
        self.temperature += (goal - self.temperature) * min(1.0, passed / _TIME_CONSTANT)

    def _report(self) -> Iterator[BSU_BMS_0]:
        yield BSU_BMS_0(
            lock=LockState.LOCKED if self.locked else LockState.UNLOCKED,
            connect_st=ConnectorState.CONNECTED if self.locked else ConnectorState.NOT_CONNECTED,
            connector_temp=self.temperature,
            conctor_temp_warn=self.warning,
        )
