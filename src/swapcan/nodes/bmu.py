"""The simulated pack, BMU: measures, switches, charges, answers, and asks for what it needs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import ClassVar

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_RQ,
    B2V_ST1,
    TMS_BMS_0,
    V2B_CMD,
    AccessoryHvCommand,
    B2C_Charger,
    BmsState,
    C2B_ACStatus,
    HeatCommand,
    HvCommand,
    HvOffRequest,
    ThermalMode,
    VinRequest,
    WarningLevel,
)
from swapcan.node import Node
from swapcan.nodes import status
from swapcan.nodes.sleep import Sleep
from swapcan.nodes.world import Participant
from swapcan.plant.alarms import HIGHEST_LEVEL
from swapcan.plant.battery import Battery
from swapcan.plant.high_voltage import Command
from swapcan.plant.pack import (
    PRECHARGE_FAILURE,
    STUCK_RELAY,
    WELDED_RELAY,
    Pack,
    PackStatus,
    Surroundings,
)
from swapcan.plant.sensors import (
    LOW_INSULATION,
    OVER_TEMPERATURE,
    OVER_VOLTAGE_CELL,
    SENSOR_FAILURE,
)
from swapcan.transfer import Vin
from swapcan.wire import codec_for
from typedcan.model.signal_state import SignalState
from typedcan.model.transfer import Pace
from typedcan.model.transfers.readings import ReadingsByGroup
from typedcan.node.clock import Clock, SystemClock
from typedcan.spoken.codec import words_of
from typedcan.supervise import State
from typedcan.transfer import split
from typedcan.wire.codec import Codec
from typedcan.wire.link import Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer

_STEP = 0.01  # s, the longest that relays are left alone
_MOST_STEPS = 1000  # after a standstill of the clock's user
_FRESH = 0.25  # s, five periods of V2B_CMD
_ASK_AGAIN = {True: 1.0, False: 5.0}  # s between two B2V_RQ, by whether high voltage is to go

_COMMANDS: Mapping[int, Command] = {HvCommand.HV_ON: Command.ON, HvCommand.HV_OFF: Command.OFF}


class Bmu(Participant):
    """The BMU with its pack.

    It obeys V2B_CMD that is fresh and whole, charges while a charger is ready and the truck
    stands, unless ``may_charge`` is False, and tells of one measurement in all messages of a
    cycle. ``vin`` is empty until the VCU has given it. With ``may_sleep`` it sleeps once it is off.

    Parameters
    ----------
    vehicle
        The vehicle's bus.
    clock
        The system's where none is given.
    charger
        The charger's bus; the vehicle's where none is given.
    seed
        Of what differs from pack to pack; not of a battery that is given.
    battery
        One that is not the usual.
    codec
        For checksum algorithms of one's own.
    """

    name = "BMU"
    faults: ClassVar[frozenset[str]] = frozenset(
        {
            LOW_INSULATION,
            OVER_TEMPERATURE,
            OVER_VOLTAGE_CELL,
            PRECHARGE_FAILURE,
            SENSOR_FAILURE,
            STUCK_RELAY,
            WELDED_RELAY,
        }
    )

    def __init__(
        self,
        vehicle: can.BusABC,
        *,
        clock: Clock | None = None,
        charger: can.BusABC | None = None,
        seed: int = 0,
        battery: Battery | None = None,
        codec: Codec | None = None,
    ) -> None:
        clock = clock or SystemClock()
        codec = codec or codec_for()
        on_charger_bus = words_of(codec).wanted(C2B_ACStatus)
        apart = {on_charger_bus} if charger else set[type[Message]]()
        expected = _expected(codec.protocol) - apart
        self.node = Node(PROTOCOL, self.name, vehicle, codec=codec, clock=clock, expect=expected)
        self.charger_node = self.node
        if charger:
            self.charger_node = Node(
                PROTOCOL, self.name, charger, codec=codec, clock=clock, expect=apart
            )
        super().__init__(*dict.fromkeys((self.node, self.charger_node)), codec=codec)
        self._now = clock.now()
        self.pack = Pack(battery or Battery(seed=seed), self._now, seed=seed)
        self.vin = ""
        self.may_charge = True
        self.may_sleep = False
        self._sleep = Sleep(self.nodes)
        self._command: V2B_CMD | None = None
        self._command_at = -math.inf
        self._asked: tuple[bool, bool] | None = None
        self._asked_at = -math.inf
        self._send_all()
        self.node.on(V2B_CMD, self._obey)
        self.node.on(Vin, self._learn)

    @property
    def state(self) -> PackStatus:
        """The pack as the messages of this cycle tell of it."""
        return self.pack.status

    @property
    def status(self) -> str:
        """What it is doing, in words."""
        now = self.state
        if self._sleep.is_asleep:
            return "asleep"
        text = B2V_ST1.FIELDS["bms"].text(now.state)
        if now.charge.connected:
            text += f", {B2V_ST1.FIELDS['chg_st'].text(now.charge.state)}"
        if now.faults.level:
            text += f", fault level {now.faults.level}"
        return text

    def step(self, now: float) -> None:
        """Go on to a time, in seconds of the clock."""
        began, passed = self._now, now - self._now
        count = min(math.ceil(passed / _STEP - 1e-6), _MOST_STEPS)
        around = self._surroundings(now)
        for number in range(1, count + 1):
            at = now if number == count else began + passed * number / count
            self.pack.step(at, around)
        self._now = max(now, began)
        if self.may_sleep:
            is_open = self.state.state == BmsState.HV_OPEN
            command = self._fresh_command(now)
            self._sleep.step(now, command, is_open=is_open, plugged=around.plugged)
        if not self._sleep.is_asleep:
            self._ask(now)

    def _send_all(self) -> None:
        """Hand over to the nodes what they send."""
        for kind, make in status.MAKERS.items():
            node = self.charger_node if kind is B2C_Charger else self.node
            self.supply(kind, partial(self._make, make), node=node)
        for transfer in self.protocol.transfers:
            if transfer.parts.transfer.kind == ReadingsByGroup.name:
                self._send_readings(transfer)
        self.tell(*status.battery_info(self.pack.battery.layout))
        self.tell(*status.pack_code(self.protocol, self.words))

    def _send_readings(self, transfer: Transfer) -> None:
        """Send all cells, or all probes, in the frames that what is spoken has for them."""
        kind, field = transfer.items[0]
        are_cells = kind.FIELDS[field].unit == "V"

        def make() -> tuple[Message, ...]:
            measured = self.state.measured
            groups = measured.cells if are_cells else measured.probes
            return split(transfer, dict(enumerate(groups, 1)))

        every = kind.PERIOD or 0.0
        # Where the spec says that a cycle takes longer than a period, one frame goes out in each.
        facts = transfer.parts.transfer
        one_a_period = facts.pace is Pace.ONE_A_PERIOD or (facts.period or 0) / 1000 > every
        self.supply(kind, make, period=every * len(make()) if one_a_period else None)

    def _make(self, make: Callable[[PackStatus], Iterable[Message]]) -> Iterable[Message]:
        return make(self.state)

    def _obey(self, received: Received[V2B_CMD]) -> None:
        """Take a command; one whose counter stands still is no fresh one."""
        stale = any(fault.counter in ("repeated", "invalid") for fault in received.faults)
        if not stale:
            self._command = received.message
            self._command_at = self.node.clock.now()

    def _learn(self, vin: Vin) -> None:
        self.vin = vin.text

    def _fresh_command(self, now: float) -> V2B_CMD | None:
        return self._command if now - self._command_at <= _FRESH else None

    def _surroundings(self, now: float) -> Surroundings:
        """What the others say and do."""
        command = self._fresh_command(now)
        charger = self._heard(self.charger_node, C2B_ACStatus)
        unit = self._heard(self.node, TMS_BMS_0)
        load = charge = plugged = None
        if self.line:
            load, charge, plugged = self.line.load, self.line.charge, self.line.plugged
        if plugged is False:
            charger = None  # what it said last no longer counts
        if charge is None:
            charge = _number(charger, "current_output")
        return Surroundings(
            command=_COMMANDS.get(command.hv_on_off, Command.NONE) if command else Command.NONE,
            accessory=bool(command and command.hv_acc_on_off == AccessoryHvCommand.HV_ACC_ON),
            heating=bool(command and command.heat_on_off == HeatCommand.HEAT_ON),
            speed=_number(command, "vehicle_speed"),
            load=load,
            charger=charger if isinstance(charger, C2B_ACStatus) else None,
            charge=charge,
            plugged=charger is not None if plugged is None else plugged,
            may_charge=self.may_charge,
            coolant=_coolant(unit),
            cooling_failed=self._cooling_failed(unit),
            faults=self.active_faults,
        )

    def _heard(self, node: Node, kind: type[Message]) -> Message | None:
        """The message of a kind that came last, unless it is lost."""
        if not self.words.has(kind):
            return None
        received = node.last(kind)
        alive = node.state(kind) in (State.ALIVE, State.LATE)
        return received.message if received and alive else None

    def _cooling_failed(self, unit: Message | None) -> bool:
        if isinstance(unit, TMS_BMS_0):
            return unit.fault_lv in (WarningLevel.LEVEL_2, WarningLevel.LEVEL_3)
        return self.words.has(TMS_BMS_0) and self.node.state(TMS_BMS_0) is State.LOST

    def _ask(self, now: float) -> None:
        """Ask for the VIN until it is known, for high voltage off while a fault is grave."""
        to_go = self.state.faults.level >= HIGHEST_LEVEL
        wants = (not self.vin, to_go)
        again = any(wants) and now - self._asked_at >= _ASK_AGAIN[to_go] - 1e-6
        if wants == self._asked and not again:
            return
        self._asked, self._asked_at = wants, now
        self.ask_for(
            B2V_RQ(
                vin=VinRequest.NO_REQUEST_VIN if self.vin else VinRequest.REQUEST_VIN,
                hv_off=HvOffRequest.REQUEST_HV_OFF if to_go else HvOffRequest.NO_REQUEST_HV_OFF,
            )
        )


def _expected(protocol: Protocol) -> set[type[Message]]:
    """What the BMU is to hear all the time."""
    return {
        message
        for message in protocol.received_by("BMU")
        if message.PERIOD is not None and message not in protocol.conditional
    }


def _number(message: Message | None, field: str) -> float:
    value = getattr(message, field) if message else 0.0
    return 0.0 if isinstance(value, SignalState) else float(value)


def _coolant(unit: Message | None) -> float | None:
    """The temperature of the water, None where it does not flow."""
    if not isinstance(unit, TMS_BMS_0) or unit.work_sts == ThermalMode.OFF:
        return None
    return _number(unit, "output_water_temp")
