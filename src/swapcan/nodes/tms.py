"""The simulated cooling unit, TMS: does what the BMU asks for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import ClassVar

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    BMS_TMS_0,
    TMS_BMS_0,
    HvRelayState,
    HvRequest,
    ThermalMode,
    WarningLevel,
)
from swapcan.node import Node
from swapcan.nodes.world import Participant
from typedcan.model.code_types import Code2
from typedcan.model.signal_state import SignalState
from typedcan.node.clock import Clock, SystemClock
from typedcan.supervise import State, StateChanged
from typedcan.wire.codec import Codec
from typedcan.wire.link import Received

_AMBIENT = 25.0
"""degC of the water that is neither cooled nor heated."""
_TIME_CONSTANT = 60.0
"""Seconds in which the water comes nearer to its temperature by a factor of e."""
_SPREAD = 3.0
"""degC between outlet and inlet while it cools or heats."""
_DEMAND = 5
"""Power that it asks for while it cools or heats; the standard gives no unit."""
_FAULT_CODE = 1


class Tms(Participant):
    """The TMS: takes over mode and set temperature, and closes its relay when it may.

    Cools and heats only with high voltage. Switches off when the BMU is lost.

    Parameters
    ----------
    bus
        The vehicle's bus.
    clock
        The system's where none is given.
    codec
        For checksum algorithms of one's own.
    """

    name = "TMS"
    faults: ClassVar[frozenset[str]] = frozenset({"tms_fault"})

    def __init__(
        self, bus: can.BusABC, *, clock: Clock | None = None, codec: Codec | None = None
    ) -> None:
        clock = clock or SystemClock()
        self.node = Node(PROTOCOL, self.name, bus, codec=codec, clock=clock)
        super().__init__(self.node, codec=codec)
        self.outlet = self.inlet = _AMBIENT
        self._wanted = BMS_TMS_0(reqst_tms_hv_on=HvRequest.REQUEST_HV_OFF)
        self._alone = True
        self._last_step = clock.now()
        self.node.on(BMS_TMS_0, self._obey)
        self.node.on(StateChanged, self._watch)
        self.supply(TMS_BMS_0, self._report)

    @property
    def mode(self) -> ThermalMode | Code2:
        """What it does."""
        if self._alone or self.has("tms_fault"):
            return ThermalMode.OFF
        wanted = self._wanted.reqst_set_tms_sts
        needs_power = wanted in (ThermalMode.COOLING, ThermalMode.HEATING)
        return ThermalMode.SELF_CIRCULATION if needs_power and not self._powered else wanted

    @property
    def status(self) -> str:
        """What it does, in words."""
        return "fault" if self.has("tms_fault") else TMS_BMS_0.FIELDS["work_sts"].text(self.mode)

    def step(self, now: float) -> None:
        """Let the water come nearer to the temperature that it is to have."""
        passed, self._last_step = now - self._last_step, now
        goal, spread = _AMBIENT, 0.0
        if self.mode in (ThermalMode.COOLING, ThermalMode.HEATING):
            wanted = self._wanted.set_temp
            goal = _AMBIENT if isinstance(wanted, SignalState) else wanted
            spread = _SPREAD if self.mode is ThermalMode.COOLING else -_SPREAD
        part = min(1.0, passed / _TIME_CONSTANT)
        self.outlet += (goal - self.outlet) * part
        self.inlet += (self.outlet + spread - self.inlet) * part

    @property
    def _powered(self) -> bool:
        """Whether its high-voltage relay is closed."""
        return (
            not self._alone
            and not self.has("tms_fault")
            and self._wanted.hv_rly_sts == HvRelayState.CLOSED
            and self._wanted.reqst_tms_hv_on == HvRequest.REQUEST_HV_ON
        )

    def _obey(self, received: Received[BMS_TMS_0]) -> None:
        self._wanted = received.message
        self._alone = False

    def _watch(self, event: StateChanged) -> None:
        if event.message is BMS_TMS_0 and event.new is State.LOST:
            self._alone = True

    def _report(self) -> Iterator[TMS_BMS_0]:
        failed = self.has("tms_fault")
        busy = self.mode in (ThermalMode.COOLING, ThermalMode.HEATING)
        yield TMS_BMS_0(
            work_sts=self.mode,
            hv_rly_sts=HvRelayState.CLOSED if self._powered else HvRelayState.OPEN,
            output_water_temp=self.outlet,
            input_water_temp=self.inlet,
            reqst_cap=_DEMAND if busy else 0,
            fault_code=_FAULT_CODE if failed else 0,
            fault_lv=WarningLevel.LEVEL_2 if failed else WarningLevel.INACTIVE,
        )
