"""Simulated nodes by name, together on their buses, with a plan and faults."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from contextlib import suppress
from types import TracebackType
from typing import Self, TypedDict

import can

from swapcan._generated.protocol import PROTOCOL
from swapcan.nodes.bmu import Bmu
from swapcan.nodes.bsu import Bsu
from swapcan.nodes.chg import Chg
from swapcan.nodes.faults import FaultyBus
from swapcan.nodes.plan import PlannedStep
from swapcan.nodes.tms import Tms
from swapcan.nodes.vcu import VIN, Vcu
from swapcan.nodes.world import World
from swapcan.plant.battery import Battery
from swapcan.wire import codec_for
from typedcan.model.checksums.registry import Given
from typedcan.node.clock import Clock, SimulatedClock, SystemClock
from typedcan.node.errors import StillActingError
from typedcan.node.leaving import raise_or_note
from typedcan.simulate.faults import TRANSMISSION_FAULTS, PlannedFault
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.times import PlanError
from typedcan.spoken.codec import words_of
from typedcan.wire.codec import Codec
from typedcan.wire.message import Message

_MASK = 0x1FFF_FFFF
_NOBODYS = 0
"""An identifier that nobody uses: without a filter everything would be accepted."""

OpenBus = Callable[[], can.BusABC]
"""Opens a bus for one more node."""


class _Own(TypedDict):
    """What each node is handed."""

    clock: Clock
    codec: Codec


Action = Callable[[], object]
"""Something to do at a given time."""


class Simulation:
    """Some of the five nodes, each on a bus of its own that can have faults.

    ``with`` closes the buses in the end; `world` lets time pass.

    Parameters
    ----------
    nodes
        Their names in the standard, none twice.
    vehicle
        Opens a bus for one node on the vehicle's bus.
    charger
        The same for the charger's bus, where BMU and CHG talk; they use the vehicle's where none
        is given.
    plan, faults
        What the nodes are told to do, and which faults they have, and when.
    clock
        The system's where none is given.
    wires
        Of simulated buses, as `World` has them.
    seed
        What chance is drawn from.
    vin
        Of the truck.
    battery
        Of the pack, where it is not to be the usual.
    algorithms
        What computes the checksums that the standard leaves open, as `swapcan.Codec` has it.
    codec
        What all of them speak, in place of those: see `swapcan.codec_for`.

    Raises
    ------
    UnknownNodeError
        There is no such node.
    PlanError
        A node is named twice, or a step or a fault is for a node that is not there.
    AlgorithmError
        There is no algorithm of a name that is given, or what is given is none.
    """

    def __init__(
        self,
        nodes: Iterable[str],
        vehicle: OpenBus,
        charger: OpenBus | None = None,
        *,
        plan: Iterable[PlannedStep] = (),
        faults: Iterable[PlannedFault] = (),
        clock: Clock | None = None,
        wires: tuple[SimulatedWire, ...] = (),
        seed: int = 0,
        vin: str = VIN,
        battery: Battery | None = None,
        algorithms: Given | None = None,
        codec: Codec | None = None,
    ) -> None:
        names, plan, faults = tuple(nodes), tuple(plan), tuple(faults)
        check(names, plan, faults)
        self.clock = clock or SystemClock()
        self.wires = wires
        self.buses: dict[str, tuple[FaultyBus, ...]] = {}
        self._algorithms = algorithms
        self.codec = codec or codec_for(algorithms=algorithms)
        self._vehicle, self._charger = vehicle, charger or vehicle
        try:
            apart = charger is not None
            own: _Own = {"clock": self.clock, "codec": self.codec}
            self.bmu = self._bmu(own, seed, battery, apart=apart) if "BMU" in names else None
            self.vcu = Vcu(self._bus("VCU"), vin=vin, **own) if "VCU" in names else None
            self.chg = self._chg(own, plan) if "CHG" in names else None
            self.tms = Tms(self._bus("TMS"), **own) if "TMS" in names else None
            self.bsu = Bsu(self._bus("BSU"), **own) if "BSU" in names else None
            everybody = (self.bmu, self.vcu, self.chg, self.tms, self.bsu)
            self.participants = {each.name: each for each in everybody if each}
            self.world = World(*self.participants.values(), clock=self.clock, wires=wires)
            self.world.after_each_step(self._release_late_frames)
            for step in plan:
                self._schedule_step(step)
            for fault in faults:
                self._schedule_fault(fault)
        except BaseException:
            self.close()
            raise

    @classmethod
    def simulated(
        cls,
        nodes: Iterable[str] = PROTOCOL.nodes,
        *,
        plan: Iterable[PlannedStep] = (),
        faults: Iterable[PlannedFault] = (),
        seed: int = 0,
        battery: Battery | None = None,
        edition: str = "",
        readings: Iterable[str] = (),
    ) -> Self:
        """Nodes on simulated buses, one for the vehicle and one for the charger, and clock.

        They speak an edition and readings, as `swapcan.codec_for` has them; raises `ReadError`.
        """
        clock = SimulatedClock()
        vehicle, charger = SimulatedWire(clock, "vehicle"), SimulatedWire(clock, "charger")
        return cls(
            nodes,
            lambda: SimulatedBus(vehicle),
            lambda: SimulatedBus(charger),
            plan=plan,
            faults=faults,
            clock=clock,
            wires=(vehicle, charger),
            seed=seed,
            battery=battery,
            codec=codec_for(edition, readings),
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        try:
            self.close()
        except StillActingError as failure:
            raise_or_note("the simulation", failure, error)

    def close(self) -> None:
        """End what the nodes have commanded, unless that is simulated too, and close all buses.

        Raises `StillActingError` where a bus did not take the safe codes; all are closed then too.
        """
        try:
            live = None if self.wires or not hasattr(self, "world") else self.world.leave()
        finally:
            for buses in self.buses.values():
                for bus in buses:
                    bus.shutdown()
        if live:
            raise live

    def inject(self, fault: PlannedFault) -> None:
        """Let those have a fault from now on that it is for."""
        for name in fault.nodes:
            if fault.name in TRANSMISSION_FAULTS:
                for bus in self.buses.get(name, ()):
                    bus.inject(fault.name, *self._spoken(fault))
            elif name in self.participants:
                self.participants[name].inject(fault.name)

    def heal(self, fault: PlannedFault) -> None:
        """Let nobody have a fault any more that it is for."""
        for name in fault.nodes:
            if fault.name in TRANSMISSION_FAULTS:
                for bus in self.buses.get(name, ()):
                    bus.heal(fault.name, *self._spoken(fault))
            elif name in self.participants:
                self.participants[name].heal(fault.name)

    def _spoken(self, fault: PlannedFault) -> list[type[Message]]:
        """The messages of a fault, in the classes of what is spoken."""
        return [*map(words_of(self.codec).kind, fault.messages)]

    def _release_late_frames(self) -> None:
        for buses in self.buses.values():
            for bus in buses:
                with suppress(Exception):  # the next frame of a node tells what is wrong with it
                    bus.release()

    def _bus(self, node: str, *, charger: bool = False) -> FaultyBus:
        bus = FaultyBus(
            self._charger() if charger else self._vehicle(),
            clock=self.clock,
            protocol=self.codec.protocol,
            algorithms=self._algorithms,
        )
        # As in a controller, what is meant for others never gets to the software.
        heard = self.codec.protocol.received_by(node)
        accepted = [(kind.FRAME_ID, kind.EXTENDED) for kind in heard] or [(_NOBODYS, True)]
        bus.set_filters(
            [{"can_id": id_, "can_mask": _MASK, "extended": wide} for id_, wide in accepted]
        )
        self.buses[node] = (*self.buses.get(node, ()), bus)
        return bus

    def _bmu(self, own: _Own, seed: int, battery: Battery | None, *, apart: bool) -> Bmu:
        charger = self._bus("BMU", charger=True) if apart else None
        vehicle = self._bus("BMU")
        return Bmu(vehicle, charger=charger, seed=seed, battery=battery, **own)

    def _chg(self, own: _Own, plan: tuple[PlannedStep, ...]) -> Chg:
        later = any(step.name == "charge" for step in plan)
        return Chg(self._bus("CHG", charger=True), connected=not later, **own)

    def _schedule_fault(self, fault: PlannedFault) -> None:
        self.world.at(fault.start, lambda: self.inject(fault))
        if math.isfinite(fault.end):
            self.world.at(fault.end, lambda: self.heal(fault))

    def _schedule_step(self, step: PlannedStep) -> None:
        begin, end = self._actions(step)
        self.world.at(step.start, begin)
        if end and math.isfinite(step.end):
            self.world.at(step.end, end)

    def _actions(self, step: PlannedStep) -> tuple[Action, Action | None]:
        """What to do when a step begins, and when it ends."""
        if self.vcu:
            vcu = self.vcu
            by_name: dict[str, Action] = {
                "hv_on": vcu.hv_on,
                "drive": lambda: vcu.drive(step.duration),
                "stop": vcu.stop,
                "hv_off": vcu.hv_off,
                "ask": vcu.ask,
            }
            if step.name in by_name:
                return by_name[step.name], None
        if step.name == "charge" and self.chg:
            return self.chg.connect, self.chg.disconnect
        if step.name == "unlock" and self.bsu:
            return self.bsu.unlock, self.bsu.lock
        raise PlanError(f"{step}: {step.node} is not there")


def check(
    names: tuple[str, ...], plan: Iterable[PlannedStep], faults: Iterable[PlannedFault]
) -> None:
    """See that names, plan and faults fit together; raises as `Simulation`."""
    for name in names:
        PROTOCOL.sent_by(name)  # raises where there is no such node
        if names.count(name) > 1:
            raise PlanError(f"{name} is named twice")
    for step in plan:
        if step.node not in names:
            raise PlanError(f"{step}: it is for {step.node}, which is not simulated")
    for fault in faults:
        if not set(fault.nodes) & set(names):
            able = ", ".join(fault.nodes)
            raise PlanError(f"{fault}: it is for {able}, which is not simulated")
