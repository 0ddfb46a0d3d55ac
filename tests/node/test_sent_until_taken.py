"""How safe codes are sent in the end: by turns, as often as it takes, and what is said of it."""

from __future__ import annotations

import threading
from collections.abc import Callable

import can
import pytest
from node.rough_bus import OwnInterrupt, raising

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import V2B_CMD, HvCommand
from swapcan.node import Node
from typedcan.node import leaving
from typedcan.node.leaving import (
    done_beside,
    raise_or_note,
    raise_what_ends_more,
    send_until_taken,
    still_acting,
)

ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)
GONE = OSError("gone")


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Who has sent, in order, and when it was waited; it takes no time."""
    told: list[str] = []
    monkeypatch.setattr(leaving.time, "sleep", lambda _: told.append("."))  # type: ignore[attr-defined]
    return told


def sender(told: list[str], name: str, fails: int = 0) -> Callable[[], BaseException | None]:
    """Sends under a name; so many times the bus refuses at first."""
    refusals = iter([GONE] * fails)

    def send() -> BaseException | None:
        told.append(name)
        return next(refusals, None)

    return send


def test_what_is_taken_is_sent_five_times_by_turns(told: list[str]) -> None:
    assert send_until_taken([sender(told, "a"), sender(told, "b")]) is None
    assert "".join(told) == "ab.ab.ab.ab.ab"


def test_turns_in_which_one_is_refused_do_not_count(told: list[str]) -> None:
    assert send_until_taken([sender(told, "a", 3), sender(told, "b", 1)]) is None
    assert "".join(told) == "ab." * 3 + "ab.ab.ab.ab.ab"


def test_what_is_never_taken_is_given_up_after_a_second(told: list[str]) -> None:
    assert send_until_taken([sender(told, "a", 1000), sender(told, "b")]) is GONE
    assert "".join(told) == "ab." * 20


def test_a_last_turn_that_is_refused_is_a_failure_though_others_were_taken(
    told: list[str],
) -> None:
    answers = iter([None, None, None, None, *[GONE] * 16])
    assert send_until_taken([lambda: next(answers)]) is GONE


def test_once_takes_no_time(told: list[str]) -> None:
    assert send_until_taken([sender(told, "a", 5)], once=True) is GONE
    assert send_until_taken([sender(told, "b")], once=True) is None
    assert told == ["a", "b"]


def test_where_nobody_has_anything_to_send_nothing_is_waited_for(told: list[str]) -> None:
    assert send_until_taken([]) is None
    assert told == []


@pytest.mark.parametrize("error", [ZeroDivisionError, KeyboardInterrupt, OwnInterrupt])
def test_what_a_sender_raises_keeps_neither_itself_nor_others_from_trying(
    told: list[str], error: type[BaseException]
) -> None:
    assert send_until_taken([raising(error, times=2), sender(told, "a")]) is None
    assert "".join(told) == "a." * 2 + "a.a.a.a.a"
    assert isinstance(send_until_taken([raising(error)]), error)


def test_what_breaks_into_waiting_is_told_once_all_is_sent(
    told: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("typedcan.node.leaving.time.sleep", raising(KeyboardInterrupt, times=1))
    assert isinstance(send_until_taken([sender(told, "a")]), KeyboardInterrupt)
    assert told == ["a"] * 5


def test_what_hangs_beside_is_not_waited_for_without_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(leaving, "_PATIENCE", 0.05)
    over = threading.Event()
    assert done_beside(over.wait, raising(AssertionError)) is False
    over.set()
    done: list[int] = []
    assert done_beside(lambda: done.append(1), raising(AssertionError)) is True
    assert done == [1]
    for thread in threading.enumerate():
        if thread.name == "typedcan-leave":
            thread.join(30.0)


def test_where_no_thread_can_be_started_it_is_done_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threading.Thread, "start", raising(RuntimeError))
    done: list[str] = []
    assert done_beside(raising(AssertionError), lambda: done.append("here")) is True
    assert done == ["here"]


def test_what_still_acts_is_named_with_its_cause() -> None:
    assert still_acting([], GONE) is None
    error = still_acting([ON], GONE)
    assert error
    assert (error.messages, error.cause, error.__cause__) == (("V2B_CMD",), "gone", GONE)
    assert still_acting([ON], None).cause == "the bus hangs"  # type: ignore[union-attr]


def test_what_ends_more_is_raised_in_the_main_thread_alone() -> None:
    raise_what_ends_more(None)
    raise_what_ends_more(GONE)
    with pytest.raises(KeyboardInterrupt):
        raise_what_ends_more(KeyboardInterrupt())
    raised: list[BaseException] = []

    def elsewhere() -> None:
        try:
            raise_what_ends_more(KeyboardInterrupt())
        except BaseException as error:  # noqa: BLE001
            raised.append(error)

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    assert raised == []


def test_a_failure_is_raised_or_told_beside_another_error(
    caplog: pytest.LogCaptureFixture,
) -> None:
    with pytest.raises(OSError, match="gone"):
        raise_or_note("PANEL", GONE, None)
    error = ZeroDivisionError()
    raise_or_note("PANEL", GONE, error)
    assert error.__notes__ == ["PANEL: gone"]
    assert caplog.messages == ["PANEL: gone"]


def test_a_node_that_was_started_in_another_process_ends_nothing_here(
    near: can.BusABC, far: can.BusABC, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Node(PROTOCOL, "VCU", near, leave="safe")
    node.start()
    node.send(ON)
    heard = far.recv(30.0)
    assert heard
    with monkeypatch.context() as elsewhere:
        elsewhere.setattr("typedcan.node.leaving.os.getpid", lambda: -1)
        node._engine._leaving.leave()
        node._engine._leaving.leave_beside()
        assert len(node.acting) == 1
        assert far.recv(0) is None
    node.stop()
    assert len(node.acting) == 0


def test_a_node_that_is_left_sends_less_and_never_more(near: can.BusABC) -> None:
    node = Node(PROTOCOL, "VCU", near)
    left = node._engine._leaving
    seen: list[str] = [node.sends]
    for change in (left.begin, left.end, left.begin, left.start):
        change()
        seen.append(node.sends)
    assert seen == ["all", "what does not act", "nothing", "nothing", "all"]
    assert left.failure is None


def test_beside_a_thread_that_hangs_it_is_told_why_the_bus_takes_nothing(
    rough: can.BusABC, far: can.BusABC
) -> None:
    node = Node(PROTOCOL, "VCU", rough)
    node.send(ON)
    rough.before_send = raising(lambda: OSError("Network is down"))  # type: ignore[attr-defined]
    left = node._engine._leaving
    left.leave_beside()
    failures = [left.failure]
    rough.before_send = raising(OSError, times=0)  # type: ignore[attr-defined]
    left.leave_beside()
    failures.append(left.failure)
    assert [each and each.cause for each in failures] == ["Network is down", None]
    assert node.acting == ()
