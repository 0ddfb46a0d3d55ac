"""How the simulated nodes leave a bus: with a pack that reports it is off, and nothing charging."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from functools import partial

from swapcan.messages import (
    B2V_ST1,
    B2C_Charger,
    BmsState,
    C2B_ACStatus,
    ChargeControl,
    ChargerOperation,
)
from swapcan.nodes.simulation import Simulation
from typedcan.drive.departure import Departure
from typedcan.drive.noting_bus import NotingBus
from typedcan.simulate.faults import PlannedFault
from typedcan.spoken.codec import words_of
from typedcan.wire.codec import Codec
from typedcan.wire.errors import DecodeError, UnknownFrameError
from typedcan.wire.message import Message, MessageT


def departure(
    simulation: Simulation, buses: Sequence[NotingBus], faults: Iterable[PlannedFault] = ()
) -> Departure:
    """How simulated nodes leave the buses on which they live, and end faults that they have."""
    nodes = dict(simulation.participants)
    # It would command again what its state asks for; the others are told to ask for nothing more.
    pack = nodes.pop("BMU", None)
    return Departure(
        heal=[partial(simulation.heal, fault) for fault in faults],
        withdraw=[
            partial(_forget_charging, simulation, buses),
            *([simulation.vcu.withdraw] if simulation.vcu else []),
        ],
        live_on=list(nodes.values()),
        stand_still=[pack] if pack else [],
        are_off=partial(are_off, simulation.participants, buses, simulation.codec),
    )


def are_off(played: Collection[str], buses: Sequence[NotingBus], codec: Codec) -> bool:
    """Whether all that was commanded by the nodes that are played is off, by what others report.

    A charger that says nothing does not give anything.
    """
    status, wanted = _last(B2V_ST1, buses, codec), _last(B2C_Charger, buses, codec)
    charger = _last(C2B_ACStatus, buses, codec)
    if "BMU" in played:
        gives = charger is not None and charger.charger_start == ChargerOperation.ON
        return "CHG" in played or not gives
    is_open = status is not None and status.bms == BmsState.HV_OPEN
    stops = wanted is not None and wanted.charge_control != ChargeControl.START_TO_CHARGE
    return ("VCU" not in played or is_open) and ("CHG" not in played or stops)


def _forget_charging(simulation: Simulation, buses: Sequence[NotingBus]) -> None:
    """Take the charger off; that the pack said before that it does not charge is no proof then."""
    chg = simulation.chg
    # One that was taken off earlier, and said that it stopped, may be asleep by now (5.2.1.4).
    if chg and chg.connected:
        for bus in buses:
            bus.latest.pop(_number(B2C_Charger, simulation.codec), None)
        chg.disconnect()


def _last(kind: type[MessageT], buses: Sequence[NotingBus], codec: Codec) -> MessageT | None:
    """What others sent last of a message, since the last code that acts."""
    for bus in buses:
        frame = bus.latest.get(_number(kind, codec))
        try:
            message = codec.decode_frame(frame) if frame else None
        except (DecodeError, UnknownFrameError):
            continue
        if isinstance(message, kind):
            return message
    return None


def _number(kind: type[Message], codec: Codec) -> tuple[int, bool]:
    """The identifier of a message in what is spoken, and whether it has 29 bits."""
    spoken = words_of(codec).wanted(kind)
    return spoken.FRAME_ID, spoken.EXTENDED
