"""The truck of the demo and what else is there: VCU, swap controller, cooling unit, charger."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from swapcan.bus import Link
from swapcan.commands.nodes import Maker, Node
from swapcan.message import Message
from swapcan.messages import (
    B2V_RQ,
    B2V_ST1,
    BMS_TMS_0,
    BSU_BMS_0,
    TMS_BMS_0,
    V2B_CMD,
    V2B_VIN,
    AccessoryHvCommand,
    B2V_BattInfo1,
    B2V_BattInfo2,
    B2V_SysCode1,
    B2V_SysCode2,
    B2V_SysCode3,
    B2V_SysCode4,
    BattInfoRequest,
    BmsState,
    C2B_ACStatus,
    ChargerOperation,
    ConnectorState,
    ContactorFault,
    HeatCommand,
    HvCommand,
    HvRelayState,
    LockState,
    RelayState,
    SysCodeRequest,
    ThermalMode,
    V2B_RQData,
    VinRequest,
)

VIN = "LDEMTRCK0R0000025"
_WANTED = (
    *(B2V_SysCode1, B2V_SysCode2, B2V_SysCode3, B2V_SysCode4),
    *(B2V_BattInfo1, B2V_BattInfo2),
)


class Truck(Node):
    """The VCU.

    Parameters
    ----------
    link
        Its link to the vehicle's bus.
    hv_on_at
        When it commands high voltage on.
    content_at
        When it withdraws its requests for the pack's data, if they are answered.
    """

    def __init__(self, link: Link, *, hv_on_at: float, content_at: float) -> None:
        self._hv_on_at = hv_on_at
        self._content_at = content_at
        self._content = False
        self._answers: dict[type[Message], Message] = {}
        self.states: list[BmsState | int] = []
        super().__init__(link)
        self.start(V2B_CMD, V2B_RQData)

    def makers(self) -> dict[type[Message], Maker]:
        """What the VCU sends."""
        return {V2B_CMD: self._command, V2B_VIN: self._vin, V2B_RQData: self._requests}

    @property
    def pack_code(self) -> str:
        """The code of the pack, as far as it has come in."""
        messages = (self._answers[kind] for kind in _WANTED[:4] if kind in self._answers)
        values = (getattr(each, name) for each in messages for name in each.FIELDS)
        return "".join(value for value in values if isinstance(value, str))

    def react(self, message: Message) -> None:
        """Give the VIN when asked, and withdraw a request once it is answered."""
        match message:
            case B2V_RQ(vin=VinRequest.REQUEST_VIN):
                self.start(V2B_VIN)
            case B2V_ST1():
                if message.bms not in self.states:
                    self.states.append(message.bms)
            case _ if type(message) in _WANTED:
                self._answers[type(message)] = message
                all_there = len(self._answers) == len(_WANTED) and self.now >= self._content_at
                if all_there and not self._content:
                    self._content = True
                    self.start(V2B_RQData)

    def _requests(self) -> Iterator[V2B_RQData]:
        if self._content:
            yield V2B_RQData(
                rq_batt_info=BattInfoRequest.NOT_REQUEST_BATTINFO_DATA,
                rq_sys_code=SysCodeRequest.NOT_REQUEST_SYSCODE_DATA,
            )
        else:
            yield V2B_RQData(
                rq_batt_info=BattInfoRequest.REQUEST_BATTINFO_DATA,
                rq_sys_code=SysCodeRequest.REQUEST_SYSCODE_DATA,
            )

    def _vin(self) -> Iterator[V2B_VIN]:
        fields = list(V2B_VIN.FIELDS)[1:]
        for number in range(3):
            characters: dict[str, Any] = dict(
                zip(fields, VIN[7 * number : 7 * number + 7], strict=False)
            )
            yield V2B_VIN(frame_no=number + 1, **characters)

    def _command(self) -> Iterator[V2B_CMD]:
        on = self.now >= self._hv_on_at
        yield V2B_CMD(
            hv_on_off=HvCommand.HV_ON if on else HvCommand.HV_OFF,
            hv_acc_on_off=AccessoryHvCommand.HV_ACC_ON if on else AccessoryHvCommand.HV_ACC_OFF,
            vehicle_speed=0.0,
            heat_on_off=HeatCommand.HEAT_OFF,
            main_motor_con_st=RelayState.CLOSED if on else RelayState.OPEN,
            main_motor_con_flt=ContactorFault.NORMAL,
        )


class SwapController(Node):
    """The BSU: the pack is locked and its connector plugged."""

    def __init__(self, link: Link) -> None:
        super().__init__(link)
        self.start(BSU_BMS_0)

    def makers(self) -> dict[type[Message], Maker]:
        """What the BSU sends."""
        return {BSU_BMS_0: self._status}

    def _status(self) -> Iterator[BSU_BMS_0]:
        yield BSU_BMS_0(
            lock=LockState.LOCKED, connect_st=ConnectorState.CONNECTED, connector_temp=31.0
        )


class CoolingUnit(Node):
    """The TMS: does what the BMU asks for."""

    def __init__(self, link: Link) -> None:
        self._mode: ThermalMode | int = ThermalMode.OFF
        self._relay: HvRelayState | int = HvRelayState.OPEN
        super().__init__(link)
        self.start(TMS_BMS_0)

    def makers(self) -> dict[type[Message], Maker]:
        """What the TMS sends."""
        return {TMS_BMS_0: self._status}

    def react(self, message: Message) -> None:
        """Take over the mode, and the state of the high voltage."""
        if isinstance(message, BMS_TMS_0):
            self._mode = message.reqst_set_tms_sts
            self._relay = message.hv_rly_sts

    def _status(self) -> Iterator[TMS_BMS_0]:
        cooling = self._mode == ThermalMode.COOLING
        yield TMS_BMS_0(
            work_sts=self._mode,
            hv_rly_sts=self._relay,
            output_water_temp=21.0 if cooling else 25.0,
            input_water_temp=26.0,
            reqst_cap=3 if cooling else 0,
        )


class Charger(Node):
    """The CHG, on its own bus: ready, and not charging."""

    def __init__(self, link: Link) -> None:
        super().__init__(link)
        self.start(C2B_ACStatus)

    def makers(self) -> dict[type[Message], Maker]:
        """What the charger sends."""
        return {C2B_ACStatus: self._status}

    def _status(self) -> Iterator[C2B_ACStatus]:
        off = ChargerOperation.OFF_IN_ORDER_TO_PREVENT_BATTERY_REVERSE_CONNECTION
        yield C2B_ACStatus(voltage_output=0.0, current_output=0.0, charger_start=off)
