"""Truck and pack in two processes: on, drive, charge, off, in lock step and in real time."""

from __future__ import annotations

import json
import subprocess
import time
from typing import Any

import can
import pytest
from commands.running import as_arguments, bus_options, started
from nodes.wire_log import WireLog

from swapcan.messages import BmsState, ChargeState, HvCommand

YES = "--yes-drive-the-bus"
STEP = 0.02
"""Seconds between two meetings of the processes."""


class Child:
    """A process in lock step."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self.state: dict[str, Any] = {}
        assert self._line() == "ready", process.stderr and process.stderr.read()

    def live_to(self, second: float) -> None:
        """Let it live up to a second of its clock and say what there is."""
        assert self._process.stdin
        self._process.stdin.write(f"{second}\n")
        self._process.stdin.flush()
        self.state = json.loads(self._line())

    def _line(self) -> str:
        assert self._process.stdout
        return self._process.stdout.readline().strip()


def meet(second: float, one: Child, other: Child, bus: can.BusABC, log: WireLog) -> None:
    """Let both live up to a second, until each frame has arrived at the other and here."""
    deadline = time.monotonic() + 10.0
    one.live_to(second)
    other.live_to(second)
    while True:
        while frame := bus.recv(0):
            log.take(frame)
        sent = one.state["sent"], other.state["sent"]
        received = other.state["received"], one.state["received"]
        if received == sent and log.frames == sum(sent):
            return
        assert time.monotonic() < deadline, f"sent {sent}, received {received} and {log.frames}"
        one.live_to(second)
        other.live_to(second)


@pytest.mark.parametrize("interface", ["udp_multicast", "socketcan"])
def test_on_drive_charge_off_on_the_simulated_clock(interface: str) -> None:
    options = bus_options(interface)
    arguments = ("-m", "nodes.lockstep")
    log = WireLog()
    with (
        can.Bus(ignore_config=True, **options) as bus,
        started(
            *arguments, "VCU", "hv_on@0.5s,drive@2s+4s,hv_off@14s", json.dumps(options)
        ) as truck,
        started(*arguments, "BMU,CHG", "charge@9s+4s", json.dumps(options)) as pack,
    ):
        one, other = Child(truck), Child(pack)
        for step in range(round(15.5 / STEP)):
            meet((step + 1) * STEP, one, other, bus, log)
        assert one.state["status"] == ["off"]
        assert other.state["status"] == ["HV open", "not connected"]
        assert (one.state["faults"], other.state["faults"]) == (0, 0)
    check(log)
    assert log.frames > 15 * 150


@pytest.mark.parametrize("interface", ["udp_multicast", "socketcan"])
def test_on_drive_charge_off_in_real_time(interface: str) -> None:
    options = bus_options(interface)
    command = ("-m", "swapcan", "simulate")
    log = WireLog()
    with (
        can.Bus(ignore_config=True, **options) as bus,
        started(*command, "BMU", "CHG", *as_arguments(options), YES) as pack,
    ):
        assert pack.stderr
        assert "looking for others" in pack.stderr.readline()
        assert "simulating BMU, CHG" in pack.stderr.readline()
        plan = "hv_on@0.2s, drive@1.5s+1s, hv_off@6s"
        with started(
            *command, "VCU", *as_arguments(options), "--plan", plan, "--seconds", "7", YES
        ) as truck:
            while truck.poll() is None:
                if frame := bus.recv(0.1):
                    log.take(frame)
            out, errors = truck.communicate()
            assert truck.returncode == 0, errors
        while frame := bus.recv(0):
            log.take(frame)
    check(log)
    said = [line.split(maxsplit=2)[2] for line in out.splitlines()]
    assert [text for text in said if text in ("ready", "driving", "off")] == [
        "off",
        "ready",
        "driving",
        "ready",
        "off",
    ]


def check(log: WireLog) -> None:
    """See that all was done in order, as the frames tell it."""
    assert log.faults == []
    assert log.commands == [HvCommand.HV_OFF, HvCommand.HV_ON, HvCommand.HV_OFF]
    assert log.states == [
        BmsState.HV_OPEN,
        BmsState.PRECHARGE,
        BmsState.HV_CLOSED,
        BmsState.HV_OPEN,
    ]
    assert ChargeState.CHARGING in log.charge_states
    assert max(log.speeds) > 0.0
    log.check_relays()
    assert "st_main_pos" in frozenset[str]().union(*log.relays)
    assert "st_chg_pos1" in frozenset[str]().union(*log.relays)
