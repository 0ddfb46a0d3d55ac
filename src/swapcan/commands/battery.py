"""The battery of the demo: a small one, whose values change a little with time and load."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from swapcan.messages import (
    B2V_ST2,
    B2V_ST4,
    B2V_ST5,
    B2V_ST6,
    B2V_BattInfo1,
    B2V_BattInfo2,
    B2V_ElecEnergy,
    B2V_SysCode1,
    B2V_SysCode2,
    B2V_SysCode3,
    B2V_SysCode4,
    B2V_Temp,
    B2V_Ucell,
    BatteryType,
    CoolingType,
    Manufacturer,
)

PACK_CODE = "0DEPE280012SWAPR1A000025"
"""The 24 characters of GB/T 34014."""

_CSCS = 2
_CELLS = 12
"""Of each CSC."""
_PROBES = 6
"""Of each CSC."""
_ENERGY = 21.5
"""kWh, rated."""


class Battery:
    """Cells and probes, and the messages that tell of them, each as the frames of one cycle."""

    def __init__(self) -> None:
        self.current = 0.0
        self._discharged = 0.0  # kWh
        self._cells = [0.0]
        self._probes = [0.0]
        self.update(0.0, 0.0, 0.0)

    def update(self, now: float, passed: float, current: float) -> None:
        """Go on by so many seconds, at a current in A; discharging is positive."""
        self.current = current
        self._discharged += self.voltage * current * passed / 3_600_000
        self._cells = [
            3.318 + 0.004 * math.sin(1.7 * cell) + 0.001 * math.sin(2 * now + cell) - current / 9000
            for cell in range(_CSCS * _CELLS)
        ]
        self._probes = [
            27 + 2 * math.sin(1.3 * probe) + now / 10 for probe in range(_CSCS * _PROBES)
        ]

    @property
    def voltage(self) -> float:
        """Of the pack, in V."""
        return sum(self._cells)

    def code_1(self) -> Iterator[B2V_SysCode1]:
        """Manufacturer, length, characters 1 to 6."""
        yield B2V_SysCode1(
            manufacturer=Manufacturer.CATL, sys_code_length=len(PACK_CODE), **_characters(1, 6)
        )

    def code_2(self) -> Iterator[B2V_SysCode2]:
        """Characters 7 to 13."""
        yield B2V_SysCode2(**_characters(7, 13))

    def code_3(self) -> Iterator[B2V_SysCode3]:
        """Characters 14 to 20."""
        yield B2V_SysCode3(**_characters(14, 20))

    def code_4(self) -> Iterator[B2V_SysCode4]:
        """The rest of the characters."""
        yield B2V_SysCode4(**_characters(21, len(PACK_CODE)))

    def info_1(self) -> Iterator[B2V_BattInfo1]:
        """Rated values."""
        yield B2V_BattInfo1(
            rate_cap=280.0,
            rate_h_volt=76.8,
            rate_power=_ENERGY,
            batt_type=BatteryType.LITHIUM_IRON_PHOSPHATE,
            cool_type=CoolingType.WATER_COOLING,
        )

    def info_2(self) -> Iterator[B2V_BattInfo2]:
        """How many CSCs, cells and probes."""
        yield B2V_BattInfo2(
            tot_csc_num=_CSCS,
            tot_cell_num=_CSCS * _CELLS,
            tot_temp_num=_CSCS * _PROBES,
            platform_ucell=3.2,
            avai_min_ucell=2.5,
            avai_max_ucell=3.6,
        )

    def cell_voltages(self) -> Iterator[B2V_Ucell]:
        """Three cells a frame."""
        for first in range(0, _CSCS * _CELLS, 3):
            csc, cell = divmod(first, _CELLS)
            one, two, three = self._cells[first : first + 3]
            yield B2V_Ucell(
                csc_no=csc + 1,
                frame_no=cell // 3 + 1,
                csc_no_ucell_n=one,
                csc_no_ucell_n1=two,
                csc_no_ucell_n2=three,
            )

    def probe_temperatures(self) -> Iterator[B2V_Temp]:
        """Six probes a frame."""
        for csc in range(_CSCS):
            one, two, three, four, five, six = self._probes[csc * _PROBES : (csc + 1) * _PROBES]
            yield B2V_Temp(
                csc_no=csc + 1,
                frame_no=1,
                csc_no_temp_n=one,
                csc_no_temp_n1=two,
                csc_no_temp_n2=three,
                csc_no_temp_n3=four,
                csc_no_temp_n4=five,
                csc_no_temp_n5=six,
            )

    def status_2(self) -> Iterator[B2V_ST2]:
        """State of charge and currents."""
        yield B2V_ST2(
            soc=76.4 - 100 * self._discharged / _ENERGY,
            soh=99.2,
            current=self.current,
            max_lmt_chg_curr=140.0,
            max_lmt_dis_chg_curr=280.0,
        )

    def status_4(self) -> Iterator[B2V_ST4]:
        """The warmest and the coldest probe."""
        high_csc, high = divmod(self._probes.index(max(self._probes)), _PROBES)
        low_csc, low = divmod(self._probes.index(min(self._probes)), _PROBES)
        yield B2V_ST4(
            max_temp=max(self._probes),
            min_temp=min(self._probes),
            avg_temp=sum(self._probes) / len(self._probes),
            max_temp_csc_no=high_csc + 1,
            max_temp_position=high + 1,
            min_temp_csc_no=low_csc + 1,
            min_temp_position=low + 1,
        )

    def status_5(self) -> Iterator[B2V_ST5]:
        """The highest cell voltage, and the average."""
        csc, cell = divmod(self._cells.index(max(self._cells)), _CELLS)
        yield B2V_ST5(
            max_ucell=max(self._cells),
            max_ucell_csc_no=csc + 1,
            max_ucell_position=cell + 1,
            avg_ucell=self.voltage / len(self._cells),
        )

    def status_6(self) -> Iterator[B2V_ST6]:
        """The lowest cell voltage."""
        csc, cell = divmod(self._cells.index(min(self._cells)), _CELLS)
        yield B2V_ST6(
            min_ucell=min(self._cells), min_ucell_csc_no=csc + 1, min_ucell_position=cell + 1
        )

    def energy(self) -> Iterator[B2V_ElecEnergy]:
        """Energy counters."""
        yield B2V_ElecEnergy(
            tot_chg_energy=18423.7,
            tot_dischg_energy=17260.2 + self._discharged,
            single_chg_energy=12.4,
        )


def _characters(first: int, last: int) -> dict[str, Any]:
    return {f"sys_code_b{number}": PACK_CODE[number - 1] for number in range(first, last + 1)}
