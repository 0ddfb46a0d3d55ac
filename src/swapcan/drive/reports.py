"""What those who act on commands report of themselves: whether they are off."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from swapcan.drive.noting_bus import NotingBus
from swapcan.messages import (
    B2V_ST1,
    B2C_Charger,
    BmsState,
    C2B_ACStatus,
    ChargeControl,
    ChargerOperation,
)
from swapcan.simulate.simulation import Simulation
from swapcan.wire import Codec
from typedcan.wire.errors import DecodeError, UnknownFrameError
from typedcan.wire.message import MessageT


def are_off(played: Collection[str], buses: Sequence[NotingBus]) -> bool:
    """Whether all that was commanded by the nodes that are played is off, by what others report.

    A charger that says nothing does not give anything.
    """
    status, wanted = _last(B2V_ST1, buses), _last(B2C_Charger, buses)
    charger = _last(C2B_ACStatus, buses)
    if "BMU" in played:
        gives = charger is not None and charger.charger_start == ChargerOperation.ON
        return "CHG" in played or not gives
    is_open = status is not None and status.bms == BmsState.HV_OPEN
    stops = wanted is not None and wanted.charge_control != ChargeControl.START_TO_CHARGE
    return ("VCU" not in played or is_open) and ("CHG" not in played or stops)


def forget_charging(simulation: Simulation, buses: Sequence[NotingBus]) -> None:
    """Take the charger off; that the pack said before that it does not charge is no proof then."""
    chg = simulation.chg
    # One that was taken off earlier, and said that it stopped, may be asleep by now (5.2.1.4).
    if chg and chg.connected:
        for bus in buses:
            bus.latest.pop(B2C_Charger.FRAME_ID, None)
        chg.disconnect()


def _last(kind: type[MessageT], buses: Sequence[NotingBus]) -> MessageT | None:
    """What others sent last of a message, since the last code that acts."""
    for bus in buses:
        frame = bus.latest.get(kind.FRAME_ID)
        try:
            message = Codec().decode_frame(frame) if frame else None
        except (DecodeError, UnknownFrameError):
            continue
        if isinstance(message, kind):
            return message
    return None
