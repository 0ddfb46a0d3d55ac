"""The simulated truck, VCU: switches the high voltage on, drives, and watches the BMU."""

from __future__ import annotations

import math
from collections.abc import Iterator
from enum import Enum

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_RQ,
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    B2V_ST3,
    V2B_CMD,
    AccessoryHvCommand,
    BattInfoRequest,
    BmsState,
    ContactorFault,
    FaultLevel,
    HeatCommand,
    HvCommand,
    HvOffRequest,
    RelayState,
    SysCodeRequest,
    V2B_RQData,
)
from swapcan.node import Node
from swapcan.node.answers import BatteryInfo
from swapcan.nodes.world import Participant
from swapcan.plant.driving import Motion, Power, Profile, Trip, shuttle
from swapcan.transfer import PackCode, split_vin
from typedcan.model.signal_state import SignalState
from typedcan.node.clock import Clock, SystemClock
from typedcan.node.request import Pending
from typedcan.supervise import State, StateChanged
from typedcan.transfer import split
from typedcan.wire.codec import Codec
from typedcan.wire.link import Received
from typedcan.wire.message import Message

VIN = "LDEMTRCK0R0000025"
"""Of the simulated truck."""

_REPORTS = 2
"""Frames that tell of the closed contactors before high voltage is commanded (5.2.1.2)."""

_DERATED = 0.5
"""Part of the battery's limits that is used while it reports a fault of level 2."""


class Mode(Enum):
    """What the truck wants of the BMU; the values are for people."""

    OFF = "off"
    REPORTING = "contactors closed"
    ON = "high voltage commanded"


class Vcu(Participant):
    """The VCU of a truck with a driver who does as told.

    It gives the VIN when asked, keeps the current within the limits of B2V_ST2, and brings the
    truck to a stop with high voltage off when the BMU asks for that, reports a fault of level 3,
    cannot switch on, or is lost: `trouble` says which, until `hv_on`.

    Parameters
    ----------
    bus
        The vehicle's bus.
    clock
        The system's where none is given.
    vin
        Of the truck; raises `TransferError` where it cannot be sent.
    codec
        For checksum algorithms of one's own.
    """

    name = "VCU"

    def __init__(
        self,
        bus: can.BusABC,
        *,
        clock: Clock | None = None,
        vin: str = VIN,
        codec: Codec | None = None,
    ) -> None:
        clock = clock or SystemClock()
        self.node = Node(PROTOCOL, self.name, bus, codec=codec, clock=clock)
        super().__init__(self.node, codec=codec)
        self.mode = Mode.OFF
        self.trouble = ""
        self.states: list[BmsState | int] = []
        self.motion = Motion()
        self.load = 0.0
        self.pack_code: Pending[PackCode] | None = None
        self.battery_info: Pending[BatteryInfo] | None = None
        self._reports = 0
        self._trip: Trip | None = None
        self._switching_off = False
        self._level: FaultLevel | int = FaultLevel.NORMAL
        self._last_step = clock.now()
        split_vin(vin)  # refuses what is none
        self.node.provide(*split(self.protocol.transfer("vin"), vin))
        self.supply(V2B_CMD, self._command)
        self.ask_for(
            V2B_RQData(
                rq_batt_info=BattInfoRequest.NOT_REQUEST_BATTINFO_DATA,
                rq_sys_code=SysCodeRequest.NOT_REQUEST_SYSCODE_DATA,
            )
        )
        self.node.on(B2V_ST1, self._see_status)
        self.node.on(B2V_RQ, self._see_request)
        self.node.on(StateChanged, self._watch)

    @property
    def status(self) -> str:
        """What it does, in words."""
        if self.trouble:
            return f"{self.mode.value}: {self.trouble}"
        if self.mode is Mode.ON and self._voltage > 0:
            idle = "ready" if self.motion.speed == 0 else "stopping"
            return "driving" if self._trip else idle
        return self.mode.value

    def hv_on(self) -> None:
        """Have high voltage: close the own contactors, report them, then command it."""
        self.trouble = ""
        self._switching_off = False
        if self.mode is Mode.OFF:
            self._reports = 0
            self.mode = Mode.REPORTING

    def drive(self, seconds: float = math.inf, profile: Profile = shuttle) -> None:
        """Follow a speed for so many seconds, once there is high voltage, then stop."""
        self._trip = Trip(profile, seconds)

    def stop(self) -> None:
        """Brake to a stop; high voltage stays."""
        self._trip = None

    def hv_off(self) -> None:
        """Brake to a stop, then switch the high voltage off."""
        self.stop()
        self._switching_off = True

    def withdraw(self) -> None:
        """Command high voltage off at once, whatever the speed, and ask for nothing more."""
        self._off()
        for pending in (self.pack_code, self.battery_info):
            if pending:
                pending.cancel()

    def ask(self) -> None:
        """Ask the BMU for pack code and basic data: see `pack_code` and `battery_info`.

        Raises `RequestError` while that is under way.
        """
        self.pack_code = self.node.request_pack_code()
        self.battery_info = self.node.request_battery_info()

    def step(self, now: float) -> None:
        """Drive on, within what the battery gives."""
        passed, self._last_step = now - self._last_step, now
        heard = self.node.state(B2V_ST1) in (State.ALIVE, State.LATE)
        if self.mode is Mode.REPORTING and self._reports >= _REPORTS and heard:
            self.mode = Mode.ON
        if self.mode is Mode.ON and self._voltage > 0:
            self._drive(now, passed)
        else:
            self.motion.brake(passed)
            self.load = 0.0
        if self._switching_off and self.motion.speed == 0:
            self._off()
        if self.line:
            self.line.load = self.load

    def _drive(self, now: float, passed: float) -> None:
        wanted = self._trip.wanted(now) if self._trip else None
        if wanted is None:
            self._trip = None
        power = self.motion.drive(passed, wanted or 0.0, self._limit())
        self.load = power / self._voltage

    def _off(self, trouble: str = "") -> None:
        """Command high voltage off now, and draw nothing any more."""
        self.trouble = self.trouble or trouble
        self.mode = Mode.OFF
        self._switching_off = False
        self._trip = None
        self.load = 0.0

    @property
    def _voltage(self) -> float:
        """On the line, in V; 0 where there is no high voltage."""
        last = self.node.last(B2V_ST3)
        on = bool(self.states) and self.states[-1] == BmsState.HV_CLOSED
        return _number(last, "upack_out") if on else 0.0

    def _limit(self) -> Power:
        """What the battery allows, by B2V_ST2."""
        last = self.node.last(B2V_ST2)
        part = _DERATED if self._level == FaultLevel.LEVEL_2_MORE_SEVERE_FAULT else 1.0
        return Power(
            part * self._voltage * _number(last, "max_lmt_dis_chg_curr"),
            part * self._voltage * _number(last, "max_lmt_chg_curr"),
        )

    def _see_status(self, received: Received[B2V_ST1]) -> None:
        status = received.message
        before = self.states[-1] if self.states else None
        if status.bms != before:
            self.states.append(status.bms)
        self._level = status.fault_levl
        if self.mode is Mode.ON and status.bms == BmsState.FAIL_TO_HV_ON:
            self._off("the BMU cannot switch on")
        elif self.mode is Mode.ON and before == BmsState.HV_CLOSED != status.bms:
            self._off("the BMU has switched off")
        elif self.mode is not Mode.OFF and self._level == FaultLevel.LEVEL3_MOST_SEVERE_FAULT:
            self._off("the BMU reports a fault of level 3")

    def _see_request(self, received: Received[B2V_RQ]) -> None:
        asked = received.message.hv_off == HvOffRequest.REQUEST_HV_OFF
        if asked and self.mode is not Mode.OFF:
            self._off("the BMU asks for high voltage off")

    def _watch(self, event: StateChanged) -> None:
        lost = event.message in (B2V_ST0, B2V_ST1) and event.new is State.LOST
        if lost and self.mode is not Mode.OFF:
            self._off("the BMU is lost")

    def _command(self) -> Iterator[V2B_CMD]:
        on = self.mode is Mode.ON
        closed = RelayState.OPEN if self.mode is Mode.OFF else RelayState.CLOSED
        self._reports += closed is RelayState.CLOSED
        # What stands for the relays in the pack stays invalid: the BMU has these itself.
        yield V2B_CMD(
            hv_on_off=HvCommand.HV_ON if on else HvCommand.HV_OFF,
            hv_acc_on_off=AccessoryHvCommand.HV_ACC_ON if on else AccessoryHvCommand.HV_ACC_OFF,
            vehicle_speed=self.motion.kmh,
            heat_on_off=HeatCommand.HEAT_OFF,
            att_relay_st=closed,
            main_motor_con_st=closed,
            main_motor_con_flt=ContactorFault.NORMAL,
            att_con_st1=closed,
            att_con_flt1=ContactorFault.NORMAL,
            att_con_st2=RelayState.OPEN,
            att_con_flt2=ContactorFault.NORMAL,
            att_con_st3=RelayState.OPEN,
            att_con_flt3=ContactorFault.NORMAL,
            att_con_st4=RelayState.OPEN,
            att_con_flt4=ContactorFault.NORMAL,
        )


def _number(received: Received[Message] | None, field: str) -> float:
    """A physical value of the last message of a kind; 0 where there is none."""
    value = getattr(received.message, field) if received else 0.0
    return 0.0 if isinstance(value, SignalState) else float(value)
