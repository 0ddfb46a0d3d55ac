"""Simulated nodes on opened buses: who may act, how long they live, and how the buses are left."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from contextlib import ExitStack, suppress

import can

from swapcan.commands.simulation_report import SimulationReport
from swapcan.nodes.departure import departure
from swapcan.nodes.plan import PlannedStep
from swapcan.nodes.simulation import Simulation
from typedcan.drive.departure import Departure
from typedcan.drive.driving import LEAVING, Driving, Left, look_out_time
from typedcan.drive.noting_bus import NotingBus
from typedcan.drive.watchdog import HUNG
from typedcan.node.clock import SystemClock
from typedcan.node.errors import LIVE, StillActingError
from typedcan.shell.algorithms import algorithms_of
from typedcan.shell.console import CommandError, note, warn
from typedcan.shell.process_signals import Interrupts
from typedcan.simulate.faults import PlannedFault
from typedcan.simulate.shared_bus import SharedBus
from typedcan.wire.acting import acting_fields
from typedcan.wire.codec import Codec
from typedcan.wire.protocol import Protocol


def allowed_nodes(
    protocol: Protocol,
    names: tuple[str, ...],
    plan: Sequence[PlannedStep],
    faults: Sequence[PlannedFault],
) -> tuple[str, ...]:
    """Those of some nodes that may live on a real bus without consent: none that acts.

    Says which are left out; raises `CommandError` where none is left, or the plan or a fault is
    for one that is not.
    """
    acting = _acting_nodes(protocol, names)
    rest = tuple(name for name in names if name not in acting)
    who = _who_acts(protocol, acting)
    without = "without --yes-drive-the-bus"
    if acting and not rest:
        raise CommandError(f"{who} would make others act: not simulated {without}")
    for step in plan:
        if step.node in acting:
            raise CommandError(f"{step}: it is for {step.node}, which is not simulated {without}")
    for fault in faults:
        if not set(fault.nodes) & set(rest):
            able = ", ".join(node for node in fault.nodes if node in acting)
            raise CommandError(f"{fault}: it is for {able}, which is not simulated {without}")
    if acting:
        note(f"{who} would make others act: left out {without}")
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
    codec
        What they speak.
    """

    def __init__(
        self,
        options: argparse.Namespace,
        names: tuple[str, ...],
        plan: Sequence[PlannedStep],
        buses: Sequence[can.BusABC],
        name: str,
        codec: Codec,
        *,
        virtual: bool,
    ) -> None:
        self._options = options
        self._names = names
        self._plan = plan
        self._name = name
        self._codec = codec
        self._lent = buses
        self._looks_out = bool(_acting_nodes(codec.protocol, names)) and not virtual
        self._buses: list[NotingBus] = []
        self.is_safe = True
        """Whether all that was commanded was ended, as far as is known."""

    def live(self, interrupts: Interrupts) -> None:
        """Look out for others where something acts, let them live, and leave the buses safe."""
        played = [kind for node in self._names for kind in self._codec.protocol.sent_by(node)]
        with ExitStack() as stack:
            self._buses = [
                stack.enter_context(
                    NotingBus(bus, self._codec, _ignore, played=played if self._looks_out else ())
                )
                for bus in self._lent
            ]
            driving = Driving(
                self._buses,
                clock=SystemClock(),
                is_over=lambda: interrupts.is_over,
                warn=lambda: warn(HUNG),
            )
            interrupts.at_once, interrupts.hangs = self._end_what_acts, lambda: driving.hangs
            if self._looks_out:
                seconds = look_out_time(played)
                note(f"looking for others who send what is to be sent, for {seconds:g} s")
                driving.look_out()
            if not interrupts.is_over:
                self._live(driving)
        if driving.interrupted:
            raise driving.interrupted

    def _live(self, driving: Driving) -> None:
        shared = [SharedBus(bus) for bus in self._buses]
        simulation = Simulation(
            self._names,
            shared[0].share,
            shared[1].share if len(shared) > 1 else None,
            plan=self._plan,
            faults=self._options.faults,
            seed=self._options.seed,
            algorithms=algorithms_of(self._options),
            codec=self._codec,
        )
        if simulation.bmu:
            simulation.bmu.may_sleep = self._options.sleep
        try:
            report = SimulationReport(simulation, as_json=self._options.json)
            note(f"simulating {', '.join(self._names)} on {self._name}, Ctrl-C ends")
            leaving = departure(simulation, self._buses, self._options.faults)
            try:
                driving.live(simulation.world, self._options.seconds)
            finally:
                lived = simulation.world.elapsed
                self._leave(driving, leaving)
                note(report.summary(lived, *shared))
        finally:
            with suppress(StillActingError):  # that has been said
                simulation.close()

    def _leave(self, driving: Driving, leaving: Departure) -> None:
        if not any(bus.has_acted for bus in self._buses):
            return
        left = driving.leave(leaving)
        still = [message.NAME for bus in self._buses for message in bus.acting]
        if still:
            problem = f"the safe codes of {', '.join(still)} could not be sent"
        elif left is Left.UNKNOWN:
            problem = f"nobody has reported within {LEAVING:g} s that it is off"
        else:
            return
        self.is_safe = False
        note(f"{problem}: {LIVE}")

    def _end_what_acts(self) -> None:
        for bus in self._buses:
            bus.send_safe_codes()


def _ignore(_: can.Message) -> None:
    """Note nothing."""


def _acting_nodes(protocol: Protocol, names: Iterable[str]) -> tuple[str, ...]:
    """Those of some nodes that send codes that act."""
    return tuple(name for name in names if _acting_messages(protocol, name))


def _who_acts(protocol: Protocol, names: Iterable[str]) -> str:
    """Some nodes with their messages that act, for people."""
    return " and ".join(f"{name} ({', '.join(_acting_messages(protocol, name))})" for name in names)


def _acting_messages(protocol: Protocol, node: str) -> tuple[str, ...]:
    return tuple(kind.NAME for kind in protocol.sent_by(node) if acting_fields(kind))
