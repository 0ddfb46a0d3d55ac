"""The messages that tell of a simulated pack at one moment."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
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
    BalancingState,
    BatteryType,
    ChargeLine,
    ChargeMode,
    CoolingType,
    FaultLevel,
    HvRelayState,
    HvRequest,
    Manufacturer,
    RelayState,
)
from swapcan.plant.battery import Layout
from swapcan.plant.pack import PackStatus
from swapcan.plant.relays import Relay
from swapcan.plant.sensors import FULL_CELL
from swapcan.plant.thermal import NEUTRAL_TEMPERATURE, SET_TEMPERATURES
from swapcan.transfer import split_pack_code
from typedcan.spoken.words import Same
from typedcan.transfer import Text, split
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

PACK_CODE = "001PB280SWAPR1EA10000025"
"""The 24 characters of GB/T 34014 of the simulated pack."""


def st0(status: PackStatus) -> Iterator[B2V_ST0]:
    """Relays and their faults."""
    yield B2V_ST0(
        rechrgeable_dev_no=1,
        rechrgeable_dev_num=1,
        st_main_pos=_relay(status, Relay.MAIN_POSITIVE),
        st_main_neg=_relay(status, Relay.MAIN_NEGATIVE),
        st_prechg=_relay(status, Relay.PRECHARGE),
        st_chg_pos1=_relay(status, Relay.CHARGE_POSITIVE),
        st_chg_neg1=_relay(status, Relay.CHARGE_NEGATIVE),
        st_chg_pos2=RelayState.OPEN,
        st_chg_neg2=RelayState.OPEN,
        battery_fault_no=status.faults.code,
        **_flags(status, B2V_ST0),
    )


def st1(status: PackStatus) -> Iterator[B2V_ST1]:
    """States and alarms."""
    accessory = Relay.ACCESSORY in status.closed
    connected = status.charge.connected
    yield B2V_ST1(
        bms=status.state,
        acc_relay=AccessoryRelayState.CLOSED if accessory else AccessoryRelayState.OPEN,
        balance=BalancingState.BALANCING if status.balancing else BalancingState.NO_BALANCING,
        chg_line=ChargeLine.CONNECTED if connected else ChargeLine.NOT_CONNECTED,
        chg_mode=ChargeMode.AC_CHARGING if connected else ChargeMode.RESERVED,
        chg_st=status.charge.state,
        fault_levl=FaultLevel(status.faults.level),
        gbt32960_flt_num=status.faults.number,
        **_flags(status, B2V_ST1),
    )


def st2(status: PackStatus) -> Iterator[B2V_ST2]:
    """State of charge and currents."""
    measured = status.measured
    yield B2V_ST2(
        soc=measured.soc,
        soh=measured.soh,
        current=measured.current,
        max_lmt_chg_curr=measured.charge_limit,
        max_lmt_dis_chg_curr=measured.discharge_limit,
    )


def st3(status: PackStatus) -> Iterator[B2V_ST3]:
    """Insulation and voltages."""
    yield B2V_ST3(
        pos_ins_res=status.measured.positive_insulation,
        neg_ins_res=status.measured.negative_insulation,
        upack_batt=status.measured.voltage,
        upack_out=status.bus_bar,
    )


def st4(status: PackStatus) -> Iterator[B2V_ST4]:
    """The warmest and the coldest probe."""
    highest, lowest = status.measured.highest_probe, status.measured.lowest_probe
    yield B2V_ST4(
        max_temp=highest.value,
        min_temp=lowest.value,
        avg_temp=status.measured.average_probe,
        max_temp_csc_no=highest.csc,
        max_temp_position=highest.position,
        min_temp_csc_no=lowest.csc,
        min_temp_position=lowest.position,
    )


def st5(status: PackStatus) -> Iterator[B2V_ST5]:
    """The highest cell voltage, and the average."""
    highest = status.measured.highest_cell
    yield B2V_ST5(
        max_ucell=highest.value,
        max_ucell_csc_no=highest.csc,
        max_ucell_position=highest.position,
        avg_ucell=status.measured.average_cell,
    )


def st6(status: PackStatus) -> Iterator[B2V_ST6]:
    """The lowest cell voltage."""
    lowest = status.measured.lowest_cell
    yield B2V_ST6(
        min_ucell=lowest.value,
        min_ucell_csc_no=lowest.csc,
        min_ucell_position=lowest.position,
    )


def energy(status: PackStatus) -> Iterator[B2V_ElecEnergy]:
    """Energy counters."""
    yield B2V_ElecEnergy(
        tot_chg_energy=status.measured.charged,
        tot_dischg_energy=status.measured.discharged,
        single_chg_energy=status.charged_now,
    )


def charger(status: PackStatus) -> Iterator[B2C_Charger]:
    """What the charger is to do."""
    yield B2C_Charger(
        voltage_set=status.charge.voltage,
        current_set=status.charge.current,
        charge_control=status.charge.control,
    )


def cooling_unit(status: PackStatus) -> Iterator[BMS_TMS_0]:
    """What the cooling unit is to do."""
    needs_power = status.thermal in SET_TEMPERATURES and status.is_closed
    yield BMS_TMS_0(
        reqst_set_tms_sts=status.thermal,
        reqst_tms_hv_on=HvRequest.REQUEST_HV_ON if needs_power else HvRequest.REQUEST_HV_OFF,
        chrg_sts=status.charge.state,
        hv_rly_sts=HvRelayState.CLOSED if status.is_closed else HvRelayState.OPEN,
        volt=status.measured.voltage,
        set_temp=SET_TEMPERATURES.get(status.thermal, NEUTRAL_TEMPERATURE),
    )


def _relay(status: PackStatus, relay: Relay) -> RelayState:
    return RelayState.CLOSED if relay in status.closed else RelayState.OPEN


def _flags(status: PackStatus, message: type[B2V_ST0] | type[B2V_ST1]) -> dict[str, Any]:
    """The faults that a message has a field for; one bit tells no level."""
    fields = message.FIELDS
    return {
        field: level if fields[field].length > 1 else 1
        for field, level in status.faults.levels.items()
        if field in fields
    }


def pack_code(protocol: Protocol, words: Same) -> tuple[Message, ...]:
    """The code of the pack in what is spoken, and who made the battery."""
    transfer = protocol.transfer("pack_code")
    first: Any = words.gist(split_pack_code(PACK_CODE, Manufacturer.CATL)[0])
    return split(transfer, Text(transfer.name, PACK_CODE, {"manufacturer": first.manufacturer}))


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


MAKERS: Mapping[type[Message], Callable[[PackStatus], Iterable[Message]]] = {
    B2V_ST0: st0,
    B2V_ST1: st1,
    B2V_ST2: st2,
    B2V_ST3: st3,
    B2V_ST4: st4,
    B2V_ST5: st5,
    B2V_ST6: st6,
    B2V_ElecEnergy: energy,
    B2C_Charger: charger,
    BMS_TMS_0: cooling_unit,
}
"""What makes the messages of a moment, but for those that take several frames."""
