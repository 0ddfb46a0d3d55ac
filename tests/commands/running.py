"""`swapcan simulate` as a process of its own, and the buses that processes share."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import can
import pytest

import swapcan

GROUP = "239.74.163.2"


def environment() -> dict[str, str]:
    """The package under test and this folder's modules, and nothing that changes python-can."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith("CAN_")}
    paths = (Path(swapcan.__file__).parents[1], Path(__file__).parents[1])
    return kept | {"PYTHONPATH": os.pathsep.join(map(str, paths))}


@contextmanager
def started(*arguments: str) -> Iterator[subprocess.Popen[str]]:
    """A Python process with pipes, which does not outlive the block."""
    process = subprocess.Popen(
        [sys.executable, "-W", "error", *arguments],
        env=environment(),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def bus_options(interface: str) -> dict[str, Any]:
    """The arguments of a bus that two processes can share; skips where there is none."""
    if interface == "socketcan":
        if not Path("/sys/class/net/vcan0").exists():
            pytest.skip("this machine has no vcan0")
        return {"interface": "socketcan", "channel": "vcan0"}
    pytest.importorskip("msgpack", reason="python-can's udp_multicast needs msgpack")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        port = probe.getsockname()[1]
    options = {"interface": "udp_multicast", "channel": GROUP, "port": port}
    try:
        with can.Bus(ignore_config=True, **options) as bus:
            bus.send(can.Message(arbitration_id=0x1))
            if bus.recv(1.0) is None:  # every member of a group hears what it sends
                pytest.skip("no multicast here: a datagram to the group does not come back")
    except can.CanError as error:
        pytest.skip(f"no multicast here: {error}")
    return options


def as_arguments(options: dict[str, Any]) -> list[str]:
    """The same for the command line."""
    named = ["-i", options["interface"], "-c", options["channel"]]
    return [*named, "--bus-kwargs", f"port={options['port']}"] if "port" in options else named
