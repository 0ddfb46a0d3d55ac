"""A simulated pack at one moment, and the messages that tell of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    B2V_ST3,
    B2V_ST4,
    B2V_ST5,
    B2V_ST6,
    BMS_TMS_0,
    AccessoryRelayState,
    B2C_Charger,
    B2V_BattInfo1,
    B2V_BattInfo2,
    B2V_ElecEnergy,
    B2V_Temp,
    B2V_Ucell,
    BalancingState,
    BatteryType,
    BmsState,
    ChargeLine,
    ChargeMode,
    CoolingType,
    FaultLevel,
    HvRelayState,
    HvRequest,
    RelayState,
    ThermalMode,
)
from swapcan.simulate.alarms import Faults
from swapcan.simulate.battery import Layout
from swapcan.simulate.charging import ChargeStatus
from swapcan.simulate.relays import Relay
from swapcan.simulate.sensors import FULL_CELL, Measurement
from swapcan.simulate.thermal import NEUTRAL_TEMPERATURE, SET_TEMPERATURES
from swapcan.transfer import split_cell_voltages, split_probe_temperatures


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

    def st0(self) -> Iterator[B2V_ST0]:
        """Relays and their faults."""
        yield B2V_ST0(
            rechrgeable_dev_no=1,
            rechrgeable_dev_num=1,
            st_main_pos=self._relay(Relay.MAIN_POSITIVE),
            st_main_neg=self._relay(Relay.MAIN_NEGATIVE),
            st_prechg=self._relay(Relay.PRECHARGE),
            st_chg_pos1=self._relay(Relay.CHARGE_POSITIVE),
            st_chg_neg1=self._relay(Relay.CHARGE_NEGATIVE),
            st_chg_pos2=RelayState.OPEN,
            st_chg_neg2=RelayState.OPEN,
            battery_fault_no=self.faults.code,
            **self._flags(B2V_ST0),
        )

    def st1(self) -> Iterator[B2V_ST1]:
        """States and alarms."""
        accessory = Relay.ACCESSORY in self.closed
        connected = self.charge.connected
        yield B2V_ST1(
            bms=self.state,
            acc_relay=AccessoryRelayState.CLOSED if accessory else AccessoryRelayState.OPEN,
            balance=BalancingState.BALANCING if self.balancing else BalancingState.NO_BALANCING,
            chg_line=ChargeLine.CONNECTED if connected else ChargeLine.NOT_CONNECTED,
            chg_mode=ChargeMode.AC_CHARGING if connected else ChargeMode.RESERVED,
            chg_st=self.charge.state,
            fault_levl=FaultLevel(self.faults.level),
            gbt32960_flt_num=self.faults.number,
            **self._flags(B2V_ST1),
        )

    def st2(self) -> Iterator[B2V_ST2]:
        """State of charge and currents."""
        measured = self.measured
        yield B2V_ST2(
            soc=measured.soc,
            soh=measured.soh,
            current=measured.current,
            max_lmt_chg_curr=measured.charge_limit,
            max_lmt_dis_chg_curr=measured.discharge_limit,
        )

    def st3(self) -> Iterator[B2V_ST3]:
        """Insulation and voltages."""
        yield B2V_ST3(
            pos_ins_res=self.measured.positive_insulation,
            neg_ins_res=self.measured.negative_insulation,
            upack_batt=self.measured.voltage,
            upack_out=self.bus_bar,
        )

    def st4(self) -> Iterator[B2V_ST4]:
        """The warmest and the coldest probe."""
        highest, lowest = self.measured.highest_probe, self.measured.lowest_probe
        yield B2V_ST4(
            max_temp=highest.value,
            min_temp=lowest.value,
            avg_temp=self.measured.average_probe,
            max_temp_csc_no=highest.csc,
            max_temp_position=highest.position,
            min_temp_csc_no=lowest.csc,
            min_temp_position=lowest.position,
        )

    def st5(self) -> Iterator[B2V_ST5]:
        """The highest cell voltage, and the average."""
        highest = self.measured.highest_cell
        yield B2V_ST5(
            max_ucell=highest.value,
            max_ucell_csc_no=highest.csc,
            max_ucell_position=highest.position,
            avg_ucell=self.measured.average_cell,
        )

    def st6(self) -> Iterator[B2V_ST6]:
        """The lowest cell voltage."""
        lowest = self.measured.lowest_cell
        yield B2V_ST6(
            min_ucell=lowest.value,
            min_ucell_csc_no=lowest.csc,
            min_ucell_position=lowest.position,
        )

    def cell_voltages(self) -> tuple[B2V_Ucell, ...]:
        """All cells."""
        return split_cell_voltages(dict(enumerate(self.measured.cells, 1)))

    def probe_temperatures(self) -> tuple[B2V_Temp, ...]:
        """All probes."""
        return split_probe_temperatures(dict(enumerate(self.measured.probes, 1)))

    def energy(self) -> Iterator[B2V_ElecEnergy]:
        """Energy counters."""
        yield B2V_ElecEnergy(
            tot_chg_energy=self.measured.charged,
            tot_dischg_energy=self.measured.discharged,
            single_chg_energy=self.charged_now,
        )

    def charger(self) -> Iterator[B2C_Charger]:
        """What the charger is to do."""
        yield B2C_Charger(
            voltage_set=self.charge.voltage,
            current_set=self.charge.current,
            charge_control=self.charge.control,
        )

    def cooling_unit(self) -> Iterator[BMS_TMS_0]:
        """What the cooling unit is to do."""
        needs_power = self.thermal in SET_TEMPERATURES and self.is_closed
        yield BMS_TMS_0(
            reqst_set_tms_sts=self.thermal,
            reqst_tms_hv_on=HvRequest.REQUEST_HV_ON if needs_power else HvRequest.REQUEST_HV_OFF,
            chrg_sts=self.charge.state,
            hv_rly_sts=HvRelayState.CLOSED if self.is_closed else HvRelayState.OPEN,
            volt=self.measured.voltage,
            set_temp=SET_TEMPERATURES.get(self.thermal, NEUTRAL_TEMPERATURE),
        )

    def _relay(self, relay: Relay) -> RelayState:
        return RelayState.CLOSED if relay in self.closed else RelayState.OPEN

    def _flags(self, message: type[B2V_ST0] | type[B2V_ST1]) -> dict[str, Any]:
        """The faults that a message has a field for; one bit tells no level."""
        fields = message.FIELDS
        return {
            field: level if fields[field].length > 1 else 1
            for field, level in self.faults.levels.items()
            if field in fields
        }


def battery_info(layout: Layout) -> tuple[B2V_BattInfo1, B2V_BattInfo2]:
    """The basic data of a pack of lithium iron phosphate cells."""
    return (
        B2V_BattInfo1(
            rate_cap=layout.capacity,
            rate_h_volt=layout.rated_voltage,
            rate_power=layout.rated_energy,
            batt_type=BatteryType.LITHIUM_IRON_PHOSPHATE,
            cool_type=CoolingType.WATER_COOLING,
        ),
        B2V_BattInfo2(
            tot_csc_num=layout.cscs,
            tot_cell_num=layout.cscs * layout.cells,
            tot_temp_num=layout.cscs * layout.probes,
            platform_ucell=3.2,
            avai_min_ucell=2.5,
            avai_max_ucell=FULL_CELL,
        ),
    )
