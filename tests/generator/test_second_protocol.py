"""A second protocol, with 11-bit identifiers, goes its way without the package of the first."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

SECOND = Path(__file__).parent.parent / "fixtures" / "second"
WITHOUT = "import sys; sys.modules['swapcan'] = None\n"
DBCSPEC = WITHOUT + "from dbcspec.cli import run; sys.exit(run(sys.argv[1:]))"
LINKS = (
    WITHOUT
    + """
import can
from acme._generated.messages import A_STATUS, B_CMD
from acme._generated.protocol import PROTOCOL
from typedcan.wire.codec import Codec
from typedcan.wire.link import Link

codec = Codec(PROTOCOL)
with can.Bus("second", "virtual") as near, can.Bus("second", "virtual") as far, \\
        can.Bus("second", "virtual") as wire:
    a, b = Link(near, codec), Link(far, codec)
    a.send(A_STATUS(speed=12.5))
    a.send(A_STATUS(speed=100.0))
    b.send(B_CMD(go=1))
    for _ in range(2):
        message = b.receive(timeout=5).message
        print(message.NAME, message.speed, message.cnt, b.counts.received, sep=" ")
    print(a.receive(timeout=5).message.go)
    for _ in range(3):
        frame = wire.recv(5)
        print(f"{frame.arbitration_id:X}", frame.is_extended_id, frame.data.hex())
print([(bus.name, bus.bit_rate) for bus in PROTOCOL.model.buses], PROTOCOL.nodes)
"""
)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "second"
    shutil.copytree(SECOND, folder)
    return folder


def run(folder: Path, program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", program, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONUTF8": "1"},
    )


def with_xor(folder: Path) -> None:
    """Its checksum by an algorithm that the runtime has."""
    path = folder / "spec" / "behaviour.yaml"
    path.write_text(path.read_text("utf-8").replace("crc8_sae_j1850", "xor"), "utf-8")


def test_a_checksum_that_nothing_computes_is_refused_and_not_sent_as_zero(project: Path) -> None:
    linted = run(project, DBCSPEC, "lint", "--json")
    assert linted.returncode == 1
    assert "checksum-algorithm-known" in linted.stdout
    assert "crc8_sae_j1850" in linted.stdout
    generated = run(project, DBCSPEC, "generate")
    assert generated.returncode in (1, 2)
    assert "crc8_sae_j1850" in generated.stderr
    assert not (project / "acme").exists()


def test_links_send_and_receive_its_11_bit_messages(project: Path) -> None:
    with_xor(project)
    assert run(project, DBCSPEC, "lint").returncode == 0
    generated = run(project, DBCSPEC, "generate")
    assert generated.returncode == 0, generated.stderr
    done = run(project, LINKS)
    assert done.returncode == 0, done.stderr
    # 12.5 km/h is 125 = 7D steps, 100 km/h 1000 = 3E8; byte 0 is the XOR of the others.
    assert done.stdout.splitlines() == [
        "A_STATUS 12.5 0 1",
        "A_STATUS 100.0 1 2",
        "1",
        "101 False 7d007d0000000000",
        "101 False ea01e80300000000",
        "201 False 0100000000000000",
        "[('main', 500000)] ('AAA', 'BBB')",
    ]
