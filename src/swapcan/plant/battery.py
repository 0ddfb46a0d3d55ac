"""The battery of a simulated pack: cells in series, their charge, voltages and temperatures."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Final

from swapcan.plant.curves import OPEN_CIRCUIT, RESISTANCE_BY_TEMPERATURE, Table

_SECONDS_PER_HOUR = 3600.0
_JOULES_PER_KWH = 3_600_000.0

_HEAT_CAPACITY = 19.0  # J/K of a cell for each Ah
_TO_COOLANT = 0.012  # W/K of a cell for each Ah, while water flows
_TO_SURROUNDINGS = 0.0008  # W/K of a cell for each Ah
_RESISTANCE = 0.084  # ohm of a cell of 1 Ah at 25 degC
_BALANCING_CURRENT = 0.1  # A that leaves a cell through its resistor

_open_circuit = Table(OPEN_CIRCUIT, 0.005)
_resistance = Table(RESISTANCE_BY_TEMPERATURE, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """How a pack is built.

    Parameters
    ----------
    cscs, cells, probes
        Number of CSCs, and of cells and temperature probes on each of them: 1 to 18, 1 to 60
        and 1 to 120, as many as the frames of the standard can number.
    capacity
        Rated, in Ah.

    Raises `ValueError` for what is out of range.
    """

    cscs: int = 2
    cells: int = 12
    probes: int = 6
    capacity: float = 280.0

    def __post_init__(self) -> None:
        for name, value, highest in (
            ("cscs", self.cscs, 18),
            ("cells", self.cells, 60),
            ("probes", self.probes, 120),
        ):
            if not 1 <= value <= highest:
                raise ValueError(f"{name}: expected 1 to {highest}, not {value}")
        if not 1.0 <= self.capacity < 65535.0:
            raise ValueError(f"capacity: expected 1 to 65534 Ah, not {self.capacity:g}")

    @property
    def rated_voltage(self) -> float:
        """In V."""
        return 3.2 * self.cscs * self.cells

    @property
    def rated_energy(self) -> float:
        """In kWh."""
        return self.rated_voltage * self.capacity / 1000


class Battery:
    """Cells in series, in which charge, heat and energy are counted.

    The cells differ a little: none holds less than the rated capacity, all are full at the same
    time, so that they part the more the emptier the battery is.

    Parameters
    ----------
    layout
        How it is built.
    soc
        State of charge at the beginning, 0 to 1.
    temperature
        Of all cells at the beginning and of the surroundings, in degC.
    seed
        Of the differences between cells.
    """

    soh: Final = 0.984
    """State of health, 0 to 1."""
    positive_insulation: float
    """Between the positive pole and ground, in kohm."""
    negative_insulation: float
    """Between the negative pole and ground, in kohm."""
    charged: float
    """Energy charged in all its life, in kWh."""
    discharged: float
    """Energy discharged in all its life, in kWh."""
    temperatures: list[float]
    """Of each cell, in degC."""
    cells: list[float]
    """The voltage of each cell, in V."""
    voltage: float
    """Of the whole, in V."""

    def __init__(
        self,
        layout: Layout | None = None,
        *,
        soc: float = 0.764,
        temperature: float = 25.0,
        seed: int = 0,
    ) -> None:
        self.layout = layout or Layout()
        self.ambient = temperature
        self.balancing = False
        chance = random.Random(seed)
        count = self.layout.cscs * self.layout.cells
        capacity = self.layout.capacity
        self._missing = (1.0 - soc) * capacity  # Ah to full, as counted
        self._full = [capacity * chance.uniform(1.000, 1.020) for _ in range(count)]
        self._charge = [full - self._missing for full in self._full]  # Ah, of each cell
        self._resistances = [  # ohm at 25 degC
            _RESISTANCE / capacity * chance.uniform(0.97, 1.03) for _ in range(count)
        ]
        self._probe_offsets = [
            chance.uniform(-0.6, 0.6) for _ in range(self.layout.cscs * self.layout.probes)
        ]
        self.positive_insulation = chance.uniform(4800.0, 5600.0)
        self.negative_insulation = chance.uniform(4800.0, 5600.0)
        self.charged = chance.uniform(18_000.0, 19_000.0)
        self.discharged = self.charged * 0.94
        self.temperatures = [temperature] * count
        self._open_circuit = [0.0] * count  # V
        self._ohms = self._resistances  # at the temperatures that there are
        self.cells = [0.0] * count
        self.voltage = 0.0
        self._settle(0.0)

    @property
    def soc(self) -> float:
        """State of charge as the charge that flowed tells it, 1 for full."""
        return 1.0 - self._missing / self.layout.capacity

    @property
    def probes(self) -> list[float]:
        """What the temperature probes feel, CSC by CSC, in degC."""
        layout = self.layout
        cells_of_probes = (
            csc * layout.cells + probe * layout.cells // layout.probes
            for csc in range(layout.cscs)
            for probe in range(layout.probes)
        )
        return [
            self.temperatures[cell] + offset
            for cell, offset in zip(cells_of_probes, self._probe_offsets, strict=True)
        ]

    def headroom(self, highest: float) -> float:
        """The charging current in A that brings the first cell to a voltage in V; 0 or more."""
        return max(
            0.0,
            min(
                (highest - rest) / ohms
                for rest, ohms in zip(self._open_circuit, self._ohms, strict=True)
            ),
        )

    def advance(self, dt: float, current: float, coolant: float | None = None) -> None:
        """Let a current flow for so many seconds.

        Parameters
        ----------
        dt
            In seconds; up to about one, over which the current counts as constant.
        current
            In A, discharging positive.
        coolant
            The temperature of the water in degC, None while none flows.
        """
        ampere_hours = current * dt / _SECONDS_PER_HOUR
        kilowatt_hours = abs(self.voltage * current) * dt / _JOULES_PER_KWH
        if current < 0:
            self.charged += kilowatt_hours
        else:
            self.discharged += kilowatt_hours
        self._missing += ampere_hours
        lowest = min(self.cells) + 0.005
        bleed = _BALANCING_CURRENT * dt / _SECONDS_PER_HOUR if self.balancing else 0.0
        self._charge = [
            charge - ampere_hours - (bleed if voltage > lowest else 0.0)
            for charge, voltage in zip(self._charge, self.cells, strict=True)
        ]
        self._warm(dt, current, coolant)
        self._settle(current)

    def _warm(self, dt: float, current: float, coolant: float | None) -> None:
        size = self.layout.capacity
        step = dt / (_HEAT_CAPACITY * size)
        to_air = _TO_SURROUNDINGS * size
        to_water = 0.0 if coolant is None else _TO_COOLANT * size
        pull = to_air * self.ambient + to_water * (coolant or 0.0)
        loss = to_air + to_water
        square = current * current
        self.temperatures = [
            warmth + step * (square * ohms + pull - loss * warmth)
            for warmth, ohms in zip(self.temperatures, self._ohms, strict=True)
        ]

    def _settle(self, current: float) -> None:
        """The voltages that go with charge, temperature and current."""
        self._open_circuit = [
            _open_circuit(charge / full)
            for charge, full in zip(self._charge, self._full, strict=True)
        ]
        self._ohms = [
            resistance * _resistance(warmth)
            for resistance, warmth in zip(self._resistances, self.temperatures, strict=True)
        ]
        self.cells = [
            max(0.0, rest - current * ohms)
            for rest, ohms in zip(self._open_circuit, self._ohms, strict=True)
        ]
        self.voltage = sum(self.cells)
