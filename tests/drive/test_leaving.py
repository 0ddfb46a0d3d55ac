"""However nodes and buses are when they are left: what acts is ended, and by frames that count."""

from __future__ import annotations

import itertools
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any

import can
import pytest
from drive.quick_pack import command_in
from drive.trouble import SCENARIO, Phase, Progress
from scenarios.lines import values
from scenarios.rig import Bench, SharedClock, bench

import swapcan.nodes.departure
import typedcan.drive
from swapcan.messages import (
    BMS_TMS_0,
    V2B_CMD,
    B2C_Charger,
    C2B_ACStatus,
    ChargeControl,
    ChargerOperation,
    HvCommand,
    HvRequest,
    ThermalMode,
)
from swapcan.nodes.chg import Chg
from swapcan.nodes.departure import departure
from swapcan.nodes.faults import planned_fault
from swapcan.nodes.plan import plan_of
from swapcan.nodes.simulation import Simulation
from swapcan.nodes.vcu import Vcu
from swapcan.scenarios.stage import Left, Stage
from swapcan.wire import Codec
from typedcan.drive import driving
from typedcan.drive.driving import Driving
from typedcan.drive.noting_bus import NotingBus
from typedcan.simulate.faults import PlannedFault
from typedcan.simulate.shared_bus import SharedBus
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire


@pytest.fixture(autouse=True)
def _short_look_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 0.2)


def on_wire(rig: Bench) -> list[can.Message]:
    """The commands that were on the wire."""
    return [frame for frame in rig.heard() if frame.arbitration_id == V2B_CMD.FRAME_ID]


class Truck:
    """A simulated VCU on the wire of a pack, driven as `swapcan simulate` does."""

    def __init__(self, rig: Bench, fault: str = "") -> None:
        self.rig = rig
        self.faults = [planned_fault(fault)] if fault else []
        self.bus = NotingBus(rig.tester, Codec(), lambda _: None, clock=rig.clock)
        self.driving = Driving(
            [self.bus], clock=rig.clock, wires=(rig.wire,), is_over=self._is_over
        )
        self.is_over: Callable[[], bool] = lambda: False
        self.simulation = Simulation(
            ["VCU"],
            SharedBus(self.bus).share,
            plan=plan_of("hv_on@0s"),
            faults=self.faults,
            clock=rig.clock,
            wires=(rig.wire,),
        )

    def leave(self, faults: Sequence[PlannedFault] = ()) -> Left:
        """Leave the bus, as far as is not done yet; those faults end."""
        return self.driving.leave(departure(self.simulation, [self.bus], faults))

    def _is_over(self) -> bool:
        return self.is_over()


@contextmanager
def truck(fault: str = "") -> Iterator[Truck]:
    with bench() as rig:
        driven = Truck(rig, fault)
        with driven.simulation:
            yield driven
        driven.bus.shutdown()


def is_whole(frame: can.Message) -> bool:
    xor = 0
    for byte in frame.data[1:]:
        xor ^= byte
    return frame.data[0] == xor


@pytest.mark.parametrize(
    "fault",
    [
        *("VCU.bus_silence@2s", "V2B_CMD.lost_frame@2s", "V2B_CMD.late_frame@2s"),
        *("V2B_CMD.stuck_counter@2s", "V2B_CMD.wrong_checksum@2s"),
    ],
)
def test_a_fault_of_the_transmission_does_not_keep_the_safe_codes_back(fault: str) -> None:
    with truck(fault) as driven:
        driven.driving.live(driven.simulation.world, 2.12)
        assert driven.rig.pack.pack.relays.closed
        before = len(on_wire(driven.rig))
        assert before > 20
        begin = driven.rig.clock.now()
        assert driven.leave(driven.faults) is Left.SAFE
        assert driven.rig.clock.now() - begin == pytest.approx(0.5, abs=0.02)
        frames = on_wire(driven.rig)
        assert {command_in(frame) for frame in frames} == {HvCommand.HV_OFF}
        assert 10 <= len(frames) <= 13  # one at once, and as often as it is due
        assert all(map(is_whole, frames))
        counters = [frame.data[1] & 0xF for frame in frames]
        steps = {(b - a) % 15 for a, b in itertools.pairwise(counters)}
        assert steps <= {1, 2}
        assert driven.rig.pack.pack.relays.closed == frozenset()


def test_frames_that_are_held_back_do_not_act_after_the_safe_codes() -> None:
    with truck("V2B_CMD.late_frame@2s") as driven:
        driven.is_over = lambda: bool(driven.simulation.buses["VCU"][0]._held)
        driven.driving.live(driven.simulation.world, 5.0)
        on_wire(driven.rig)
        assert driven.leave() is Left.SAFE  # the fault is not healed
        assert {command_in(frame) for frame in on_wire(driven.rig)} == {HvCommand.HV_OFF}


@pytest.mark.parametrize("name", ["step", "withdraw", "_command"])
def test_a_simulated_truck_that_fails_itself_is_left_with_the_pack_open(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    with bench() as rig:
        progress = Progress(rig)
        stage = rig.stage(is_over=lambda: progress.look() is Phase.CLOSED and name != "_command")
        method: Callable[..., Any] = getattr(Vcu, name)
        failed: list[str] = []

        def failing(self: Vcu, *given: Any) -> Any:
            if failed or progress.look() is Phase.CLOSED or name == "withdraw":
                failed.append(name)
                raise ZeroDivisionError
            return method(self, *given)

        monkeypatch.setattr(Vcu, name, failing)
        if name == "step":
            with pytest.raises(ZeroDivisionError):
                stage.play(SCENARIO, ["VCU"], lambda _: None)
        else:
            stage.play(SCENARIO, ["VCU"], lambda _: None)
        assert failed
        assert stage.left is Left.SAFE
        progress.look()
        assert set(progress.commands[-5:]) == {HvCommand.HV_OFF}
        assert rig.pack.pack.relays.closed == frozenset()


def test_leaving_that_is_broken_into_again_and_again_ends_all_the_same(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with truck() as driven:
        driven.driving.live(driven.simulation.world, 0.5)
        tried = []

        def break_in(*_: object) -> Left:
            tried.append(driven.rig.clock.now())
            raise KeyboardInterrupt

        monkeypatch.setattr(Driving, "_leave", break_in)
        assert driven.leave() is Left.UNKNOWN
        assert 10 < len(tried) < 1000
        assert isinstance(driven.driving.interrupted, KeyboardInterrupt)


def test_what_acts_can_be_ended_in_the_middle_of_a_scenario_and_stays_so() -> None:
    """As is done before a signal stops the process at its terminal."""
    with bench() as rig:
        progress = Progress(rig)
        ended: list[int] = []

        def end(*_: object) -> None:
            if not ended and progress.look() is Phase.CLOSED:
                stage.send_safe_codes()
                ended.append(len(progress.commands))

        stage = Stage(rig.tester, clock=rig.clock, wires=(rig.wire,), watch=end)
        assert not stage.hangs
        stage.send_safe_codes()  # of nothing
        stage.play(SCENARIO, ["VCU"], lambda _: None)
        assert not stage.hangs
        progress.look()
        assert set(progress.commands[ended[0] :]) == {HvCommand.HV_OFF}
        assert stage.left is Left.SAFE


@pytest.mark.parametrize("line", [9, 17, 33, 60, 130, 400, 1100, 3000])
def test_an_interrupt_at_any_line_of_the_leaving_does_not_cut_it_short(line: int) -> None:
    """Ctrl-C, where nobody has taken it over, comes between any two lines."""
    with bench() as rig:
        progress = Progress(rig)
        interrupt = AtLine(line)

        def is_over() -> bool:
            if progress.look() is Phase.CLOSED:
                interrupt.begin()
                return True
            return False

        stage = Stage(rig.tester, clock=rig.clock, wires=(rig.wire,), is_over=is_over)
        try:
            with pytest.raises(KeyboardInterrupt):
                stage.play(SCENARIO, ["VCU"], lambda _: None)
        finally:
            sys.settrace(interrupt.before)
        assert stage.left is Left.SAFE
        progress.look()
        assert set(progress.commands[-7:]) == {HvCommand.HV_OFF}
        assert rig.pack.pack.relays.closed == frozenset()


class AtLine:
    """Raises `KeyboardInterrupt` at the so many-th line that runs of what leaves."""

    def __init__(self, line: int) -> None:
        self._left = line
        drive = str(Path(typedcan.drive.__file__).parent)
        self._places = (drive, swapcan.nodes.departure.__file__)
        self.before = sys.gettrace()

    def begin(self) -> None:
        """Count from now on."""
        sys.settrace(self._trace)

    def _trace(self, frame: FrameType, event: str, _: object) -> Any:
        if not frame.f_code.co_filename.startswith(self._places):
            return None
        if event == "line":
            self._left -= 1
            if not self._left:
                raise KeyboardInterrupt
        return self._trace


def test_a_simulated_pack_that_charges_and_cools_ends_that_for_the_others() -> None:
    clock = SharedClock()
    wire = SimulatedWire(clock)
    with SimulatedBus(wire) as near, SimulatedBus(wire) as far, SimulatedBus(wire) as listener:
        charger = Chg(far, clock=clock)
        clock.pack = charger  # type: ignore[assignment]  # lives beside what is driven
        with NotingBus(near, Codec(), lambda _: None, clock=clock) as bus:
            driven = Driving([bus], clock=clock, wires=(wire,), is_over=lambda: charger.current > 5)
            share = SharedBus(bus).share
            with Simulation(["BMU"], share, clock=clock, wires=(wire,)) as simulation:
                driven.live(simulation.world, 60.0)
                assert charger.current > 5.0
                assert {message.NAME for message in bus.acting} == {"B2C_Charger", "BMS_TMS_0"}
                while listener.recv(0):
                    pass
                assert driven.leave(departure(simulation, [bus])) is Left.SAFE
                assert bus.acting == ()
        last = {}
        while frame := listener.recv(0):
            last[frame.arbitration_id] = values(frame)
        assert not charger.charging
        assert charger.current == 0.0
    # That the charger has said so was waited for.
    assert last[C2B_ACStatus.FRAME_ID]["C2B_St_ChargerStart"] != ChargerOperation.ON
    stop, unit = last[B2C_Charger.FRAME_ID], last[BMS_TMS_0.FRAME_ID]
    assert stop["B2V_S_ChargeControl"] == ChargeControl.NORMAL_STOP_TO_CHARGE
    assert unit["BMS_ReqstSetTMSts"] == ThermalMode.OFF
    assert unit["BMS_ReqstTMSHVon"] == HvRequest.REQUEST_HV_OFF


class Unstoppable(Chg):
    """Gives, and says so, whatever it is told."""

    @property
    def charging(self) -> bool:
        return self._reporting


def test_a_simulated_pack_is_not_left_safe_while_a_charger_says_that_it_gives() -> None:
    clock = SharedClock()
    wire = SimulatedWire(clock)
    with SimulatedBus(wire) as near, SimulatedBus(wire) as far:
        clock.pack = Unstoppable(far, clock=clock)  # type: ignore[assignment]
        with NotingBus(near, Codec(), lambda _: None, clock=clock) as bus:
            driven = Driving(
                [bus],
                clock=clock,
                wires=(wire,),
                is_over=lambda: "B2C_Charger" in {each.NAME for each in bus.acting},
            )
            share = SharedBus(bus).share
            with Simulation(["BMU"], share, clock=clock, wires=(wire,)) as simulation:
                driven.live(simulation.world, 60.0)
                assert bus.acting
                begin = clock.now()
                assert driven.leave(departure(simulation, [bus])) is Left.UNKNOWN
                assert clock.now() - begin == pytest.approx(driving.LEAVING, abs=0.06)
                assert bus.acting == ()
