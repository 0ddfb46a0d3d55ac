"""Hearing a bus that raises: heard on where it works again, given up where it does not."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import can
import pytest
from can.interfaces.virtual import VirtualBus
from drive.trouble import EXCEPTIONS

from swapcan import cli
from typedcan.drive.listening import listen


class Raising(can.BusABC):
    """A bus that raises from one call on, to another."""

    def __init__(self, error: Callable[[], Exception], first: int, last: int) -> None:
        self._error, self._first, self._last = error, first, last
        self.calls = 0
        super().__init__(channel="raising")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        raise AssertionError("something was sent")

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self.calls += 1
        if self._first <= self.calls <= self._last:
            raise self._error()
        return can.Message(arbitration_id=self.calls, is_extended_id=False), False


@pytest.mark.parametrize("error", EXCEPTIONS)
def test_a_moment_of_trouble_is_told_once_and_costs_no_frame(
    error: Callable[[], Exception],
) -> None:
    told: list[Exception] = []
    found: list[can.Message] = []
    with Raising(error, 3, 5) as bus:
        listen(bus, 30.0, found.append, is_over=lambda: len(found) == 6, report=told.append)
    assert [frame.arbitration_id for frame in found] == [1, 2, 6, 7, 8, 9]
    assert [type(each) for each in told] == [type(error())]


def test_what_lasts_for_a_second_is_raised() -> None:
    found: list[can.Message] = []
    told: list[Exception] = []
    begin = time.monotonic()
    with Raising(EXCEPTIONS[7], 4, 10**9) as bus, pytest.raises(IndexError):
        listen(bus, 30.0, found.append, report=told.append)
    assert 1.0 <= time.monotonic() - begin < 10.0
    assert len(found) == 3
    assert told == []
    assert bus.calls < 100  # it does not spin


def test_what_is_told_of_frames_is_raised_as_it_is() -> None:
    def fail(_: can.Message) -> None:
        raise IndexError("of a recorder")

    with Raising(EXCEPTIONS[0], 0, 0) as bus, pytest.raises(IndexError, match="of a recorder"):
        listen(bus, 30.0, fail)


def test_it_ends_in_time_and_tells_how_far_it_is() -> None:
    passed: list[tuple[float, float]] = []
    with can.Bus("nobody", "virtual", ignore_config=True) as bus:
        begin = time.monotonic()
        listen(bus, 0.3, lambda _: None, watch=lambda *given: passed.append(given))
    assert 0.3 <= time.monotonic() - begin < 5.0
    assert passed[0][1] == 0.3
    assert 0.0 <= passed[0][0] <= passed[-1][0] <= 0.3


@pytest.mark.parametrize("command", ["listen", "conform"])
def test_a_line_that_is_cut_short_does_not_end_the_listening_of_a_command(
    command: str,
    channel: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    class Cut(VirtualBus):
        calls = 0

        def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
            self.calls += 1
            if self.calls % 3 == 0:
                raise IndexError("list index out of range")
            return can.Message(arbitration_id=self.calls, is_extended_id=False), False

    monkeypatch.setattr(can, "Bus", lambda **given: Cut(given["channel"]))
    more = {
        "listen": ("--seconds", "0.5"),
        "conform": ("--duration", "0.5", "--record", str(tmp_path / "bench.log")),
    }
    bus = ("-i", "virtual", "-c", channel)
    assert cli.run([command, *more[command], *bus]) == (0 if command == "listen" else 2)
    errors = capsys.readouterr().err
    assert errors.count("the bus failed for a moment: IndexError: list index out of range") == 1
    if command == "conform":  # nobody was there to be judged
        with can.LogReader(tmp_path / "bench.log") as reader:
            assert len(list(reader)) > 10
