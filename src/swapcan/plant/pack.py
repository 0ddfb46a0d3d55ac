"""A simulated pack without its node: battery, relays, high voltage, charging, alarms."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

from swapcan.messages import BmsState, C2B_ACStatus, ThermalMode
from swapcan.plant.alarms import HIGHEST_LEVEL, OPENS, WELDS, Alarms, Faults
from swapcan.plant.battery import Battery
from swapcan.plant.bus_bar import BusBar
from swapcan.plant.charge_path import ChargePath
from swapcan.plant.charging import ChargeStatus, Charging
from swapcan.plant.high_voltage import Command, Demand, HighVoltage
from swapcan.plant.relays import Relay, Relays
from swapcan.plant.sensors import Measurement, Sensors
from swapcan.plant.thermal import next_mode
from swapcan.plant.traction import Traction

SAMPLING_TIME = 0.1
"""Seconds between two measurements."""

WELDED_RELAY = "welded_relay"
PRECHARGE_FAILURE = "precharge_failure"
STUCK_RELAY = "stuck_relay"

_BALANCE_FROM = 3.38  # V of the highest cell
_BALANCE_SPREAD = 0.01  # V between the highest and the lowest


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """What the other participants say and do.

    Parameters
    ----------
    command, accessory, heating
        Of the VCU.
    speed
        Of the truck, in km/h.
    load
        What the truck draws, in A, None where nobody knows.
    charger, charge
        What the charger said last, None where it is silent; what it gives, in A.
    plugged
        Whether its plug is in.
    may_charge
        Whether charging is wanted, if the truck stands.
    coolant
        The water's temperature in degC, None where none flows.
    cooling_failed
        Whether the cooling unit has a fault, or is lost.
    faults
        The names of the physical faults that the pack has.
    """

    command: Command = Command.NONE
    accessory: bool = False
    heating: bool = False
    speed: float = 0.0
    load: float | None = None
    charger: C2B_ACStatus | None = None
    charge: float = 0.0
    plugged: bool = False
    may_charge: bool = True
    coolant: float | None = None
    cooling_failed: bool = False
    faults: Collection[str] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class PackStatus:
    """All that the messages of one cycle are made of, so that they agree.

    Parameters
    ----------
    measured
        By the sensors.
    bus_bar
        Voltage behind the main relays, in V.
    closed
        The relays whose contacts are closed.
    state
        Of the high voltage.
    faults, charge, thermal
        Alarms, charging, and the mode asked of the cooling unit.
    balancing
        Whether cells are being balanced.
    charged_now
        kWh of this charge.
    """

    measured: Measurement
    bus_bar: float
    closed: frozenset[Relay]
    state: BmsState
    faults: Faults
    charge: ChargeStatus
    thermal: ThermalMode
    balancing: bool
    charged_now: float

    @property
    def is_closed(self) -> bool:
        """Whether there is high voltage."""
        return self.state is BmsState.HV_CLOSED


class Pack:
    """A pack whose time is handed in, in seconds.

    ``status`` is what the last measurement found; a new one is made every `SAMPLING_TIME`.

    Parameters
    ----------
    battery
        Its cells.
    now
        The time at which it begins.
    seed
        Of the cells and probes that faults hit.
    """

    def __init__(self, battery: Battery, now: float = 0.0, *, seed: int = 0) -> None:
        self.battery = battery
        self.relays = Relays()
        self.bus_bar = BusBar()
        self.high_voltage = HighVoltage(self.relays)
        self.charging = Charging(ChargePath(self.relays))
        self._sensors = Sensors(battery, seed=seed)
        self._alarms = Alarms()
        self._traction = Traction()
        self._thermal = ThermalMode.OFF
        self._physical_faults: Collection[str] = ()
        self._charged_before = battery.charged
        self._charge_flow = 0.0  # As since the last measurement
        self._now = self._began = self._measured_at = now
        self._samples = 0
        self._measured: Measurement = self._sensors.measure(now, 0.0)
        self._faults = Faults({})
        self.status = self._status()

    def step(self, now: float, around: Surroundings) -> None:
        """Go on to a time."""
        dt, self._now = now - self._now, now
        if around.faults != self._physical_faults:
            self._set_faults(around.faults)
        load, charge = self._currents(dt, around)
        self._charge_flow += (load - charge) * dt
        due = now >= self._began + (self._samples + 1) * SAMPLING_TIME - 1e-6
        if due:
            self._measure(now, around)
        self.bus_bar.advance(dt, self._measured.voltage, self.relays)
        self.high_voltage.step(now, self._demand(around, load))
        self.charging.step(
            now,
            around.charger,
            self._measured,
            plugged=around.plugged,
            allowed=around.may_charge and around.speed == 0,
            forbidden=self._faults.forbid_charging,
            current=charge,
        )
        if due:
            self._look(around)

    def _currents(self, dt: float, around: Surroundings) -> tuple[float, float]:
        """What flows through the main relays and from the charger, in A."""
        self._traction.advance(
            dt,
            around.speed,
            on=self.high_voltage.carries_load and around.command is not Command.OFF,
            capacity=self.battery.layout.capacity,
            limits=(self._measured.charge_limit, self._measured.discharge_limit),
        )
        closed = self.relays.closed
        if not {Relay.MAIN_POSITIVE, Relay.MAIN_NEGATIVE} <= closed:
            load = 0.0
        else:
            load = self._traction.current if around.load is None else around.load
        charges = {Relay.CHARGE_POSITIVE, Relay.CHARGE_NEGATIVE} <= closed
        return load, around.charge if charges else 0.0

    def _demand(self, around: Surroundings, load: float) -> Demand:
        return Demand(
            command=around.command,
            accessory=around.accessory,
            battery=self._measured.voltage,
            bus_bar=self.bus_bar.voltage,
            current=load,
            fault=self._faults.level >= HIGHEST_LEVEL,
        )

    def _set_faults(self, faults: Collection[str]) -> None:
        self._physical_faults = faults
        self.bus_bar.shorted = PRECHARGE_FAILURE in faults
        for fault, stuck in (
            (WELDED_RELAY, self.relays.stuck_closed),
            (STUCK_RELAY, self.relays.stuck_open),
        ):
            if fault in faults:
                stuck.add(Relay.MAIN_POSITIVE)
            else:
                stuck.discard(Relay.MAIN_POSITIVE)

    def _measure(self, now: float, around: Surroundings) -> None:
        """Let the battery catch up, and look at it."""
        passed = now - self._measured_at
        self._samples = math.floor((now - self._began) / SAMPLING_TIME + 1e-5)
        self._measured_at = now
        current = self._charge_flow / passed
        self._charge_flow = 0.0
        self.battery.advance(passed, current, around.coolant)
        self._sensors.advance(passed, around.faults)
        self._measured = self._sensors.measure(now, current)
        self._faults = Faults(self._levels(around))

    def _look(self, around: Surroundings) -> None:
        """Take a new status from the measurement and all else that there is now."""
        if (around.charger or around.plugged) and not self.status.charge.connected:
            self._charged_before = self.battery.charged
        self._thermal = next_mode(
            self._thermal,
            self._measured,
            busy=self.status.is_closed or self.charging.path.is_closed,
            heating_wished=around.heating,
        )
        self.battery.balancing = self._needs_balancing()
        self.status = self._status()

    def _needs_balancing(self) -> bool:
        highest, lowest = self._measured.highest_cell.value, self._measured.lowest_cell.value
        if not (isinstance(highest, float) and isinstance(lowest, float)):
            return False
        spread = highest - lowest
        return self.charging.path.is_closed and highest > _BALANCE_FROM and spread > _BALANCE_SPREAD

    def _levels(self, around: Surroundings) -> dict[str, int]:
        """All faults by field."""
        relays = self.relays
        levels = dict(self._alarms.update(self._measured))
        levels.update({WELDS[relay]: 3 for relay in relays.weld_faults if relay in WELDS})
        levels.update({OPENS[relay]: 2 for relay in relays.open_faults if relay in OPENS})
        if self.high_voltage.self_opened:
            levels["flt_pack_self_protect"] = 2
        if around.cooling_failed:
            levels["flt_tms_system"] = 1
        return levels

    def _status(self) -> PackStatus:
        return PackStatus(
            measured=self._measured,
            bus_bar=self.bus_bar.voltage,
            closed=self.relays.closed,
            state=self.high_voltage.state,
            faults=self._faults,
            charge=self.charging.status,
            thermal=self._thermal,
            balancing=self.battery.balancing,
            charged_now=self.battery.charged - self._charged_before,
        )
