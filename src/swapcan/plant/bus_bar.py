"""The voltage on the bus bar of a truck, behind the main relays of its pack."""

from __future__ import annotations

import math

from swapcan.plant.relays import Relay, Relays

PRECHARGE_RESISTANCE = 25.0  # ohm
CAPACITANCE = 0.01  # F, of all that hangs on the bus bar
DISCHARGE_TIME = 0.5  # s, time constant of what discharges the bus bar once it is let go

_SHORT_RESISTANCE = 5.0  # ohm


class BusBar:
    """Capacitors that are charged through the precharge relay or the main positive one.

    ``shorted`` says that something on the bus bar draws so much that no precharge gets far.
    """

    def __init__(self) -> None:
        self.voltage = 0.0  # V
        self.shorted = False

    def advance(self, dt: float, battery: float, relays: Relays) -> None:
        """Let so many seconds pass beside a battery with a voltage in V."""
        if not relays.is_closed(Relay.MAIN_NEGATIVE):
            self._settle(dt, 0.0, DISCHARGE_TIME)
        elif relays.is_closed(Relay.MAIN_POSITIVE):
            self.voltage = battery
        elif relays.is_closed(Relay.PRECHARGE):
            share = self._share()
            self._settle(dt, battery * share, PRECHARGE_RESISTANCE * CAPACITANCE * share)
        else:
            self._settle(dt, 0.0, DISCHARGE_TIME)

    def _share(self) -> float:
        if not self.shorted:
            return 1.0
        return _SHORT_RESISTANCE / (_SHORT_RESISTANCE + PRECHARGE_RESISTANCE)

    def _settle(self, dt: float, target: float, time_constant: float) -> None:
        self.voltage = target + (self.voltage - target) * math.exp(-dt / time_constant)
