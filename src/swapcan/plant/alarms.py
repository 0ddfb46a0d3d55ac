"""The alarms of a simulated pack: which faults table 12 has, from where on, and how grave."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from swapcan.messages import B2V_ST0, B2V_ST1
from swapcan.plant.relays import Relay
from swapcan.plant.sensors import Measurement
from swapcan.transfer import Reading
from typedcan.model.signal_state import SignalState

HIGHEST_LEVEL = 3

FAULT_NUMBERS: Mapping[str, int] = MappingProxyType(
    {
        field: number
        for number, field in enumerate(
            (
                field
                for message in (B2V_ST1, B2V_ST0)
                for field in message.FIELDS
                if field.startswith("flt_")
            ),
            1,
        )
    }
)
"""The rows of table 12 by field: what B2V_ST0_BatteryFault_No holds is up to the maker."""

_GBT_32960 = frozenset(
    f"flt_{name}"
    for name in (
        *("del_temp", "over_temp", "over_h_volt", "low_h_volt", "low_soc", "over_ucell"),
        *("low_ucell", "over_soc", "soc_jump", "sys_not_matched", "ucell_uniformity"),
        *("low_ins_res", "hvil", "over_chg"),
    )
)
"""The faults of table 12 that are among the alarm bits of GB/T 32960.3."""

_CURED_BY_CHARGING = frozenset(
    {"flt_low_soc", "flt_low_ucell", "flt_low_h_volt", "flt_over_dis_chg"}
)

WELDS: Mapping[Relay, str] = MappingProxyType(
    {
        Relay.MAIN_POSITIVE: "flt_main_pos_relay_weld",
        Relay.MAIN_NEGATIVE: "flt_main_neg_relay_weld",
        Relay.CHARGE_POSITIVE: "flt_chg_pos_relay1_weld",
        Relay.CHARGE_NEGATIVE: "flt_chg_neg_relay1_weld",
        Relay.ACCESSORY: "flt_acc_relay_weld",
    }
)
"""The fault of each relay that does not open."""

OPENS: Mapping[Relay, str] = MappingProxyType(
    {
        Relay.MAIN_POSITIVE: "flt_main_pos_relay_open",
        Relay.MAIN_NEGATIVE: "flt_main_neg_relay_open",
        Relay.CHARGE_POSITIVE: "flt_chg_pos_relay1_open",
        Relay.CHARGE_NEGATIVE: "flt_chg_neg_relay1_open",
    }
)
"""The fault of each relay that does not close."""


@dataclass(frozen=True, slots=True)
class Alarm:
    """A fault of table 12 that a measured value raises.

    Parameters
    ----------
    field
        Of B2V_ST1 or B2V_ST0.
    levels
        The values from which on it has level 1, 2 and 3, rising.
    slack
        By how much the value must fall below one of them for the level to go back.
    value
        Of a measurement; low alarms take the negative value.
    """

    field: str
    levels: tuple[float, ...]
    slack: float
    value: Callable[[Measurement], float]

    def level(self, value: float, before: int) -> int:
        """The level that a value has after another level."""
        if value < self.levels[0] - self.slack:
            return 0
        reached = sum(value >= limit for limit in self.levels)
        kept = sum(value >= limit - self.slack for limit in self.levels)
        return max(reached, min(kept, before))


@dataclass(frozen=True, slots=True)
class Faults:
    """The faults that are there: their levels by field; those that are normal are left out."""

    levels: Mapping[str, int]

    @property
    def level(self) -> int:
        """The highest."""
        return max(self.levels.values(), default=0)

    @property
    def number(self) -> int:
        """How many of them GB/T 32960.3 defines."""
        return len(_GBT_32960 & self.levels.keys())

    @property
    def code(self) -> int:
        """The row of table 12 of the gravest, 0 where there is none."""
        gravest = [field for field, level in self.levels.items() if level == self.level]
        return min((FAULT_NUMBERS[field] for field in gravest), default=0)

    @property
    def forbid_charging(self) -> bool:
        """Whether there is a fault of level 2 or more that charging would not cure."""
        not_in_the_way = _CURED_BY_CHARGING | frozenset(OPENS.values())
        return any(
            level >= 2 and field not in not_in_the_way for field, level in self.levels.items()
        )


class Alarms:
    """Watches measurements."""

    def __init__(self) -> None:
        self._levels: dict[str, int] = {}
        self._soc: float | None = None

    def update(self, measurement: Measurement) -> dict[str, int]:
        """The alarms that a measurement raises or keeps, by field."""
        levels = {
            alarm.field: alarm.level(alarm.value(measurement), self._levels.get(alarm.field, 0))
            for alarm in ALARMS
        }
        before = measurement.soc if self._soc is None else self._soc
        levels["flt_soc_jump"] = int(abs(measurement.soc - before) >= _SOC_JUMP)
        self._soc = measurement.soc
        self._levels = {field: level for field, level in levels.items() if level}
        return self._levels


_SOC_JUMP = 2.0  # percent from one measurement to the next


def _number(reading: Reading, otherwise: float = 0.0) -> float:
    return otherwise if isinstance(reading, SignalState) else reading


def _cells(measurement: Measurement) -> int:
    return sum(len(csc) for csc in measurement.cells)


def _cell_spread(measurement: Measurement) -> float:
    return _number(measurement.highest_cell.value) - _number(measurement.lowest_cell.value)


def _probe_spread(measurement: Measurement) -> float:
    return _number(measurement.highest_probe.value) - _number(measurement.lowest_probe.value)


def _ohms_per_volt(measurement: Measurement) -> float:
    lower = min(measurement.positive_insulation, measurement.negative_insulation)
    return 1000 * lower / max(measurement.voltage, 1.0)


ALARMS: tuple[Alarm, ...] = (
    Alarm("flt_del_temp", (12.0, 20.0), 2.0, _probe_spread),
    Alarm("flt_over_temp", (50.0, 55.0, 60.0), 2.0, lambda m: _number(m.highest_probe.value)),
    Alarm("flt_low_temp", (5.0, 15.0, 25.0), 2.0, lambda m: -_number(m.lowest_probe.value)),
    Alarm("flt_over_h_volt", (3.62, 3.66, 3.70), 0.02, lambda m: m.voltage / _cells(m)),
    Alarm("flt_low_h_volt", (-2.90, -2.75, -2.60), 0.05, lambda m: -m.voltage / _cells(m)),
    Alarm("flt_low_soc", (-15.0, -8.0, -3.0), 1.0, lambda m: -m.soc),
    Alarm("flt_over_soc", (100.5,), 0.5, lambda m: m.soc),
    Alarm("flt_over_ucell", (3.65, 3.70, 3.75), 0.02, lambda m: _number(m.highest_cell.value)),
    Alarm("flt_low_ucell", (-2.80, -2.65, -2.50), 0.05, lambda m: -_number(m.lowest_cell.value)),
    Alarm("flt_ucell_uniformity", (0.30, 0.60, 0.90), 0.05, _cell_spread),
    Alarm("flt_low_ins_res", (-1000.0, -500.0, -100.0), 50.0, lambda m: -_ohms_per_volt(m)),
    Alarm("flt_over_chg", (0.6, 0.8, 1.0), 0.05, lambda m: -m.current / m.capacity),
    Alarm("flt_over_dis_chg", (1.2, 1.5, 2.0), 0.05, lambda m: m.current / m.capacity),
    Alarm("flt_hw", (1, 1, 3), 0, lambda m: m.unmeasured),
)
"""Temperatures in degC, voltages in V (that of the pack for each cell), insulation in ohm/V,
currents as multiples of the capacity, and how many sensors do not measure."""
