"""Whatever is raised by whom while a pack is driven, once or for good: it is left open."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator

import pytest
from _pytest.mark import ParameterSet
from drive.trouble import EXCEPTIONS, OTHERS, PLACES, Phase, Progress, Trouble, play
from scenarios.rig import Bench, bench

from swapcan.messages import HvCommand
from swapcan.scenarios.stage import Left, Stage
from typedcan.drive import driving

ERRORS = (*EXCEPTIONS, *OTHERS)
OWN_TIMEOUT = 11.0
"""Seconds in which the simulated pack opens if it hears no command any more, and one more."""


@pytest.fixture(autouse=True)
def _short_look_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 0.2)


@pytest.fixture(autouse=True)
def _no_thread_is_left() -> Iterator[None]:
    before = set(threading.enumerate())
    yield
    assert set(threading.enumerate()) == before


def cases() -> Iterator[ParameterSet]:
    """Each place in each phase, once and for good, with one error after the other."""
    number = itertools.count()
    for place, for_good, phase in itertools.product(PLACES, (False, True), Phase):
        error = ERRORS[7 * next(number) % len(ERRORS)]
        name = f"{place}-{'for_good' if for_good else 'once'}-{phase.name}-{type(error()).__name__}"
        yield pytest.param(place, phase, error, for_good, id=name)


@pytest.mark.parametrize(("place", "phase", "error", "for_good"), tuple(cases()))
def test_it_leaves_the_pack_open(
    place: str, phase: Phase, error: Callable[[], BaseException], *, for_good: bool
) -> None:
    with bench() as rig:
        progress = Progress(rig)
        trouble = Trouble(error, lambda coming: progress.look(coming) is phase, for_good=for_good)
        stage, raised = play(rig, trouble, place)
        assert trouble.raised, "the phase was never reached"
        check_open(rig, progress, stage, could_send=place != "send" or not for_good)
        is_bus = place in ("recv", "send", "sent")
        if is_bus and not for_good and isinstance(error(), Exception):
            assert raised is None  # it went on, to its own verdict
        else:
            assert type(raised) is type(error())
        if not is_bus or not for_good:
            assert stage.left is Left.SAFE
        elif phase in (Phase.COMMANDED, Phase.PRECHARGE, Phase.CLOSED):
            assert stage.left is Left.UNKNOWN


def check_open(rig: Bench, progress: Progress, stage: Stage, *, could_send: bool) -> None:
    """See that the last commands that could be sent are off, and that no relay is closed."""
    progress.look()
    if could_send:
        assert set(progress.commands[-7:]) == {HvCommand.HV_OFF}
    if stage.left is not Left.SAFE and not could_send:
        rig.clock.advance_to(rig.clock.now() + OWN_TIMEOUT)
    assert rig.pack.pack.relays.closed == frozenset()
