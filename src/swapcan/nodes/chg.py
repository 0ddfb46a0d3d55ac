"""The simulated charger, CHG: gives what the BMU asks for, as long as it hears it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import ClassVar

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2C_Charger,
    C2B_ACStatus,
    ChargeControl,
    ChargerFault,
    ChargerOperation,
    ChargerTimeout,
)
from swapcan.node import Node
from swapcan.nodes.world import Participant
from typedcan.model.signal_state import SignalState
from typedcan.node.clock import Clock, SystemClock
from typedcan.supervise import NotSeen, State, StateChanged
from typedcan.wire.codec import Codec
from typedcan.wire.link import Received

_SELF_TEST = 0.5
"""Seconds from being connected to the first report."""
_CURRENT_RAMP = 50.0
"""A/s."""
_VOLTAGE_RAMP = 500.0
"""V/s."""
_LARGEST_CURRENT = 300.0
_LARGEST_VOLTAGE = 1000.0


class Chg(Participant):
    """The CHG: rises to the set points of the BMU with a ramp, and falls to them at once.

    It stops at once on a fault, when the BMU says stop, and when it does not hear the BMU any
    more, which it reports as a communication fault. Too hot, it gives half. Its voltage is the one
    that is set: what a pack makes of it is not simulated.

    Parameters
    ----------
    bus
        The charger's bus.
    clock
        The system's where none is given.
    connected
        Whether it is connected to the truck from the beginning.
    codec
        For checksum algorithms of one's own.
    """

    name = "CHG"
    faults: ClassVar[frozenset[str]] = frozenset(
        {"charger_over_temperature", "charger_hardware", "charger_input_voltage"}
    )

    def __init__(
        self,
        bus: can.BusABC,
        *,
        clock: Clock | None = None,
        connected: bool = True,
        codec: Codec | None = None,
    ) -> None:
        self._clock = clock or SystemClock()
        self.node = Node(PROTOCOL, self.name, bus, codec=codec, clock=self._clock)
        super().__init__(self.node, codec=codec)
        self.current = 0.0
        self.voltage = 0.0
        self._wanted: B2C_Charger | None = None
        self._deaf = False
        self._tested_at = math.inf
        self._reporting = False
        self._last_step = self._clock.now()
        self.node.on(B2C_Charger, self._obey)
        self.node.on(StateChanged, self._watch)
        self.node.on(NotSeen, self._miss)
        if connected:
            self.connect()

    @property
    def connected(self) -> bool:
        """Whether it is connected to the truck."""
        return self._tested_at < math.inf

    @property
    def charging(self) -> bool:
        """Whether it gives current, or is about to."""
        return (
            self._reporting
            and not self._deaf
            and not self.has("charger_hardware")
            and not self.has("charger_input_voltage")
            and self._wanted is not None
            and self._wanted.charge_control == ChargeControl.START_TO_CHARGE
        )

    @property
    def status(self) -> str:
        """What it does, in words."""
        if not self.connected:
            return "not connected"
        if self._deaf:
            return "stopped: BMU not heard"
        return "charging" if self.charging else "connected"

    def connect(self) -> None:
        """Be connected to the truck: test itself, then report."""
        if not self.connected:
            self._tested_at = self._clock.now() + _SELF_TEST

    def disconnect(self) -> None:
        """Be taken off the truck: no current, no reports, nothing heard."""
        self._tested_at = math.inf
        self._reporting = self._deaf = False
        self.current = self.voltage = 0.0
        self._wanted = None
        self.node.clear(C2B_ACStatus)

    def step(self, now: float) -> None:
        """Come nearer to the set points."""
        passed, self._last_step = now - self._last_step, now
        if now >= self._tested_at and not self._reporting:
            self._reporting = True
            self.supply(C2B_ACStatus, self._report)
        current, voltage = self._goal()
        self.current = min(current, self.current + _CURRENT_RAMP * passed)
        self.voltage = min(voltage, self.voltage + _VOLTAGE_RAMP * passed)
        if self.line:
            self.line.charge = self.current
            self.line.plugged = self.connected

    def _goal(self) -> tuple[float, float]:
        """The current and the voltage to come to."""
        if not self.charging or self._wanted is None:
            return 0.0, 0.0
        largest = _LARGEST_CURRENT / (2 if self.has("charger_over_temperature") else 1)
        current, voltage = self._wanted.current_set, self._wanted.voltage_set
        if isinstance(current, SignalState) or isinstance(voltage, SignalState):
            return 0.0, 0.0
        return min(current, largest), min(voltage, _LARGEST_VOLTAGE)

    def _obey(self, received: Received[B2C_Charger]) -> None:
        if self.connected:
            self._wanted = received.message
            self._deaf = False

    def _watch(self, event: StateChanged) -> None:
        if event.message is B2C_Charger and event.new is State.LOST:
            self._deaf = True

    def _miss(self, event: NotSeen) -> None:
        if event.message is B2C_Charger:
            self._deaf = True

    def _report(self) -> Iterator[C2B_ACStatus]:
        off = ChargerOperation.OFF_IN_ORDER_TO_PREVENT_BATTERY_REVERSE_CONNECTION
        yield C2B_ACStatus(
            voltage_output=self.voltage,
            current_output=self.current,
            charger_hardware=self._flag("charger_hardware"),
            charger_over_temp=self._flag("charger_over_temperature"),
            charger_input_voltage=self._flag("charger_input_voltage"),
            charger_ready=ChargerTimeout.NORMAL,
            charger_start=ChargerOperation.ON if self.charging else off,
            charger_can=ChargerTimeout.FAULT_OVERTIME if self._deaf else ChargerTimeout.NORMAL,
        )

    def _flag(self, fault: str) -> ChargerFault:
        return ChargerFault.FAULT if self.has(fault) else ChargerFault.OK
