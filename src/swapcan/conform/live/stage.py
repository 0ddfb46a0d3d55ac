"""Plays scenarios on a bus, and leaves a pack without high voltage however it ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import Enum
from functools import partial

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.clock import Clock, SystemClock
from swapcan.codec import Codec
from swapcan.conform.live.noting_bus import NotingBus
from swapcan.conform.live.scenario import Scenario, ScenarioError
from swapcan.errors import DecodeError, UnknownFrameError
from swapcan.message import Message
from swapcan.messages import B2V_ST1, B2C_Charger, BmsState, ChargeControl
from swapcan.simulate.faults import TRANSMISSION_FAULTS, PlannedFault
from swapcan.simulate.shared_bus import SharedBus
from swapcan.simulate.simulated_bus import SimulatedWire
from swapcan.simulate.simulation import Simulation
from swapcan.simulate.vcu import Mode, Vcu
from swapcan.simulate.world import World

LOOK_OUT = 2.0
"""Seconds in which nobody else may send what is to be played: four of the longest period."""

LEAVING = 5.0
"""Seconds at most in which a pack is told to switch off before nothing is sent any more."""

_LEAVING_AT_LEAST = 0.5
"""Ten commands to switch off, and five reports of the pack."""

_SLICE = 0.05
"""Seconds between two looks at whether to go on."""

_MOMENT = 1e-6
"""Seconds that are too few to let them pass."""

_TROUBLE = 1.0
"""Seconds for which a bus may refuse to work before a scenario is given up."""

Note = Callable[[can.Message], object]
"""Takes a frame that was received or sent."""


class Left(Enum):
    """How a pack was left."""

    SAFE = "the pack has reported that it is off"
    UNKNOWN = "the pack has not reported that it is off"
    UNTOUCHED = "nothing was sent"


class Stage:
    """Where scenarios are played.

    Parameters
    ----------
    bus
        Is lent. The pack is there, and nobody who sends what is played.
    clock
        The system's where none is given.
    wires
        Of simulated buses, as `World` has them.
    is_over
        Is asked again and again whether a scenario is to end before its time.
    watch
        Is told how many seconds have passed, and of how many.

    ``left`` is how the scenario that was played last has left the pack.
    """

    def __init__(
        self,
        bus: can.BusABC,
        *,
        clock: Clock | None = None,
        wires: tuple[SimulatedWire, ...] = (),
        is_over: Callable[[], bool] = lambda: False,
        watch: Callable[[float, float], object] = lambda _passed, _all: None,
    ) -> None:
        self._bus = bus
        self._clock = clock or SystemClock()
        self._wires = wires
        self._is_over = is_over
        self._watch = watch
        self.left = Left.UNTOUCHED

    def play(self, scenario: Scenario, nodes: Sequence[str], note: Note) -> None:
        """Look out for others, play a scenario, and switch off.

        Switching off is not cut short: neither by an error nor by `is_over`.

        Parameters
        ----------
        nodes
            Which are played, as `Scenario.played` gives them.
        note
            Is told of every frame, in the order of their times.

        Raises
        ------
        ScenarioError
            Somebody else sends what is to be played.
        can.CanError, OSError
            The bus does not work.
        SwapcanError
            What ``note`` raises.
        """
        self.left = Left.UNTOUCHED
        played = [kind.FRAME_ID for node in nodes for kind in PROTOCOL.sent_by(node)]
        with NotingBus(self._bus, note, clock=self._clock, played=played) as bus:
            self._look_out(bus)
            if not self._is_over():
                with self._simulation(scenario, nodes, bus) as simulation:
                    try:
                        self._pass(simulation.world, scenario.seconds, bus)
                    finally:
                        self.left = self._leave(simulation, scenario, bus)
        if bus.failure:
            raise bus.failure

    def _simulation(self, scenario: Scenario, nodes: Sequence[str], bus: NotingBus) -> Simulation:
        """The played nodes, with what the scenario plans."""
        simulation = Simulation(
            nodes,
            SharedBus(bus).share,
            plan=scenario.steps(nodes),
            clock=self._clock,
            wires=self._wires,
        )
        for fault in scenario.faults:
            simulation.world.at(fault.start, partial(_inject, simulation, fault))
            simulation.world.at(fault.end, partial(simulation.heal, fault))
        if simulation.vcu:
            simulation.world.after_each_step(_Forgetting(simulation.vcu, bus))
        return simulation

    def _look_out(self, bus: NotingBus) -> None:
        """See that nobody sends what is to be played."""
        world = World(clock=self._clock, wires=self._wires)

        def listen() -> None:
            while bus.recv(0):
                pass

        world.after_each_step(listen)
        self._pass(world, LOOK_OUT, bus)

    def _pass(self, world: World, seconds: float, bus: NotingBus) -> None:
        """Let time pass, unless it is to end, or cannot go on."""
        while (left := seconds - world.elapsed) > _MOMENT and not self._is_over():
            world.run(min(left, _SLICE))
            self._watch(world.elapsed, seconds)
            if bus.intruder:
                raise ScenarioError(_intrusion(bus.intruder))
            if bus.failure:
                raise bus.failure
            if bus.trouble and self._clock.now() - bus.trouble[0] >= _TROUBLE:
                raise bus.trouble[1]

    def _leave(self, simulation: Simulation, scenario: Scenario, bus: NotingBus) -> Left:
        """Command high voltage off and take the charger off until the pack says that it is so."""
        vcu, chg = simulation.vcu, simulation.chg
        # What the pack said before it was told to switch off is no proof; but one that was told
        # so earlier may be asleep by now (5.2.1.4).
        if chg and chg.connected:
            bus.latest.pop(B2C_Charger.FRAME_ID, None)
            chg.disconnect()
        if vcu and vcu.mode is not Mode.OFF:
            bus.latest.pop(B2V_ST1.FRAME_ID, None)
        if vcu:
            if vcu.pack_code:
                vcu.pack_code.cancel()
            if vcu.battery_info:
                vcu.battery_info.cancel()
            vcu.hv_off()
            vcu.step(self._clock.now())  # from here on it commands off, whatever is sent next
        for fault in scenario.faults:
            simulation.heal(fault)
        # What is still planned is for the other world.
        world = World(*simulation.participants.values(), clock=self._clock, wires=self._wires)
        while world.elapsed < LEAVING:
            world.run(_SLICE)
            if world.elapsed >= _LEAVING_AT_LEAST and _is_off(bus, vcu=bool(vcu), chg=bool(chg)):
                return Left.SAFE
        return Left.UNKNOWN


class _Forgetting:
    """Drops what the pack says while high voltage on is commanded: no proof of off later."""

    def __init__(self, vcu: Vcu, bus: NotingBus) -> None:
        self._vcu = vcu
        self._bus = bus
        self._commanded = False

    def __call__(self) -> None:
        """Look at what is commanded, after a step in which that may have changed."""
        commands = self._vcu.mode is not Mode.OFF
        if commands or self._commanded:
            self._bus.latest.pop(B2V_ST1.FRAME_ID, None)
        self._commanded = commands


def _inject(simulation: Simulation, fault: PlannedFault) -> None:
    """Let those have a fault that it is for; one of the transmission hits every frame."""
    if fault.name not in TRANSMISSION_FAULTS:
        simulation.inject(fault)
        return
    for node in fault.nodes:
        for bus in simulation.buses.get(node, ()):
            bus.inject(fault.name, *fault.messages, every=1)


def _is_off(bus: NotingBus, *, vcu: bool, chg: bool) -> bool:
    """Whether the pack says that it is off."""
    status, charger = _last(bus, B2V_ST1), _last(bus, B2C_Charger)
    if vcu and not (isinstance(status, B2V_ST1) and status.bms == BmsState.HV_OPEN):
        return False
    return not chg or (
        isinstance(charger, B2C_Charger) and charger.charge_control != ChargeControl.START_TO_CHARGE
    )


def _last(bus: NotingBus, kind: type[Message]) -> Message | None:
    frame = bus.latest.get(kind.FRAME_ID)
    try:
        return Codec().decode_frame(frame) if frame else None
    except (DecodeError, UnknownFrameError):
        return None


def _intrusion(frame: can.Message) -> str:
    names = {kind.FRAME_ID: kind for kind in PROTOCOL.messages}
    kind = names[frame.arbitration_id]
    return (
        f"another {kind.SENDER} is on the bus: {kind.NAME} (0x{kind.FRAME_ID:08X}) comes from"
        " somebody else; nothing is played beside it"
    )
