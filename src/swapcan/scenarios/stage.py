"""Plays scenarios on a bus, and leaves a pack without high voltage however it ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial

import can

from swapcan.nodes.departure import departure
from swapcan.nodes.simulation import Simulation
from swapcan.scenarios.scenario import Scenario, ScenarioError
from swapcan.wire import codec_for
from typedcan.drive.driving import LEAVING, LOOK_OUT, BusyBusError, Driving, Left
from typedcan.drive.noting_bus import NotingBus, OtherEditionError
from typedcan.model.checksums.registry import Given
from typedcan.node.clock import Clock, SystemClock
from typedcan.node.errors import StillActingError
from typedcan.simulate.echoes import Echoes
from typedcan.simulate.faults import TRANSMISSION_FAULTS, PlannedFault
from typedcan.simulate.shared_bus import SharedBus
from typedcan.simulate.simulated_bus import SimulatedWire
from typedcan.wire.codec import Codec

__all__ = ["LEAVING", "LOOK_OUT", "Left", "Stage"]

Note = Callable[[can.Message], object]
"""Takes a frame that was received or sent."""


class Stage:
    """Where scenarios are played, one after the other.

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
    warn
        Is told, in a thread of its own, that the program hangs and the pack was told to switch off.
    algorithms
        What computes the checksums that the standard leaves open, as `swapcan.Codec` has it.
    codec
        What the pack speaks, in place of those: see `swapcan.codec_for`.

    ``left`` is how the scenario that was played last has left the pack; ``watch`` may be another
    one for the next.
    """

    def __init__(
        self,
        bus: can.BusABC,
        *,
        clock: Clock | None = None,
        wires: tuple[SimulatedWire, ...] = (),
        is_over: Callable[[], bool] = lambda: False,
        watch: Callable[[float, float], object] = lambda _passed, _all: None,
        warn: Callable[[], object] = lambda: None,
        algorithms: Given | None = None,
        codec: Codec | None = None,
    ) -> None:
        self._bus = bus
        self._clock = clock or SystemClock()
        self._wires = wires
        self._is_over = is_over
        self.watch = watch
        self._warn = warn
        self._algorithms = algorithms
        self._codec = codec or codec_for(algorithms=algorithms)
        self._echoes = Echoes()
        self._driven: NotingBus | None = None
        self._driving: Driving | None = None
        self.left = Left.UNTOUCHED

    def play(self, scenario: Scenario, nodes: Sequence[str], note: Note) -> None:
        """Look out for others, play a scenario, and switch off.

        Switching off is not cut short: neither by an error of any part nor by `is_over`.

        Parameters
        ----------
        nodes
            Which are played, as `Scenario.played` gives them.
        note
            Is told of every frame, in the order of their times.

        Raises
        ------
        ScenarioError
            Somebody else sends what is to be played, or the pack speaks another edition.
        HungError
            The program stood still while something acted.
        BaseException
            What a bus has raised for a second, and what ``note``, ``watch`` and ``is_over`` raise.
        """
        self.left = Left.UNTOUCHED
        played = [kind for node in nodes for kind in self._codec.protocol.sent_by(node)]
        with NotingBus(
            self._bus, self._codec, note, clock=self._clock, played=played, echoes=self._echoes
        ) as bus:
            self._driven = bus
            self._driving = driving = Driving(
                [bus],
                clock=self._clock,
                wires=self._wires,
                is_over=self._is_over,
                watch=self.watch,
                warn=self._warn,
            )
            try:
                self._play(driving, scenario, nodes, bus)
            except (BusyBusError, OtherEditionError) as error:
                raise ScenarioError(str(error)) from None
        if driving.interrupted:
            raise driving.interrupted
        if bus.failure:
            raise bus.failure

    @property
    def hangs(self) -> bool:
        """Whether nothing has gone on for too long."""
        return self._driving is not None and self._driving.hangs

    def send_safe_codes(self) -> None:
        """End what acts, for good; any thread may, in the middle of anything."""
        if self._driven:
            self._driven.send_safe_codes()

    def _play(
        self, driving: Driving, scenario: Scenario, nodes: Sequence[str], bus: NotingBus
    ) -> None:
        driving.look_out()
        if self._is_over():
            return
        simulation = self._simulation(scenario, nodes, bus)
        try:
            leave = partial(driving.leave, departure(simulation, [bus], scenario.faults))
            self.left = Left.UNKNOWN
            try:
                driving.live(simulation.world, scenario.seconds)
            finally:
                self.left = leave()
        finally:
            with suppress(StillActingError):  # ``left`` says so
                simulation.close()

    def _simulation(self, scenario: Scenario, nodes: Sequence[str], bus: NotingBus) -> Simulation:
        """The played nodes, with what the scenario plans."""
        simulation = Simulation(
            nodes,
            SharedBus(bus).share,
            plan=scenario.steps(nodes),
            clock=self._clock,
            wires=self._wires,
            algorithms=self._algorithms,
            codec=self._codec,
        )
        for fault in scenario.faults:
            simulation.world.at(fault.start, partial(_inject, simulation, fault))
            simulation.world.at(fault.end, partial(simulation.heal, fault))
        return simulation


def _inject(simulation: Simulation, fault: PlannedFault) -> None:
    """Let those have a fault that it is for; one of the transmission hits every frame."""
    if fault.name not in TRANSMISSION_FAULTS:
        simulation.inject(fault)
        return
    for node in fault.nodes:
        for bus in simulation.buses.get(node, ()):
            bus.inject(fault.name, *fault.messages, every=1)
