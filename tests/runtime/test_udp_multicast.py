"""Links and commands between processes, over a multicast group on this machine."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator

import can
import pytest

from swapcan import Link, ReceiveTimeoutError
from swapcan.messages import B2V_ST2, V2B_CMD

GROUP = "239.74.163.2"


@pytest.fixture
def port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        number = probe.getsockname()[1]
        assert isinstance(number, int)
        return number


@pytest.fixture
def bus(port: int) -> Iterator[can.BusABC]:
    pytest.importorskip("msgpack", reason="python-can's udp_multicast needs msgpack")
    try:
        opened = can.Bus(GROUP, "udp_multicast", ignore_config=True, port=port)
    except can.CanError as error:
        pytest.skip(f"no multicast here: {error}")
    with opened:
        opened.send(can.Message(arbitration_id=0x1))
        if opened.recv(1.0) is None:  # every member of a group hears what it sends
            pytest.skip("no multicast here: a datagram to the group does not come back")
        yield opened


@pytest.fixture
def options(port: int) -> list[str]:
    return ["-i", "udp_multicast", "-c", GROUP, "--bus-kwargs", f"port={port}"]


@pytest.fixture
def listener(
    bus: can.BusABC, options: list[str], environment: dict[str, str]
) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Starts `swapcan listen` and returns once it listens."""
    started: list[subprocess.Popen[str]] = []

    def start(*arguments: str) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, "-m", "swapcan", "listen", *options, *arguments],
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
        )
        started.append(process)
        assert process.stderr
        assert process.stderr.readline().startswith("swapcan: listening on ")
        return process

    yield start
    for process in started:
        process.kill()
        process.communicate()


def test_two_links_talk_over_multicast(bus: can.BusABC, port: int) -> None:
    with can.Bus(GROUP, "udp_multicast", ignore_config=True, port=port) as other:
        Link(bus).send(B2V_ST2(soc=80.0))
        received = Link(other).receive(timeout=5.0)
    assert isinstance(received.message, B2V_ST2)
    assert received.frame.data.hex() == "c8ffffffffffffff"


def test_send_puts_one_frame_on_the_bus_and_prints_it(
    bus: can.BusABC,
    options: list[str],
    swapcan_command: Callable[..., subprocess.CompletedProcess[str]],
) -> None:
    message = ("V2B_CMD", "hv_on_off=HV On", "vehicle_speed=42")
    done = swapcan_command("send", *message, *options, "--yes-drive-the-bus")
    assert (done.returncode, done.stderr) == (0, "swapcan: looking for another VCU for 2 s\n")
    link = Link(bus)
    received = link.receive(timeout=5.0)
    assert isinstance(received.message, V2B_CMD)
    assert received.message.vehicle_speed == 42.0
    assert done.stdout.startswith("0x1802F3D0  [3A D0 2A FF FF FF 3F 00]  V2B_CMD  checksum=58  ")
    assert received.frame.data.hex(" ").upper() in done.stdout
    with pytest.raises(ReceiveTimeoutError):
        link.receive(timeout=0)


def test_listen_prints_messages_as_they_arrive_and_ends_after_a_count(
    bus: can.BusABC, listener: Callable[..., subprocess.Popen[str]]
) -> None:
    process = listener("--count", "2")
    assert process.stdout
    link = Link(bus)
    link.send(B2V_ST2(soc=80.0))
    assert "  B2V_ST2         soc=80 %  soh=Signal Invalid  " in process.stdout.readline()
    bus.send(can.Message(arbitration_id=0x1882D0F3, data=bytes(7)))
    line = process.stdout.readline()
    assert line.endswith("  00000000000000    B2V_ST2         ! 7 bytes instead of 8\n")
    bus.send(can.Message(arbitration_id=0x123, is_extended_id=False))
    link.send(B2V_ST2(soc=40.0))
    out, errors = process.communicate(timeout=10)
    assert "soc=40 %" in out
    assert process.returncode == 0
    assert errors == (
        "swapcan: frames 4, decoded 2, unknown 1 (identifiers 1),"
        " faults 1 (length 1, checksum 0, counter 0)\n"
    )


def test_listen_prints_json_as_it_arrives(
    bus: can.BusABC, listener: Callable[..., subprocess.Popen[str]]
) -> None:
    process = listener("--json")
    assert process.stdout
    Link(bus).send(B2V_ST2(soc=80.0))
    line = json.loads(process.stdout.readline())
    assert (line["message"], line["signals"]["B2V_ST2_SOC"]) == ("B2V_ST2", 80.0)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
def test_ctrl_c_ends_listen_with_its_summary_and_no_traceback(
    bus: can.BusABC, listener: Callable[..., subprocess.Popen[str]]
) -> None:
    process = listener()
    assert process.stdout
    Link(bus).send(B2V_ST2(soc=80.0))
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    out, errors = process.communicate(timeout=10)
    assert process.returncode == 130
    assert out == ""
    assert errors.startswith("swapcan: frames 1, decoded 1, ")
    assert errors.count("\n") == 1


def test_listen_ends_quietly_when_its_reader_goes_away(
    bus: can.BusABC, listener: Callable[..., subprocess.Popen[str]]
) -> None:
    process = listener()
    assert process.stdout
    assert process.stderr
    link = Link(bus)
    link.send(B2V_ST2(soc=80.0))
    process.stdout.readline()
    process.stdout.close()
    link.send(B2V_ST2(soc=81.0))
    assert process.wait(timeout=10) == 2
    assert process.stderr.read() == "swapcan: nobody reads the output any more\n"
