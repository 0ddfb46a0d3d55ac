"""`swapcan monitor` on a bus that raises what no interface should: it ends as it always does."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import can
import pytest
from can.interfaces.virtual import VirtualBus

from swapcan import cli

ERRORS: tuple[Callable[[], BaseException], ...] = (
    lambda: IndexError("list index out of range"),
    lambda: BrokenPipeError(32, "gone"),
    StopIteration,
)

Capture = pytest.CaptureFixture[str]


def raising(error: Callable[[], BaseException]) -> type[VirtualBus]:
    """A bus that gives one frame and then raises for good."""

    class Raising(VirtualBus):
        given = False

        def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
            if self.given:
                raise error()
            self.given = True
            return can.Message(arbitration_id=0x123, is_extended_id=False, timestamp=1.0), False

    return Raising


@pytest.mark.parametrize("error", ERRORS)
def test_its_time_passes_and_the_record_is_whole(
    error: Callable[[], BaseException],
    channel: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    bus_class = raising(error)
    monkeypatch.setattr(can, "Bus", lambda **given: bus_class(given["channel"]))
    path = tmp_path / "drive.blf"
    options = ("-i", "virtual", "-c", channel, "--plain", "--record", str(path))
    assert cli.run(["monitor", *options, "--seconds", "0.4"]) == 0
    said = capsys.readouterr()
    assert "bus lost" in said.out.lower()
    assert said.err.splitlines()[-1].startswith(f"swapcan: {path}: recorded ")
    with can.LogReader(path) as reader:
        assert next(iter(reader)).arbitration_id == 0x123


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one thread")
def test_ctrl_c_ends_it_all_the_same(
    channel: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    bus_class = raising(ERRORS[0])
    monkeypatch.setattr(can, "Bus", lambda **given: bus_class(given["channel"]))
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    main = threading.main_thread().ident
    assert main
    timer = threading.Timer(0.4, signal.pthread_kill, (main, signal.SIGINT))
    timer.start()
    path = tmp_path / "drive.log"
    try:
        options = ("-i", "virtual", "-c", channel, "--plain", "--record", str(path))
        assert cli.run(["monitor", *options]) == 130
    finally:
        timer.cancel()
        signal.signal(signal.SIGINT, before)
    assert f"{path}: recorded " in capsys.readouterr().err


@pytest.mark.parametrize("error", [SystemExit(0), SystemExit(1), SystemExit("x"), GeneratorExit()])
def test_a_driver_that_ends_the_program_has_not_done_its_work(
    error: BaseException, channel: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    def raise_it() -> BaseException:
        return error

    bus_class = raising(raise_it)
    monkeypatch.setattr(can, "Bus", lambda **given: bus_class(given["channel"]))
    for command in (("monitor", "--plain"), ("listen",), ("conform", "--duration", "5")):
        assert cli.run([*command, "-i", "virtual", "-c", channel]) == 2
        errors = capsys.readouterr().err.splitlines()
        assert errors[-1].startswith("swapcan: ")
