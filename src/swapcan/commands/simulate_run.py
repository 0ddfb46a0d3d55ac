"""Simulated nodes on opened buses: who may act, how long they live, and how the buses are left."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.commands.driving import acting_nodes, what_they_send
from swapcan.commands.simulation_report import SimulationReport
from swapcan.console import CommandError, note
from swapcan.drive.driving import LEAVING, LOOK_OUT, Driving, Left
from swapcan.drive.noting_bus import NotingBus
from swapcan.simulate.plan import PlannedStep
from swapcan.simulate.shared_bus import SharedBus
from swapcan.simulate.simulation import Simulation
from typedcan.shell.process_signals import Interrupts
from typedcan.wire.clock import SystemClock


def allowed_nodes(
    options: argparse.Namespace, names: tuple[str, ...], *, virtual: bool
) -> tuple[str, ...]:
    """Those of some nodes that may live on the buses; raises `CommandError` where none may.

    Those that send codes that act need consent, unless the buses are ``virtual``.
    """
    acting = acting_nodes(names)
    if not acting or virtual or options.yes_drive_the_bus:
        return names
    said = f"{' and '.join(acting)} would command what acts ({what_they_send(acting)})"
    rest = tuple(name for name in names if name not in acting)
    if not rest:
        raise CommandError(f"{said}: nothing is simulated without --yes-drive-the-bus")
    note(f"{said}: left out without --yes-drive-the-bus")
    return rest


class LivingNodes:
    """Nodes that live on buses until their time is over, or a signal or trouble ends it.

    Parameters
    ----------
    buses
        The vehicle's, and the charger's where it is another.
    virtual
        Nobody else is on them, and nothing can be moved.
    name
        What the vehicle's bus is called.
    """

    def __init__(
        self,
        options: argparse.Namespace,
        names: tuple[str, ...],
        plan: Sequence[PlannedStep],
        buses: Sequence[can.BusABC],
        name: str,
        *,
        virtual: bool,
    ) -> None:
        self._options = options
        self._names = names
        self._plan = plan
        self._name = name
        played = [kind.FRAME_ID for node in names for kind in PROTOCOL.sent_by(node)]
        self._looks_out = bool(acting_nodes(names)) and not virtual
        self._buses = [
            NotingBus(bus, _ignore, played=played if self._looks_out else ()) for bus in buses
        ]

    def live(self, interrupts: Interrupts) -> None:
        """Look out for others where something acts, let them live, and leave the buses safe."""
        interrupts.at_once = self._end_what_acts
        driving = Driving(self._buses, clock=SystemClock(), is_over=lambda: interrupts.is_over)
        if self._looks_out:
            note(f"looking for others who send what is to be sent, for {LOOK_OUT:g} s")
            driving.look_out()
        if not interrupts.is_over:
            self._live(driving)
        if driving.interrupted:
            raise driving.interrupted

    def _live(self, driving: Driving) -> None:
        shared = [SharedBus(bus) for bus in self._buses]
        with ExitStack() as stack:
            simulation = stack.enter_context(
                Simulation(
                    self._names,
                    shared[0].share,
                    shared[1].share if len(shared) > 1 else None,
                    plan=self._plan,
                    faults=self._options.faults,
                    seed=self._options.seed,
                )
            )
            report = SimulationReport(simulation, as_json=self._options.json)
            note(f"simulating {', '.join(self._names)} on {self._name}, Ctrl-C ends")
            try:
                driving.live(simulation.world, self._options.seconds)
            finally:
                self._leave(driving, simulation)
                note(report.summary(*shared))

    def _leave(self, driving: Driving, simulation: Simulation) -> None:
        if not any(bus.has_acted for bus in self._buses):
            return
        acting = [message.NAME for bus in self._buses for message in bus.acting]
        left = driving.leave(simulation)
        still = [message.NAME for bus in self._buses for message in bus.acting]
        if still or (left is Left.UNKNOWN and acting):
            problem = (
                f"the safe codes of {', '.join(still)} could not be sent"
                if still
                else f"nobody has reported within {LEAVING:g} s that it is off"
            )
            note(f"{problem}: TAKE IT FOR LIVE, switch it off by other means")

    def _end_what_acts(self) -> None:
        for bus in self._buses:
            bus.send_safe_codes()


def _ignore(_: can.Message) -> None:
    """Note nothing."""
