"""What holds for the high-voltage sequence whatever is commanded and whatever fails."""

from __future__ import annotations

import itertools

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule
from plant.high_voltage_rig import VOLTAGE, Rig

from swapcan.messages import BmsState
from swapcan.plant.high_voltage import Command
from swapcan.plant.relays import Relay

MAIN = {Relay.MAIN_POSITIVE, Relay.MAIN_NEGATIVE}


class AnyOperation(RuleBasedStateMachine):
    """Commands and faults in any order, with any pauses."""

    def __init__(self) -> None:
        super().__init__()
        self.rig = Rig()

    @rule(command=st.sampled_from(Command), seconds=st.sampled_from([0.01, 0.05, 0.3, 0.8, 2.0]))
    def command(self, command: Command, seconds: float) -> None:
        self.rig.command(command, seconds)

    @rule(command=st.sampled_from(Command), steps=st.integers(1, 120))
    def command_for_any_time(self, command: Command, steps: int) -> None:
        self.rig.command(command, steps / 100)

    @rule(charge=st.booleans(), steps=st.integers(0, 20))
    def charge(self, charge: bool, steps: int) -> None:  # noqa: FBT001
        self.rig.charge = charge
        self.rig.run(steps / 100)

    @rule(fault=st.booleans(), steps=st.integers(0, 20))
    def fault(self, fault: bool, steps: int) -> None:  # noqa: FBT001
        self.rig.set(fault=fault)
        self.rig.run(steps / 100)

    @rule(current=st.sampled_from([0.0, 250.0, -100.0]))
    def current(self, current: float) -> None:
        self.rig.set(current=current)

    @rule(shorted=st.booleans())
    def short(self, shorted: bool) -> None:  # noqa: FBT001
        self.rig.bus_bar.shorted = shorted

    @rule(relay=st.sampled_from([*MAIN, Relay.PRECHARGE]), stuck=st.booleans())
    def stick_open(self, relay: Relay, stuck: bool) -> None:  # noqa: FBT001
        (self.rig.relays.stuck_open.add if stuck else self.rig.relays.stuck_open.discard)(relay)

    @rule(stuck=st.booleans())
    def weld(self, stuck: bool) -> None:  # noqa: FBT001
        stuck_closed = self.rig.relays.stuck_closed
        (stuck_closed.add if stuck else stuck_closed.discard)(Relay.MAIN_POSITIVE)

    @rule()
    def switch_off(self) -> None:
        """Two seconds for the current, half of one for the weld, 20 ms for each relay."""
        self.rig.charge = False
        self.rig.command(Command.OFF, 5.0)
        closed = self.rig.relays.closed
        assert closed <= {Relay.MAIN_POSITIVE}
        assert not closed or self.rig.relays.stuck_closed
        assert self.rig.state() is BmsState.HV_OPEN

    @invariant()
    def main_positive_closes_only_upon_a_precharged_bus_bar(self) -> None:
        for seen in self.rig.seen:
            if seen.change.relay is Relay.MAIN_POSITIVE and seen.change.closed:
                assert {Relay.MAIN_NEGATIVE, Relay.PRECHARGE} <= seen.closed
                assert seen.bus_bar >= 0.95 * VOLTAGE

    @invariant()
    def no_two_relays_switch_within_20_ms(self) -> None:
        # A weld that breaks is no switching.
        times = [
            seen.change.at
            for seen in self.rig.seen
            if seen.change.closed or seen.change.relay is not Relay.MAIN_POSITIVE
        ]
        assert all(b - a >= 0.02 - 1e-6 for a, b in itertools.pairwise(times))

    @invariant()
    def closed_is_reported_only_with_both_main_relays_closed(self) -> None:
        if self.rig.state() is BmsState.HV_CLOSED:
            assert self.rig.relays.closed >= MAIN

    @invariant()
    def open_is_reported_only_without_a_connection(self) -> None:
        if self.rig.state() in (BmsState.HV_OPEN, BmsState.FAIL_TO_HV_ON):
            assert not self.rig.relays.closed >= MAIN


TestAnyOperation = AnyOperation.TestCase
TestAnyOperation.settings = settings(
    max_examples=60, stateful_step_count=30, deadline=None, derandomize=True
)
