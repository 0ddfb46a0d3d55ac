"""What a VCU says to a simulated pack, and how it reads what it hears."""

from __future__ import annotations

import itertools
from dataclasses import replace

from nodes.outside import Outside

from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    V2B_CMD,
    AccessoryHvCommand,
    BmsState,
    HvCommand,
    RelayState,
)
from swapcan.nodes.bmu import Bmu
from swapcan.nodes.world import World
from typedcan.model.signal_state import SignalState

Pack = tuple[Bmu, Outside, World]
"""The pack, what is around it, and their time."""

ON = V2B_CMD(
    hv_on_off=HvCommand.HV_ON, hv_acc_on_off=AccessoryHvCommand.HV_ACC_ON, vehicle_speed=0.0
)
OFF = replace(ON, hv_on_off=HvCommand.HV_OFF, hv_acc_on_off=AccessoryHvCommand.HV_ACC_OFF)


def number(value: float | SignalState) -> float:
    """A value that is one."""
    assert not isinstance(value, SignalState)
    return value


def states(vcu: Outside) -> list[BmsState | int]:
    """The states that the VCU was told, each once."""
    return [state for state, _ in itertools.groupby(each.bms for each in vcu.all(B2V_ST1))]


def relays(message: B2V_ST0) -> tuple[RelayState | int, ...]:
    """Main positive, main negative and precharge relay."""
    return message.st_main_pos, message.st_main_neg, message.st_prechg
