"""The high-voltage sequence of a pack, clause 5.2.1 with tables 1, 2 and 14, as a state machine.

On: main negative, precharge, main positive once the bus bar is up, precharge off. Off: main
positive once the current is gone, main negative once the bus bar has proven it open.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum, auto

from swapcan.messages import BmsState
from swapcan.plant.relays import Relay, Relays

PRECHARGED = 0.95
"""Share of the battery's voltage at which the bus bar counts as precharged."""

CURRENT_GONE = 10.0
"""A: what may flow when a relay opens."""

UNLOADING_LIMIT = 2.0
"""Seconds to wait for that."""

_DROPPED = 0.9  # share of the battery's voltage below which the main positive is proven open
_DROPPED_LIMIT = 0.5  # s in which the bus bar has to get there
_LOOSE = 0.5  # share below which a weld can be over
_LOOSE_TIME = 1.0  # s for which it has to stay there
_OBEY_LIMIT = 5.0  # s in which the VCU has to switch off when asked to
_SILENCE_LIMIT = 10.0  # s without any command after which the pack opens


class Command(Enum):
    """What the VCU wants: nothing also where it is silent or says nothing valid."""

    NONE = auto()
    ON = auto()
    OFF = auto()


@dataclass(frozen=True, slots=True, kw_only=True)
class Demand:
    """What the sequence depends on.

    Parameters
    ----------
    command, accessory
        Of the VCU: high voltage, and the accessory relay.
    battery, bus_bar
        Voltages on both sides of the main relays, in V.
    current
        Through them, in A.
    fault
        Whether a fault of the gravest level is there.
    """

    command: Command
    accessory: bool = False
    battery: float
    bus_bar: float
    current: float = 0.0
    fault: bool = False


class _Phase(Enum):
    OPEN = auto()
    NEGATIVE = auto()
    PRECHARGE_RELAY = auto()
    PRECHARGING = auto()
    POSITIVE = auto()
    PRECHARGE_OFF = auto()
    CLOSED = auto()
    UNLOADING = auto()
    OPENING = auto()


_CLOSING = frozenset(
    {
        _Phase.NEGATIVE,
        _Phase.PRECHARGE_RELAY,
        _Phase.PRECHARGING,
        _Phase.POSITIVE,
        _Phase.PRECHARGE_OFF,
    }
)


class HighVoltage:
    """The sequence; times are seconds that are handed in.

    Parameters
    ----------
    relays
        What it switches; others may switch theirs among them.
    precharge_limit
        Seconds after which a precharge has failed.

    ``failed`` holds from a failure to switch on until the VCU commands off; ``self_opened`` from
    when the pack opened on its own until the same.
    """

    def __init__(self, relays: Relays, *, precharge_limit: float = 3.0) -> None:
        self.relays = relays
        self.failed = False
        self.self_opened = False
        self._precharge_limit = precharge_limit
        self._phase = _Phase.OPEN
        self._since = 0.0  # when the phase, or the proof that the main positive is open, began
        self._proving = False
        self._fault_since = math.inf
        self._heard = 0.0
        self._dropped_since = math.inf
        self._steps: Mapping[_Phase, Callable[[float, Demand], None]] = {
            _Phase.OPEN: self._open,
            _Phase.NEGATIVE: self._negative,
            _Phase.PRECHARGE_RELAY: self._precharge_relay,
            _Phase.PRECHARGING: self._precharging,
            _Phase.POSITIVE: self._positive,
            _Phase.PRECHARGE_OFF: self._precharge_off,
            _Phase.CLOSED: self._closed,
            _Phase.UNLOADING: self._unloading,
            _Phase.OPENING: self._opening,
        }

    @property
    def state(self) -> BmsState:
        """The state as the VCU is told."""
        closed = self.relays.closed
        if self._phase in _CLOSING:
            return BmsState.PRECHARGE
        if Relay.MAIN_POSITIVE in closed and Relay.MAIN_NEGATIVE in closed:
            return BmsState.HV_CLOSED
        return BmsState.FAIL_TO_HV_ON if self.failed else BmsState.HV_OPEN

    @property
    def carries_load(self) -> bool:
        """Whether the truck may draw current."""
        return self._phase is _Phase.CLOSED

    def step(self, now: float, demand: Demand) -> None:
        """Go on to a time: let contacts follow, and switch what is to be switched."""
        if demand.command is not Command.NONE:
            self._heard = now
        if demand.command is Command.OFF:
            self.failed = False
            self.self_opened = False
        self._fault_since = min(self._fault_since, now) if demand.fault else math.inf
        self.relays.advance(now)
        self._look_for_loose_weld(now, demand)
        if self._phase in _CLOSING and self._must_break_off(demand):
            self._go(_Phase.OPENING, now)
        self._steps[self._phase](now, demand)

    def _must_break_off(self, demand: Demand) -> bool:
        if demand.fault:
            self.failed = True
        return demand.fault or demand.command is not Command.ON

    def _go(self, phase: _Phase, now: float) -> None:
        self._phase = phase
        self._since = now

    def _switch(self, relay: Relay, now: float, phase: _Phase, *, closed: bool = True) -> None:
        """Switch a relay and go to the phase that waits for it, unless another one is switching."""
        if self.relays.settled:
            self.relays.command(relay, closed=closed, now=now)
            self._go(phase, now)

    def _went(self, relay: Relay, now: float) -> bool:
        """Whether a relay that was told to has closed; where it cannot, switching on has failed."""
        if not self.relays.settled:
            return False
        if not self.relays.is_closed(relay):
            self._fail(now)
            return False
        return True

    def _fail(self, now: float) -> None:
        self.failed = True
        self._go(_Phase.OPENING, now)

    def _open(self, now: float, demand: Demand) -> None:
        if demand.command is not Command.ON or self.failed or self.self_opened:
            return
        if demand.fault or self.relays.weld_faults:
            self.failed = True
            return
        self._switch(Relay.MAIN_NEGATIVE, now, _Phase.NEGATIVE)

    def _negative(self, now: float, _: Demand) -> None:
        if self._went(Relay.MAIN_NEGATIVE, now):
            self._switch(Relay.PRECHARGE, now, _Phase.PRECHARGE_RELAY)

    def _precharge_relay(self, now: float, _: Demand) -> None:
        if self._went(Relay.PRECHARGE, now):
            self._go(_Phase.PRECHARGING, now)

    def _precharging(self, now: float, demand: Demand) -> None:
        if demand.bus_bar >= PRECHARGED * demand.battery:
            self._switch(Relay.MAIN_POSITIVE, now, _Phase.POSITIVE)
        elif now - self._since >= self._precharge_limit:
            self._fail(now)

    def _positive(self, now: float, _: Demand) -> None:
        if self._went(Relay.MAIN_POSITIVE, now):
            self._switch(Relay.PRECHARGE, now, _Phase.PRECHARGE_OFF, closed=False)

    def _precharge_off(self, now: float, _: Demand) -> None:
        if self.relays.settled:
            self._go(_Phase.CLOSED, now)

    def _closed(self, now: float, demand: Demand) -> None:
        self.self_opened = now - self._fault_since >= _OBEY_LIMIT
        silent = now - self._heard >= _SILENCE_LIMIT
        if demand.command is Command.OFF or self.self_opened or silent:
            self._go(_Phase.UNLOADING, now)
        elif demand.accessory is not self.relays.is_commanded(Relay.ACCESSORY):
            self._switch(Relay.ACCESSORY, now, _Phase.CLOSED, closed=demand.accessory)

    def _unloading(self, now: float, demand: Demand) -> None:
        if abs(demand.current) < CURRENT_GONE or now - self._since >= UNLOADING_LIMIT:
            self._go(_Phase.OPENING, now)

    def _opening(self, now: float, demand: Demand) -> None:
        if not self.relays.settled:
            return
        for relay in (Relay.ACCESSORY, Relay.PRECHARGE, Relay.MAIN_POSITIVE):
            if self.relays.is_commanded(relay):
                self._switch(relay, now, _Phase.OPENING, closed=False)
                self._proving = relay is Relay.MAIN_POSITIVE
                return
        if self._proving and not self._proven(now, demand):
            return
        if self.relays.is_commanded(Relay.MAIN_NEGATIVE):
            self._switch(Relay.MAIN_NEGATIVE, now, _Phase.OPENING, closed=False)
        else:
            self._go(_Phase.OPEN, now)

    def _proven(self, now: float, demand: Demand) -> bool:
        """Whether the bus bar has told what the main positive relay did."""
        dropped = demand.bus_bar < _DROPPED * demand.battery
        if not dropped and now - self._since < _DROPPED_LIMIT:
            return False
        if not dropped:
            self.relays.weld_faults.add(Relay.MAIN_POSITIVE)
        self._proving = False
        return True

    def _look_for_loose_weld(self, now: float, demand: Demand) -> None:
        welds = self.relays.weld_faults
        if Relay.MAIN_POSITIVE not in welds:
            return
        if self.relays.is_closed(Relay.MAIN_POSITIVE) or demand.bus_bar >= _LOOSE * demand.battery:
            self._dropped_since = math.inf
            return
        self._dropped_since = min(self._dropped_since, now)
        if now - self._dropped_since >= _LOOSE_TIME:
            welds.discard(Relay.MAIN_POSITIVE)
            self._dropped_since = math.inf
