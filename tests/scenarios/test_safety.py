"""However a scenario ends, the pack is left without high voltage; nobody is talked over."""

from __future__ import annotations

from collections.abc import Callable

import can
import pytest
from scenarios.lines import values
from scenarios.rig import Altered, Bench, bench, take_off_for_on

from swapcan import encode
from swapcan.messages import (
    B2V_ST1,
    V2B_CMD,
    B2C_Charger,
    BmsState,
    C2B_ACStatus,
    ChargeControl,
    HvCommand,
)
from swapcan.scenarios.scenario import ScenarioError
from swapcan.scenarios.scenarios import SCENARIOS
from swapcan.scenarios.stage import LEAVING, LOOK_OUT, Left, Stage
from typedcan.model.errors import TypedcanError

ON_OFF = SCENARIOS["hv-on-off"]


def is_closed(rig: Bench) -> bool:
    """Whether the pack has high voltage on its terminals."""
    return rig.pack.state.state is BmsState.HV_CLOSED


def commands(rig: Bench) -> list[tuple[float, object]]:
    """When which command for high voltage was on the wire."""
    return [
        (frame.timestamp, values(frame)["V2B_CMD_HV_OnOff"])
        for frame in rig.heard()
        if frame.arbitration_id == V2B_CMD.FRAME_ID
    ]


def check_left_off(rig: Bench, since: float) -> None:
    """See that off and nothing else was commanded since a second, and that the pack is open."""
    last = [code for second, code in commands(rig) if second > since]
    assert len(last) >= 7  # in half a second
    assert set(last) == {HvCommand.HV_OFF}
    assert rig.pack.state.state is BmsState.HV_OPEN


def test_one_who_ends_it_early_leaves_the_pack_off() -> None:
    with bench() as rig:
        stage = rig.stage(is_over=lambda: is_closed(rig))
        ended: list[float] = []
        stage.play(
            ON_OFF, ["VCU"], lambda _: ended.append(rig.clock.now()) if is_closed(rig) else None
        )
        assert stage.left is Left.SAFE
        assert ended[0] < LOOK_OUT + 4.0
        check_left_off(rig, ended[0] + 0.1)


def test_what_was_planned_for_later_does_not_happen_any_more() -> None:
    # A pack that does not obey, so that leaving takes five seconds; on is planned for the first.
    with bench(lambda bus: Altered(bus, take_off_for_on)) as rig:
        stage = rig.stage(is_over=lambda: rig.clock.now() > LOOK_OUT + 0.5)
        stage.play(ON_OFF, ["VCU"], rig.frames.append)
        assert stage.left is Left.UNKNOWN
        assert rig.clock.now() > LOOK_OUT + LEAVING
        assert {code for _, code in commands(rig)} == {HvCommand.HV_OFF}


class Sleeping(can.BusABC):
    """What a pack has that says nothing any more once it is time to sleep."""

    def __init__(self, bus: can.BusABC, rig: list[Bench], at: float) -> None:
        self._bus, self._rig, self._at = bus, rig, at
        super().__init__(channel="test")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        if not self._rig or self._rig[0].clock.now() < self._at:
            self._bus.send(msg, timeout)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return self._bus.recv(timeout), False

    def shutdown(self) -> None:
        self._bus.shutdown()
        super().shutdown()


@pytest.mark.parametrize(
    ("asleep_after", "left"),
    [
        (13.8, Left.SAFE),  # has switched off at 13 s as it was told, then sleeps
        (12.5, Left.UNKNOWN),  # falls silent with high voltage closed
        (0.9, Left.UNKNOWN),  # was off when it was heard last, and told to be on after that
    ],
)
def test_a_pack_that_sleeps_is_safe_where_it_said_before_that_it_is_off(
    asleep_after: float, left: Left
) -> None:
    rigs: list[Bench] = []
    with bench(lambda bus: Sleeping(bus, rigs, LOOK_OUT + asleep_after)) as rig:
        rigs.append(rig)
        assert rig.play(ON_OFF).left is left


def test_before_anything_was_sent_nothing_is_sent_in_the_end_either() -> None:
    with bench() as rig:
        stage = rig.stage(is_over=lambda: rig.clock.now() > LOOK_OUT / 2)
        stage.play(ON_OFF, ["VCU"], rig.frames.append)
        assert stage.left is Left.UNTOUCHED
        assert commands(rig) == []


def ignore(*_: object) -> None:
    """Do nothing."""


class DiskFullError(TypedcanError):
    """A record cannot be written."""


@pytest.mark.parametrize("error", [DiskFullError("no space"), KeyboardInterrupt()])
def test_an_error_comes_after_the_pack_is_off(error: BaseException) -> None:
    with bench() as rig:
        failed: list[float] = []

        def fail(*_: object) -> None:
            if is_closed(rig) and not failed:
                failed.append(rig.clock.now())
                raise error

        is_disk = isinstance(error, DiskFullError)
        stage = Stage(
            rig.tester,
            clock=rig.clock,
            wires=(rig.wire,),
            watch=ignore if is_disk else fail,
        )
        with pytest.raises(type(error)):
            stage.play(ON_OFF, ["VCU"], fail if is_disk else ignore)
        assert stage.left is Left.SAFE
        check_left_off(rig, failed[0] + 0.1)


@pytest.mark.parametrize("name", ["silent-vcu", "stuck-counter"])
def test_what_is_wrong_with_the_commands_does_not_keep_them_from_switching_off(name: str) -> None:
    with bench() as rig:
        # The fault is there since 12 s, and the pack would obey nothing before 22 s.
        stage = rig.stage(is_over=lambda: rig.clock.now() > LOOK_OUT + 14.0)
        stage.play(SCENARIOS[name], ["VCU"], rig.frames.append)
        assert stage.left is Left.SAFE
        assert rig.clock.now() < LOOK_OUT + 15.0
        check_left_off(rig, LOOK_OUT + 14.1)


def test_spoilt_commands_are_not_made_right_by_ending_early() -> None:
    with bench() as rig:
        stage = rig.stage(is_over=lambda: rig.clock.now() > LOOK_OUT + 4.0)
        stage.play(SCENARIOS["wrong-checksum"], ["VCU"], rig.frames.append)
        assert any(code == HvCommand.HV_ON for _, code in commands(rig))
        states = {
            values(f)["B2V_ST1_BMS"] for f in rig.frames if f.arbitration_id == B2V_ST1.FRAME_ID
        }
        assert states == {BmsState.HV_OPEN}


class Failing(can.BusABC):
    """A bus that works until a moment."""

    def __init__(self, bus: can.BusABC, fails: Callable[[], bool]) -> None:
        self._bus, self._fails = bus, fails
        self.tried = 0
        super().__init__(channel="test")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        if self._fails():
            self.tried += 1
            raise can.CanOperationError("adapter is gone")
        self._bus.send(msg, timeout)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        if self._fails():
            raise can.CanOperationError("adapter is gone")
        return self._bus.recv(timeout), False


def test_a_bus_that_is_gone_ends_it_and_switching_off_was_tried_all_the_time() -> None:
    with bench() as rig:
        bus = Failing(rig.tester, lambda: is_closed(rig))
        with bus:
            stage = Stage(bus, clock=rig.clock, wires=(rig.wire,))
            with pytest.raises(can.CanOperationError, match="adapter is gone"):
                stage.play(ON_OFF, ["VCU"], rig.frames.append)
        assert stage.left is Left.UNKNOWN
        assert bus.tried >= LEAVING / V2B_CMD.PERIOD  # type: ignore[operator]


def test_a_bus_that_fails_for_a_moment_does_not_end_it() -> None:
    with bench() as rig:
        bus = Failing(rig.tester, lambda: LOOK_OUT + 3 < rig.clock.now() < LOOK_OUT + 3.5)
        with bus:
            stage = Stage(bus, clock=rig.clock, wires=(rig.wire,))
            stage.play(ON_OFF, ["VCU"], rig.frames.append)
        assert stage.left is Left.SAFE
        assert bus.tried > 0
        assert rig.clock.now() > LOOK_OUT + ON_OFF.seconds


def command(hv: HvCommand, counter: int) -> can.Message:
    """What another VCU sends."""
    data = encode(V2B_CMD(hv_on_off=hv, vehicle_speed=0.0), counter=counter)
    return can.Message(arbitration_id=V2B_CMD.FRAME_ID, is_extended_id=True, data=data)


def test_another_truck_on_the_bus_is_not_talked_over() -> None:
    with bench() as rig:
        rig.outside.send(command(HvCommand.HV_OFF, 3))
        with pytest.raises(
            ScenarioError,
            match=r"^another VCU is on the bus: V2B_CMD \(0x1802F3D0\) comes from somebody else",
        ):
            rig.play(ON_OFF)
        assert len(commands(rig)) == 1  # its own


def test_another_truck_that_comes_later_ends_it() -> None:
    with bench() as rig:
        stage = rig.stage()
        sent: list[float] = []

        def come(_: can.Message) -> None:
            if is_closed(rig) and not sent:
                sent.append(rig.clock.now())
                rig.outside.send(command(HvCommand.HV_ON, 14))

        with pytest.raises(ScenarioError, match="another VCU is on the bus"):
            stage.play(ON_OFF, ["VCU"], come)
        assert stage.left is Left.SAFE
        check_left_off(rig, sent[0] + 0.2)


class Echoing(can.BusABC):
    """An interface that gives back what was sent on it, as udp_multicast does."""

    def __init__(self, bus: can.BusABC) -> None:
        self._bus = bus
        self._echoes: list[can.Message] = []
        super().__init__(channel="test")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self._bus.send(msg, timeout)
        echo = can.Message(
            arbitration_id=msg.arbitration_id, is_extended_id=True, data=bytes(msg.data)
        )
        self._echoes.append(echo)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        return (self._echoes.pop(0) if self._echoes else self._bus.recv(timeout)), False


def test_ones_own_echo_is_nobody_else_and_is_recorded_once() -> None:
    with bench() as rig, Echoing(rig.tester) as bus:
        stage = Stage(bus, clock=rig.clock, wires=(rig.wire,))
        stage.play(SCENARIOS["requests"], ["VCU"], rig.frames.append)
        assert stage.left is Left.SAFE
        on_wire = [bytes(frame.data) for frame in rig.heard() if _is_command(frame)]
        assert [bytes(frame.data) for frame in rig.frames if _is_command(frame)] == on_wire


def _is_command(frame: can.Message) -> bool:
    return frame.arbitration_id == V2B_CMD.FRAME_ID


def test_a_charger_that_is_taken_off_early_leaves_a_pack_that_does_not_charge() -> None:
    def is_charging(rig: Bench) -> bool:
        return rig.pack.state.charge.control is ChargeControl.START_TO_CHARGE

    with bench() as rig:
        stage = rig.stage(is_over=lambda: is_charging(rig) and rig.clock.now() > LOOK_OUT + 6)
        stage.play(SCENARIOS["charge"], ["CHG"], rig.frames.append)
        assert stage.left is Left.SAFE
        assert not is_charging(rig)
        reports = [f for f in rig.frames if f.arbitration_id == C2B_ACStatus.FRAME_ID]
        wanted = [values(f) for f in rig.frames if f.arbitration_id == B2C_Charger.FRAME_ID]
        assert reports[-1].timestamp < rig.clock.now() - 2.0
        assert wanted[-1]["B2V_S_ChargeControl"] != ChargeControl.START_TO_CHARGE
