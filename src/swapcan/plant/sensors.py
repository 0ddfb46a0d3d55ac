"""What the sensors of a simulated pack measure, in the steps in which it is sent."""

from __future__ import annotations

import random
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from swapcan.plant.battery import Battery
from swapcan.plant.curves import (
    CHARGE_BY_SOC,
    CHARGE_BY_TEMPERATURE,
    DISCHARGE_BY_SOC,
    DISCHARGE_BY_TEMPERATURE,
    interpolate,
)
from swapcan.transfer import Reading
from typedcan.model.signal_state import SignalState

FULL_CELL = 3.6
"""V that charging brings no cell above."""

OVER_TEMPERATURE = "over_temperature"
OVER_VOLTAGE_CELL = "over_voltage_cell"
LOW_INSULATION = "low_insulation"
SENSOR_FAILURE = "sensor_failure"

_DISTURBED = {OVER_TEMPERATURE: 62.0, OVER_VOLTAGE_CELL: 3.8, LOW_INSULATION: 3.0}
"""degC, V and kohm that these faults lead to."""

_COMING = 1.0
"""Seconds that they take to come and to go."""

_CHARGE_RATE = 0.5  # C, highest charging current at all
_DISCHARGE_RATE = 1.0  # C


@dataclass(frozen=True, slots=True)
class Extreme:
    """The highest or lowest of some readings, and which one it is, counted from 1."""

    value: Reading
    csc: int | SignalState
    position: int


_NONE = Extreme(SignalState.INVALID, SignalState.INVALID, 0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Measurement:
    """All readings of one moment, which agree with each other.

    Parameters
    ----------
    at
        When, in seconds.
    cells, probes
        In V and degC, CSC by CSC; those that cannot be measured are INVALID.
    unmeasured
        How many these are.
    voltage, current
        In V and A; the current is the mean since the last measurement, discharging positive.
    soc, soh
        In percent.
    charge_limit, discharge_limit
        What the battery can stand, in A.
    positive_insulation, negative_insulation
        In kohm.
    charged, discharged
        In kWh.
    capacity
        Rated, in Ah.
    """

    at: float
    cells: tuple[tuple[Reading, ...], ...]
    highest_cell: Extreme
    lowest_cell: Extreme
    average_cell: Reading
    probes: tuple[tuple[Reading, ...], ...]
    highest_probe: Extreme
    lowest_probe: Extreme
    average_probe: Reading
    unmeasured: int
    voltage: float
    current: float
    soc: float
    soh: float
    charge_limit: float
    discharge_limit: float
    positive_insulation: float
    negative_insulation: float
    charged: float
    discharged: float
    capacity: float


class Sensors:
    """The sensors of a battery, and the faults that they see or have.

    Parameters
    ----------
    battery
        What they measure.
    seed
        Of the cells and probes that faults hit.
    """

    def __init__(self, battery: Battery, *, seed: int = 0) -> None:
        self.battery = battery
        layout = battery.layout
        chance = random.Random(seed)
        self._cell = chance.randrange(layout.cscs * layout.cells)
        self._probe = chance.randrange(layout.cscs * layout.probes)
        self._deaf_cell = chance.randrange(layout.cscs * layout.cells)
        self._share = dict.fromkeys(_DISTURBED, 0.0)
        self._failed = False

    def advance(self, dt: float, faults: Collection[str]) -> None:
        """Let faults come and go for so many seconds."""
        for fault, share in self._share.items():
            step = dt / _COMING if fault in faults else -dt / _COMING
            self._share[fault] = min(1.0, max(0.0, share + step))
        self._failed = SENSOR_FAILURE in faults

    def measure(self, at: float, current: float) -> Measurement:
        """Measure everything; ``current`` is the mean in A since this was done last."""
        battery = self.battery
        true_cells = battery.cells.copy()
        true_cells[self._cell] = self._disturb(OVER_VOLTAGE_CELL, true_cells[self._cell])
        cells: list[Reading] = [round(cell, 3) for cell in true_cells]
        voltage = sum(round(cell, 3) for cell in true_cells)
        if self._failed:
            cells[self._deaf_cell] = SignalState.INVALID
        felt = battery.probes
        felt[self._probe] = self._disturb(OVER_TEMPERATURE, felt[self._probe])
        probes: list[Reading] = [float(round(probe)) for probe in felt]
        layout = battery.layout
        soc = battery.soc
        return Measurement(
            at=at,
            cells=_grouped(cells, layout.cells),
            highest_cell=_extreme(cells, layout.cells, highest=True),
            lowest_cell=_extreme(cells, layout.cells, highest=False),
            average_cell=_average(cells, 3),
            probes=_grouped(probes, layout.probes),
            highest_probe=_extreme(probes, layout.probes, highest=True),
            lowest_probe=_extreme(probes, layout.probes, highest=False),
            average_probe=_average(probes, 0),
            unmeasured=cells.count(SignalState.INVALID),
            voltage=voltage,
            current=current,
            soc=100 * max(0.0, soc),
            soh=100 * battery.soh,
            charge_limit=self._charge_limit(soc, min(felt), max(felt)),
            discharge_limit=self._discharge_limit(soc, min(felt), max(felt)),
            positive_insulation=self._disturb(LOW_INSULATION, battery.positive_insulation),
            negative_insulation=battery.negative_insulation,
            charged=battery.charged,
            discharged=battery.discharged,
            capacity=layout.capacity,
        )

    def _disturb(self, fault: str, value: float) -> float:
        return value + (_DISTURBED[fault] - value) * self._share[fault]

    def _charge_limit(self, soc: float, coldest: float, warmest: float) -> float:
        rated = _CHARGE_RATE * self.battery.layout.capacity
        by_temperature = min(interpolate(CHARGE_BY_TEMPERATURE, t) for t in (coldest, warmest))
        allowed = rated * interpolate(CHARGE_BY_SOC, soc) * by_temperature
        return min(allowed, self.battery.headroom(FULL_CELL))

    def _discharge_limit(self, soc: float, coldest: float, warmest: float) -> float:
        rated = _DISCHARGE_RATE * self.battery.layout.capacity
        by_temperature = min(interpolate(DISCHARGE_BY_TEMPERATURE, t) for t in (coldest, warmest))
        return rated * interpolate(DISCHARGE_BY_SOC, soc) * by_temperature


def _grouped(readings: Sequence[Reading], size: int) -> tuple[tuple[Reading, ...], ...]:
    return tuple(tuple(readings[at : at + size]) for at in range(0, len(readings), size))


def _valid(readings: Sequence[Reading]) -> list[float]:
    return [reading for reading in readings if not isinstance(reading, SignalState)]


def _extreme(readings: Sequence[Reading], size: int, *, highest: bool) -> Extreme:
    values = _valid(readings)
    if not values:
        return _NONE
    value = max(values) if highest else min(values)
    csc, position = divmod(readings.index(value), size)
    return Extreme(value, csc + 1, position + 1)


def _average(readings: Sequence[Reading], digits: int) -> Reading:
    values = _valid(readings)
    return round(sum(values) / len(values), digits) if values else SignalState.INVALID
