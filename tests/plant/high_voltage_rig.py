"""High-voltage sequence, relays and bus bar beside a battery of one voltage, in steps of 10 ms."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from swapcan.messages import BmsState
from swapcan.plant.bus_bar import BusBar
from swapcan.plant.charge_path import ChargePath
from swapcan.plant.high_voltage import Command, Demand, HighVoltage
from swapcan.plant.relays import Relay, RelayChange, Relays

VOLTAGE = 80.0


@dataclass(slots=True)
class Seen:
    """A change of a contact, and what else was the case.

    ``closed`` are the contacts that are closed with it, ``bus_bar`` is the voltage when the relay
    was commanded, 20 ms before.
    """

    change: RelayChange
    closed: frozenset[Relay]
    bus_bar: float


@dataclass(slots=True)
class Rig:
    """All of it; ``demand`` holds from the next step on."""

    relays: Relays = field(default_factory=Relays)
    bus_bar: BusBar = field(default_factory=BusBar)
    now: float = 0.0
    demand: Demand = field(
        default_factory=lambda: Demand(command=Command.NONE, battery=VOLTAGE, bus_bar=0.0)
    )
    charge: bool = False
    seen: list[Seen] = field(default_factory=list)
    states: list[BmsState] = field(default_factory=list)
    machine: HighVoltage = field(init=False)
    path: ChargePath = field(init=False)
    voltages: list[float] = field(default_factory=lambda: [0.0, 0.0])
    steps: int = 0

    def __post_init__(self) -> None:
        self.machine = HighVoltage(self.relays)
        self.path = ChargePath(self.relays)
        self.relays.on_change = self._see

    def _see(self, change: RelayChange) -> None:
        self.seen.append(Seen(change, self.relays.closed, self.voltages[-3]))

    def run(self, seconds: float) -> None:
        """Let time pass."""
        for _ in range(round(seconds * 100)):
            self.steps += 1
            self.now = self.steps / 100
            self.bus_bar.advance(0.01, VOLTAGE, self.relays)
            self.voltages.append(self.bus_bar.voltage)
            self.machine.step(self.now, replace(self.demand, bus_bar=self.bus_bar.voltage))
            self.path.step(self.now, wanted=self.charge, matched=True, current=0.0)
            if not self.states or self.states[-1] is not self.machine.state:
                self.states.append(self.machine.state)

    def command(self, command: Command, seconds: float = 0.0) -> None:
        """Command something, and let time pass."""
        self.demand = replace(self.demand, command=command)
        self.run(seconds)

    def set(self, *, fault: bool | None = None, current: float | None = None) -> None:
        """Change what else the sequence depends on."""
        if fault is not None:
            self.demand = replace(self.demand, fault=fault)
        if current is not None:
            self.demand = replace(self.demand, current=current)

    def state(self) -> BmsState:
        """What the VCU is told."""
        return self.machine.state

    def first_closed(self, relay: Relay) -> float:
        """When a relay closed first."""
        return next(s.change.at for s in self.seen if s.change.relay is relay and s.change.closed)

    @property
    def order(self) -> list[str]:
        """The changes in words."""
        return [
            f"{seen.change.relay} {'closes' if seen.change.closed else 'opens'}"
            for seen in self.seen
        ]
