"""How `swapcan simulate` leaves a pack that it has switched on, and what it says of that."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import can
import pytest
from can.interfaces.virtual import VirtualBus
from commands.running import as_arguments, bus_options
from drive.quick_pack import QuickPack, living
from drive.trouble import QUICK

from swapcan import cli
from swapcan.messages import HvCommand
from swapcan.scenarios import scenarios
from typedcan.drive import driving

Capture = pytest.CaptureFixture[str]
TRUCK = ("simulate", "VCU", "--plan", "hv_on@200ms", "-i", "virtual", "-c")


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 0.2)
    monkeypatch.setattr(driving, "LEAVING", 1.0)


@contextmanager
def pack_on(bus: can.BusABC, *, obeys: bool = True) -> Iterator[QuickPack]:
    pack = QuickPack(bus, obeys=obeys)
    with living(pack):
        yield pack


def test_when_its_time_is_over_the_pack_is_open_also_on_a_virtual_bus(
    near: can.BusABC, channel: str, capsys: Capture
) -> None:
    with pack_on(near) as pack:
        assert cli.run([*TRUCK, channel, "--seconds", "0.8"]) == 0
        pack.wait_for(lambda: not pack.is_closed)
    assert len(pack.since_on) >= 3
    first, last = capsys.readouterr().err.splitlines()
    assert first.startswith("swapcan: simulating VCU on ")
    assert first.endswith(f"{channel}, Ctrl-C ends")
    assert last.startswith("swapcan: simulated VCU for ")


def test_a_pack_that_does_not_open_is_to_be_taken_for_live(
    near: can.BusABC, channel: str, capsys: Capture
) -> None:
    with pack_on(near, obeys=False) as pack:
        assert cli.run([*TRUCK, channel, "--seconds", "0.8"]) == 2
    assert len(pack.since_on) >= 7  # it is told all the time that others are waited for
    assert set(pack.since_on) == {HvCommand.HV_OFF}
    errors = capsys.readouterr().err
    assert "it is off: TAKE IT FOR LIVE, switch it off by other means\n" in errors


def test_a_bus_that_takes_nothing_any_more_is_said_with_what_it_did_not_take(
    near: can.BusABC, channel: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    with pack_on(near) as pack:

        class Refusing(VirtualBus):
            def send(self, msg: can.Message, timeout: float | None = None) -> None:
                if pack.is_closed:
                    raise IndexError("no more")
                super().send(msg, timeout)

        monkeypatch.setattr(can, "Bus", lambda **given: Refusing(given["channel"]))
        assert cli.run([*TRUCK, channel]) == 2
        assert pack.is_closed  # until its own timeout
    errors = capsys.readouterr().err.splitlines()
    assert errors[1] == (
        "swapcan: the safe codes of V2B_CMD could not be sent:"
        " TAKE IT FOR LIVE, switch it off by other means"
    )
    assert errors[-1] == "swapcan: IndexError: no more"


def test_what_was_never_on_is_left_at_once(channel: str, capsys: Capture) -> None:
    assert cli.run([*TRUCK, channel, "--seconds", "0.3"]) == 0
    assert "TAKE IT FOR LIVE" not in capsys.readouterr().err


def test_scenarios_one_after_the_other_do_not_take_their_own_frames_for_anothers(
    monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    """Where an interface gives back what is sent, the last of it comes in the next look-out."""
    both = {name: replace(QUICK, name=name) for name in ("first", "second")}
    monkeypatch.setattr(scenarios, "SCENARIOS", both)
    options = bus_options("udp_multicast")
    command = ("conform", "--active", "first,second", "--only", "checksum")
    with can.Bus(ignore_config=True, **options) as bus, pack_on(bus) as pack:
        assert cli.run([*command, "--yes-drive-the-bus", *as_arguments(options)]) == 0
    assert not pack.is_closed
    errors = capsys.readouterr().err
    for name in both:
        assert f"swapcan: {name}: the pack has reported that it is off\n" in errors
