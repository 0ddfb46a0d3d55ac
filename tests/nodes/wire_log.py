"""What somebody sees of a pack on the wire: states, relays and voltages in their order."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeVar

import can

from swapcan import Fault
from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    B2V_ST3,
    V2B_CMD,
    BmsState,
    ChargeState,
    HvCommand,
    RelayState,
)
from swapcan.wire import Receiver

T = TypeVar("T")

RELAYS = ("st_main_neg", "st_prechg", "st_main_pos", "st_chg_neg1", "st_chg_pos1")
"""Main negative, precharge, main positive, charge negative and positive, as B2V_ST0 has them."""


@dataclass
class WireLog:
    """Takes all frames of a bus; ``relays`` are those closed, whenever that changed."""

    states: list[BmsState | int] = field(default_factory=list)
    charge_states: list[ChargeState | int] = field(default_factory=list)
    commands: list[HvCommand | int] = field(default_factory=list)
    speeds: list[float] = field(default_factory=list)
    relays: list[frozenset[str]] = field(default_factory=list)
    voltages: list[tuple[float, float]] = field(default_factory=list)
    faults: list[Fault] = field(default_factory=list)
    frames: int = 0

    def __post_init__(self) -> None:
        self._receiver = Receiver()

    def take(self, frame: can.Message) -> None:
        """Note what a frame says."""
        self.frames += 1
        taken = self._receiver.take(frame)
        if isinstance(taken, Fault):
            self.faults.append(taken)
        elif taken:
            self.faults.extend(taken.faults)
            match taken.message:
                case B2V_ST0() as status:
                    closed = [name for name in RELAYS if getattr(status, name) == RelayState.CLOSED]
                    _add(self.relays, frozenset(closed))
                case B2V_ST1() as status:
                    _add(self.states, status.bms)
                    _add(self.charge_states, status.chg_st)
                case B2V_ST3(upack_batt=float(inside), upack_out=float(outside)):
                    self.voltages.append((inside, outside))
                case V2B_CMD(vehicle_speed=float(speed)) as command:
                    _add(self.commands, command.hv_on_off)
                    self.speeds.append(speed)
                case _:
                    pass

    def check_relays(self) -> None:
        """See that no relay closed or opened in the wrong order."""
        before = frozenset[str]()
        for now in self.relays:
            if {"st_prechg", "st_main_pos"} & now:
                assert "st_main_neg" in now, f"{set(now)} without main negative"
            if "st_main_pos" in now - before:
                assert "st_prechg" in before, f"main positive closes after {set(before)}"
            if "st_prechg" in now - before:
                assert "st_main_pos" not in before, "precharge closes after main positive"
            if "st_main_neg" in before - now:
                assert "st_main_pos" not in now, "main negative opens before main positive"
            if "st_chg_pos1" in now:
                assert "st_chg_neg1" in now, f"{set(now)} without charge negative"
            before = now


def _add(values: list[T], value: T) -> None:
    if not values or values[-1] != value:
        values.append(value)
