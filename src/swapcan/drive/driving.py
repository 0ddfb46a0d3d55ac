"""Lets simulated nodes live on a real bus: looks out for others first, and leaves it safe.

However that ends, by an exception of any part or by a signal, the safe codes of what acts are
sent first, without receiving or recording before. What no program can do is to send where its
process is killed (SIGKILL), the machine stops or the driver hangs: then what is commanded holds
until the timeout of who receives it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from enum import Enum
from functools import partial

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.drive.noting_bus import NotingBus
from swapcan.drive.watchdog import Watchdog
from swapcan.messages import (
    B2V_ST1,
    B2C_Charger,
    BmsState,
    C2B_ACStatus,
    ChargeControl,
    ChargerOperation,
)
from swapcan.simulate.faults import PlannedFault
from swapcan.simulate.participant import Participant
from swapcan.simulate.simulated_bus import SimulatedWire
from swapcan.simulate.simulation import Simulation
from swapcan.simulate.world import World
from swapcan.wire import Codec
from typedcan.model.errors import TypedcanError
from typedcan.wire.clock import Clock
from typedcan.wire.errors import DecodeError, UnknownFrameError
from typedcan.wire.message import MessageT

LOOK_OUT = 2.0
"""Seconds in which nobody else may send what is to be sent: twice the longest period."""

LEAVING = 5.0
"""Seconds at most in which others are told to switch off before nothing is sent any more."""

_LEAVING_AT_LEAST = 0.5
"""Ten commands to switch off, and five reports of the pack."""

_SLICE = 0.05
"""Seconds between two looks at whether to go on."""

_MOMENT = 1e-6
"""Seconds that are too few to let them pass."""

_TROUBLE = 1.0
"""Seconds for which a bus may refuse to work before driving is given up."""


class BusyBusError(TypedcanError):
    """Somebody else sends a message that is to be sent here; ``frame`` is that of theirs."""

    def __init__(self, frame: can.Message) -> None:
        self.frame = frame
        kind = next(each for each in PROTOCOL.messages if frame.arbitration_id == each.FRAME_ID)
        super().__init__(
            f"another {kind.SENDER} is on the bus: {kind.NAME} (0x{kind.FRAME_ID:08X}) comes from"
            " somebody else; nothing is sent beside it"
        )


class Left(Enum):
    """How those who act on commands were left."""

    SAFE = "the pack has reported that it is off"
    UNKNOWN = "the pack has not reported that it is off"
    UNTOUCHED = "nothing was sent"


class Driving:
    """Some nodes' life on buses that are lent.

    Parameters
    ----------
    buses
        On which they live.
    clock, wires
        As `World` has them.
    is_over
        Is asked again and again whether to end before the time.
    watch
        Is told how many seconds have passed, and of how many.

    ``interrupted`` is what ended the leaving, such as `KeyboardInterrupt`, if it was that.
    """

    def __init__(
        self,
        buses: Sequence[NotingBus],
        *,
        clock: Clock,
        wires: tuple[SimulatedWire, ...] = (),
        is_over: Callable[[], bool] = lambda: False,
        watch: Callable[[float, float], object] = lambda _passed, _all: None,
    ) -> None:
        self._buses = buses
        self._clock = clock
        self._wires = wires
        self._is_over = is_over
        self._watch = watch
        self._watchdog = Watchdog(buses, clock)
        self.interrupted: BaseException | None = None

    def look_out(self, seconds: float | None = None) -> None:
        """See that nobody else sends what is to be sent; raises `BusyBusError`, and as `live`."""
        self.live(self._hearing(), LOOK_OUT if seconds is None else seconds)

    def live(self, world: World, seconds: float) -> None:
        """Let time pass, unless it is to end, or cannot go on.

        Raises `BusyBusError`, what a bus has raised for a second, what a recorder has raised, and
        what the world raises.
        """
        with self._watchdog:
            while (left := seconds - world.elapsed) > _MOMENT and not self._is_over():
                world.run(min(left, _SLICE))
                if self._watchdog.has_barked:
                    raise TypedcanError("the program hung: what acts was ended, nothing goes on")
                self._watchdog.beat()
                self._watch(world.elapsed, seconds)
                for bus in self._buses:
                    self._check(bus)

    def leave(self, simulation: Simulation, faults: Iterable[PlannedFault] = ()) -> Left:
        """Send the safe codes, and go on until those who act report that they are off.

        Nothing cuts that short: neither an exception of any kind nor ``is_over``.
        """
        with self._watchdog:
            self._send_safe_codes(simulation, faults)
            self._try(lambda: _forget_and_stop(simulation, self._buses))
            # The BMU would command again what its state asks for; the others have been told.
            others = [each for name, each in simulation.participants.items() if name != "BMU"]
            # What is still planned is for the other world.
            world = World(*others, clock=self._clock, wires=self._wires)
            begin = self._clock.now()
            while (passed := self._clock.now() - begin) < LEAVING - _MOMENT:
                self._let_pass(world)
                self._watchdog.beat()
                if any(bus.acting for bus in self._buses):
                    self._send_safe_codes(simulation, ())
                elif simulation.bmu and passed < _LEAVING_AT_LEAST:
                    self._send_those_of(simulation.bmu)
                if passed + _SLICE >= _LEAVING_AT_LEAST and self._are_off(simulation):
                    return Left.SAFE
        return Left.UNKNOWN

    def _check(self, bus: NotingBus) -> None:
        if bus.intruder:
            raise BusyBusError(bus.intruder)
        if bus.failure:
            raise bus.failure
        if bus.trouble and self._clock.now() - bus.trouble[0] >= _TROUBLE:
            raise bus.trouble[1]

    def _hearing(self) -> World:
        """A world in which the buses are heard, and nobody lives."""
        world = World(clock=self._clock, wires=self._wires)

        def hear() -> None:
            for bus in self._buses:
                while bus.recv(0):
                    pass

        world.after_each_step(hear)
        return world

    def _send_safe_codes(self, simulation: Simulation, faults: Iterable[PlannedFault]) -> None:
        """By the nodes, whose counters go on, and where that fails on the bare buses."""
        for fault in faults:
            self._try(partial(simulation.heal, fault))
        for participant in simulation.participants.values():
            self._send_those_of(participant)
        for bus in self._buses:
            if bus.acting:
                self._try(bus.send_safe_codes)

    def _send_those_of(self, participant: Participant) -> None:
        for node in participant.nodes:
            self._try(node.send_safe_codes)

    def _let_pass(self, world: World) -> None:
        """Let a slice of time pass, whatever is wrong with those who live in it."""
        begin = self._clock.now()
        self._try(lambda: world.run(_SLICE))
        left = begin + _SLICE - self._clock.now()
        if left > _MOMENT:
            self._try(lambda: self._hearing().run(left))
            left = begin + _SLICE - self._clock.now()
        if left > _MOMENT:
            self._try(lambda: World(clock=self._clock, wires=self._wires).run(left))

    def _try(self, action: Callable[[], object]) -> None:
        try:
            action()
        except Exception:  # noqa: BLE001 - what is left to do does not depend on it
            pass
        except BaseException as error:  # noqa: BLE001 - is raised once all is off
            self.interrupted = self.interrupted or error

    def _are_off(self, simulation: Simulation) -> bool:
        """Whether those who were commanded say that they are off, and nothing acts any more."""
        if any(bus.acting for bus in self._buses):
            return False
        there = simulation.participants
        status, wanted = self._last(B2V_ST1), self._last(B2C_Charger)
        charger = self._last(C2B_ACStatus)
        if (
            "VCU" in there
            and "BMU" not in there
            and not (status and status.bms == BmsState.HV_OPEN)
        ):
            return False
        if (
            "CHG" in there
            and "BMU" not in there
            and not (wanted and wanted.charge_control != ChargeControl.START_TO_CHARGE)
        ):
            return False
        return not (
            "BMU" in there
            and "CHG" not in there
            and charger
            and charger.charger_start == ChargerOperation.ON
        )

    def _last(self, kind: type[MessageT]) -> MessageT | None:
        """What others sent last of a message, since the last code that acts."""
        for bus in self._buses:
            frame = bus.latest.get(kind.FRAME_ID)
            try:
                message = Codec().decode_frame(frame) if frame else None
            except (DecodeError, UnknownFrameError):
                continue
            if isinstance(message, kind):
                return message
        return None


def _forget_and_stop(simulation: Simulation, buses: Sequence[NotingBus]) -> None:
    """Let the nodes want nothing any more; what was said before counts no more as a proof."""
    vcu, chg = simulation.vcu, simulation.chg
    # One that was told to switch off earlier, and said that it did, may be asleep by now (5.2.1.4).
    if chg and chg.connected:
        for bus in buses:
            bus.latest.pop(B2C_Charger.FRAME_ID, None)
        chg.disconnect()
    if vcu:
        vcu.withdraw()
