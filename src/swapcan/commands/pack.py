"""The pack of the demo, as the others see it: its battery management unit, BMU."""

from __future__ import annotations

import math
from collections.abc import Iterator

from swapcan.bus import Link
from swapcan.commands.battery import Battery
from swapcan.commands.nodes import Maker, Node
from swapcan.message import Message
from swapcan.messages import (
    B2V_RQ,
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    B2V_ST3,
    B2V_ST4,
    B2V_ST5,
    B2V_ST6,
    BMS_TMS_0,
    V2B_CMD,
    V2B_VIN,
    AccessoryRelayState,
    B2C_Charger,
    B2V_BattInfo1,
    B2V_BattInfo2,
    B2V_ElecEnergy,
    B2V_SysCode1,
    B2V_SysCode2,
    B2V_SysCode3,
    B2V_SysCode4,
    B2V_Temp,
    B2V_Ucell,
    BattInfoRequest,
    BmsState,
    ChargeControl,
    HvCommand,
    HvOffRequest,
    HvRelayState,
    HvRequest,
    RelayState,
    SysCodeRequest,
    ThermalMode,
    V2B_RQData,
    VinRequest,
)

_CODE = (B2V_SysCode1, B2V_SysCode2, B2V_SysCode3, B2V_SysCode4)
_INFO = (B2V_BattInfo1, B2V_BattInfo2)
_RELAYS = {
    BmsState.HV_OPEN: (RelayState.OPEN, RelayState.OPEN, RelayState.OPEN),
    BmsState.PRECHARGE: (RelayState.OPEN, RelayState.CLOSED, RelayState.CLOSED),
    BmsState.HV_CLOSED: (RelayState.CLOSED, RelayState.CLOSED, RelayState.OPEN),
}
"""Main positive, main negative and precharge relay."""


class Pack(Node):
    """The BMU: on the vehicle's bus and on the charger's.

    Parameters
    ----------
    vehicle, charger
        Its links to the two buses.
    precharge
        Seconds that the precharge relay stays closed.
    """

    def __init__(self, vehicle: Link, charger: Link, *, precharge: float) -> None:
        self._charger = charger
        self._precharge = precharge
        self._battery = Battery()
        self._hv_on_since = math.inf
        self.vin = ""
        super().__init__(vehicle)
        self.start(*(kind for kind in self.makers() if kind not in _CODE + _INFO))

    def makers(self) -> dict[type[Message], Maker]:
        """What the BMU sends: to the VCU, the charger and the cooling unit."""
        return {
            B2V_RQ: self._requests,
            B2V_SysCode1: self._battery.code_1,
            B2V_SysCode2: self._battery.code_2,
            B2V_SysCode3: self._battery.code_3,
            B2V_SysCode4: self._battery.code_4,
            B2V_BattInfo1: self._battery.info_1,
            B2V_BattInfo2: self._battery.info_2,
            B2V_Ucell: self._battery.cell_voltages,
            B2V_Temp: self._battery.probe_temperatures,
            B2V_ST0: self._relays,
            B2V_ST1: self._status,
            B2V_ST2: self._battery.status_2,
            B2V_ST3: self._high_voltage,
            B2V_ST4: self._battery.status_4,
            B2V_ST5: self._battery.status_5,
            B2V_ST6: self._battery.status_6,
            B2V_ElecEnergy: self._battery.energy,
            B2C_Charger: self._charging,
            BMS_TMS_0: self._cooling,
        }

    @property
    def links(self) -> tuple[Link, ...]:
        """The vehicle's bus and the charger's."""
        return (self.link, self._charger)

    def link_for(self, kind: type[Message]) -> Link:
        """The charger's bus for what is meant for the charger."""
        return self._charger if kind is B2C_Charger else self.link

    @property
    def state(self) -> BmsState:
        """Of the high voltage."""
        if self.now < self._hv_on_since:
            return BmsState.HV_OPEN
        passed = self.now - self._hv_on_since
        return BmsState.PRECHARGE if passed < self._precharge else BmsState.HV_CLOSED

    def turn(self, now: float) -> None:
        """Let time pass in the battery too."""
        load = 60 + 8 * math.sin(2 * now) if self.state is BmsState.HV_CLOSED else 0.0
        self._battery.update(now, now - self.now, load)
        super().turn(now)

    def react(self, message: Message) -> None:
        """Obey the VCU, answer its requests, collect the VIN."""
        match message:
            case V2B_CMD(hv_on_off=HvCommand.HV_ON):
                self._hv_on_since = min(self._hv_on_since, self.now)
            case V2B_RQData():
                self._answer(
                    _CODE, wanted=message.rq_sys_code == SysCodeRequest.REQUEST_SYSCODE_DATA
                )
                self._answer(
                    _INFO, wanted=message.rq_batt_info == BattInfoRequest.REQUEST_BATTINFO_DATA
                )
            case V2B_VIN():
                fields = list(V2B_VIN.FIELDS)[1:]
                values = (getattr(message, field) for field in fields)
                self.vin += "".join(value for value in values if isinstance(value, str))
                if message.frame_no == 3:
                    self.start(B2V_RQ)

    def _answer(self, kinds: tuple[type[Message], ...], *, wanted: bool) -> None:
        if wanted:
            self.start(*kinds)
        else:
            self.stop(*kinds)

    def _requests(self) -> Iterator[B2V_RQ]:
        wanted = VinRequest.NO_REQUEST_VIN if self.vin else VinRequest.REQUEST_VIN
        yield B2V_RQ(vin=wanted, hv_off=HvOffRequest.NO_REQUEST_HV_OFF)

    def _relays(self) -> Iterator[B2V_ST0]:
        positive, negative, precharge = _RELAYS[self.state]
        yield B2V_ST0(
            rechrgeable_dev_no=1,
            rechrgeable_dev_num=1,
            st_main_pos=positive,
            st_main_neg=negative,
            st_prechg=precharge,
            st_chg_pos1=RelayState.OPEN,
            st_chg_neg1=RelayState.OPEN,
            st_chg_pos2=RelayState.OPEN,
            st_chg_neg2=RelayState.OPEN,
        )

    def _status(self) -> Iterator[B2V_ST1]:
        on = self.state is BmsState.HV_CLOSED
        relay = AccessoryRelayState.CLOSED if on else AccessoryRelayState.OPEN
        yield B2V_ST1(bms=self.state, acc_relay=relay)

    def _high_voltage(self) -> Iterator[B2V_ST3]:
        voltage = self._battery.voltage
        passed = max(0.0, self.now - self._hv_on_since)
        charging = voltage * (1 - math.exp(-5 * passed / self._precharge))
        yield B2V_ST3(
            pos_ins_res=5200,
            neg_ins_res=5150,
            upack_batt=voltage,
            upack_out=voltage if self.state is BmsState.HV_CLOSED else charging,
        )

    def _charging(self) -> Iterator[B2C_Charger]:
        yield B2C_Charger(
            voltage_set=86.4, current_set=0.0, charge_control=ChargeControl.NORMAL_STOP_TO_CHARGE
        )

    def _cooling(self) -> Iterator[BMS_TMS_0]:
        on = self.state is BmsState.HV_CLOSED
        yield BMS_TMS_0(
            reqst_set_tms_sts=ThermalMode.COOLING if on else ThermalMode.SELF_CIRCULATION,
            reqst_tms_hv_on=HvRequest.REQUEST_HV_ON if on else HvRequest.REQUEST_HV_OFF,
            hv_rly_sts=HvRelayState.CLOSED if on else HvRelayState.OPEN,
            volt=self._battery.voltage,
            set_temp=20.0,
        )
