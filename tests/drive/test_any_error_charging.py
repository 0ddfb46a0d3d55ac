"""Whatever is raised by whom while a charger is played: nobody charges in the end."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import replace

import can
import pytest
from _pytest.mark import ParameterSet
from drive.trouble import EXCEPTIONS, OTHERS, PLACES, Trouble, play
from scenarios.lines import values
from scenarios.rig import Bench, bench
from scenarios.test_safety import Sleeping

from swapcan.messages import B2C_Charger, C2B_ACStatus, ChargeControl, ChargerOperation
from swapcan.nodes.plan import plan_of
from swapcan.scenarios.scenario import Scenario
from swapcan.scenarios.stage import Left
from typedcan.drive import driving
from typedcan.report.language import Text

SCENARIO = Scenario(
    name="charger",
    title=Text("a charger comes and goes", "充电机接入和断开"),
    plays=("CHG",),
    plan=plan_of("charge@100ms+5s"),
    seconds=5.5,
    rules=(),
)
LOST = 3.0
"""Seconds in which the simulated pack notices that the charger says nothing, and stops."""


@pytest.fixture(autouse=True)
def _short_look_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 0.2)


def cases() -> Iterator[ParameterSet]:
    """Each place, once and for good, with one error after the other."""
    errors = itertools.cycle((*EXCEPTIONS[::2], *OTHERS))
    for place, for_good in itertools.product(PLACES, (False, True)):
        error = next(errors)
        name = f"{place}-{'for_good' if for_good else 'once'}-{type(error()).__name__}"
        yield pytest.param(place, error, for_good, id=name)


class OnTheWire:
    """What pack and charger say."""

    def __init__(self, rig: Bench) -> None:
        self._rig = rig
        self.reports: list[can.Message] = []
        self.wanted: list[object] = []

    @property
    def is_charging(self) -> bool:
        """Whether the charger says that it is on, as the pack asks for."""
        while frame := self._rig.listener.recv(0):
            if frame.arbitration_id == C2B_ACStatus.FRAME_ID:
                self.reports.append(frame)
            if frame.arbitration_id == B2C_Charger.FRAME_ID:
                self.wanted.append(values(frame)["B2V_S_ChargeControl"])
        starts = bool(self.wanted) and self.wanted[-1] == ChargeControl.START_TO_CHARGE
        return starts and any(
            values(frame)["C2B_St_ChargerStart"] == ChargerOperation.ON for frame in self.reports
        )


@pytest.mark.parametrize(("place", "error", "for_good"), tuple(cases()))
def test_it_leaves_a_pack_that_does_not_charge(
    place: str, error: Callable[[], BaseException], *, for_good: bool
) -> None:
    with bench() as rig:
        wire = OnTheWire(rig)
        trouble = Trouble(error, lambda _: wire.is_charging, for_good=for_good)
        stage, raised = play(rig, trouble, place, SCENARIO, ["CHG"])
        assert trouble.raised, "it never charged"
        ended = rig.clock.now()
        rig.clock.advance_to(ended + LOST)
        assert not wire.is_charging
        assert wire.reports[-1].timestamp <= ended  # the charger is gone
        assert wire.wanted[-1] != ChargeControl.START_TO_CHARGE
        assert rig.pack.pack.relays.closed == frozenset()
        is_bus = place in ("recv", "send", "sent")
        if is_bus and not for_good and isinstance(error(), Exception):
            assert raised is None
        else:
            assert type(raised) is type(error())
        if not is_bus or not for_good:
            assert stage.left is Left.SAFE
        assert stage.left is not Left.UNTOUCHED


def test_a_pack_that_has_said_that_it_stopped_may_be_asleep_when_the_charger_was_taken_off() -> (
    None
):
    rigs: list[Bench] = []
    with bench(lambda bus: Sleeping(bus, rigs, 8.0)) as rig:
        rigs.append(rig)
        wire = OnTheWire(rig)
        short = replace(SCENARIO, plan=plan_of("charge@100ms+4s"), seconds=8.5)
        stage, raised = play(
            rig, Trouble(OSError, lambda _: False, for_good=False), "recv", short, ["CHG"]
        )
        assert raised is None
        assert not wire.is_charging
        assert ChargeControl.START_TO_CHARGE in wire.wanted
        assert stage.left is Left.SAFE
        begin = driving.look_out_time([C2B_ACStatus])
        assert rig.clock.now() < begin + 8.5 + 1.0  # nothing had to be waited for
