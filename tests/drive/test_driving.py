"""Living on a bus and leaving it, whatever the bus, the nodes and what is handed in do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack

import can
import pytest
from drive.crane_rig import Rig
from node.rough_bus import nothing, raising
from simulate.crane import BEACON, LIFT, STOP, lift_frame

from typedcan.drive.departure import Departure
from typedcan.drive.driving import LEAVING, BusyBusError, Left
from typedcan.simulate.participant import Participant


class Rough(can.BusABC):
    """Stands for a bus; ``before`` may raise, and is told whether it is to send or to receive."""

    def __init__(self, bus: can.BusABC) -> None:
        self._bus = bus
        self.before: Callable[[str], object] = nothing
        self.timeouts: set[float | None] = set()
        super().__init__(channel="rough")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self.before("send")
        self._bus.send(msg, timeout)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self.timeouts.add(timeout)
        self.before("recv")
        return self._bus.recv(timeout), False


class RoughRig(Rig):
    """A rig whose driven bus does as a test says."""

    def __init__(self, stack: ExitStack) -> None:
        self.rough: Rough
        super().__init__(stack, self._around)

    def _around(self, bus: can.BusABC) -> can.BusABC:
        self.rough = Rough(bus)
        return self.rough

    def fail(self, what: str, begin: float, end: float) -> None:
        """Have the bus refuse from one second to another."""

        def before(does: str) -> None:
            if does == what and begin <= self.clock.now() < end:
                raise OSError("Network is down")

        self.rough.before = before


@pytest.fixture
def rig() -> Iterator[RoughRig]:
    with ExitStack() as stack:
        rig = RoughRig(stack)
        stack.callback(rig.rough.shutdown)
        yield rig


@pytest.mark.parametrize("what", ["send", "recv"])
def test_a_bus_that_refuses_for_less_than_a_second_is_driven_on(rig: RoughRig, what: str) -> None:
    rig.fail(what, 3.0, 3.93)
    rig.driving.live(rig.world, 5.0)
    assert rig.clock.now() == pytest.approx(5.0)
    assert rig.rough.timeouts == {0}  # nothing is waited for
    assert rig.lifts()[-1].timestamp > 4.8


@pytest.mark.parametrize("what", ["send", "recv"])
def test_a_bus_that_refuses_for_a_second_is_given_up(rig: RoughRig, what: str) -> None:
    rig.fail(what, 3.0, 60.0)
    with pytest.raises(OSError, match="Network is down"):
        rig.driving.live(rig.world, 50.0)
    assert rig.clock.now() == pytest.approx(4.0, abs=0.16)


def test_safe_codes_that_the_bus_does_not_take_at_first_are_sent_once_it_does(
    rig: RoughRig,
) -> None:
    rig.driving.live(rig.world, 1.0)
    rig.fail("send", 0.0, 2.5)
    rig.lifts()
    assert rig.driving.leave(rig.departure()) is Left.SAFE
    frames = rig.lifts()
    assert {frame.data[2] for frame in frames} == {STOP}
    assert frames[0].timestamp == pytest.approx(2.5, abs=0.06)
    assert rig.clock.now() < 2.8
    assert not rig.winch.moves


def test_who_lives_on_and_says_nothing_is_spoken_for(rig: RoughRig) -> None:
    rig.driving.live(rig.world, 1.0)
    rig.lifts()
    departure = rig.departure(withdraw=[lambda: rig.panel.node.clear(LIFT)])
    assert rig.driving.leave(departure) is Left.SAFE
    frames = rig.lifts()
    assert {frame.data[2] for frame in frames} == {STOP}
    assert 4 <= len(frames) <= 8
    assert frames[-1].timestamp - frames[0].timestamp > 0.3


def test_who_says_what_is_safe_is_not_talked_over(rig: RoughRig) -> None:
    rig.driving.live(rig.world, 1.0)
    rig.panel.wanted = STOP
    rig.panel.node.clear(LIFT)
    rig.panel.node.supply(LIFT, rig.panel.lifts, period=0.05)
    rig.lifts()
    assert rig.driving.leave(rig.departure()) is Left.SAFE
    assert 10 <= len(rig.lifts()) <= 13  # one at once, and as often as it is due


def test_nodes_that_fail_do_not_keep_time_from_passing(
    rig: RoughRig, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig.driving.live(rig.world, 1.0)
    monkeypatch.setattr(rig.panel, "step", raising(ZeroDivisionError))
    rig.lifts()
    assert rig.driving.leave(rig.departure()) is Left.UNKNOWN  # the winch is not turned either
    assert rig.clock.now() == pytest.approx(1.0 + LEAVING, abs=0.01)
    assert len(rig.lifts()) >= 5


def test_leaving_takes_half_a_second_where_all_goes_well_and_not_more(rig: RoughRig) -> None:
    rig.driving.live(rig.world, 1.0)
    assert rig.driving.leave(rig.departure()) is Left.SAFE
    assert rig.clock.now() == pytest.approx(1.5, abs=0.01)
    assert rig.driving.interrupted is None
    assert rig.driving.hangs is False


def test_leaving_without_a_proof_takes_all_the_time_there_is_and_not_more(rig: RoughRig) -> None:
    rig.driving.live(rig.world, 1.0)
    assert rig.driving.leave(Departure(live_on=[rig.panel])) is Left.UNKNOWN
    assert rig.clock.now() == pytest.approx(1.0 + LEAVING, abs=0.01)


def test_what_breaks_into_the_leaving_is_kept_and_the_first_of_it(rig: RoughRig) -> None:
    rig.driving.live(rig.world, 1.0)
    first = raising(KeyboardInterrupt, times=1)
    departure = rig.departure(withdraw=[first, raising(SystemExit, times=1)])
    assert rig.driving.leave(departure) is Left.SAFE
    assert isinstance(rig.driving.interrupted, KeyboardInterrupt)


def test_a_proof_that_cannot_be_asked_for_is_asked_for_again(rig: RoughRig) -> None:
    rig.driving.live(rig.world, 1.0)
    fails = raising(ZeroDivisionError, times=2)

    def is_off() -> bool:
        fails()
        return rig.is_off()

    assert rig.driving.leave(rig.departure(are_off=is_off)) is Left.SAFE
    assert isinstance(rig.driving.interrupted, ZeroDivisionError)
    assert not rig.winch.moves


def test_one_who_sends_the_same_is_found_behind_many_others(rig: RoughRig) -> None:
    for number in range(200):
        rig.other.send(can.Message(arbitration_id=0x300 + number))
    rig.other.send(lift_frame(STOP))
    with pytest.raises(BusyBusError):
        rig.driving.look_out()
    assert rig.clock.now() < 0.06


def test_the_identifier_of_who_sends_the_same_has_its_width() -> None:
    assert "Beacon (0x00000101) comes from somebody else" in str(BusyBusError(BEACON))


def test_driving_tells_how_far_it_is(rig: RoughRig) -> None:
    told: list[tuple[float, float]] = []
    rig.driving._watch = lambda passed, of: told.append((passed, of))
    rig.driving.live(rig.world, 0.12)
    assert [of for _, of in told] == [0.12] * 3
    assert [passed for passed, _ in told] == pytest.approx([0.05, 0.1, 0.12])


def test_driving_ends_when_it_is_over_and_when_the_time_is(rig: RoughRig) -> None:
    rig.driving._is_over = lambda: rig.clock.now() > 0.29
    rig.driving.live(rig.world, 5.0)
    assert rig.clock.now() == pytest.approx(0.3)


def test_a_participant_without_a_node_is_left_too(rig: RoughRig) -> None:
    class Weight(Participant):
        name = "WEIGHT"

        def step(self, now: float) -> None:
            pass

    rig.driving.live(rig.world, 1.0)
    departure = rig.departure(live_on=[Weight(), rig.panel, rig.winch])
    assert rig.driving.leave(departure) is Left.SAFE
