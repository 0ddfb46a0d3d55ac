"""A second protocol, with 11-bit identifiers, goes its way without the package of the first."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from oracles.bitwise_crc import Parameters, crc

J1850 = Parameters(width=8, poly=0x1D, init=0xFF, refin=False, refout=False, xorout=0xFF)
SECOND = Path(__file__).parent.parent / "fixtures" / "second"
WITHOUT = "import sys; sys.modules['swapcan'] = None\n"
DBCSPEC = WITHOUT + "from dbcspec.cli import run; sys.exit(run(sys.argv[1:]))"
TYPEDCAN = WITHOUT + "from typedcan.__main__ import main; sys.exit(main())"
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


def with_algorithm(folder: Path, algorithm: str) -> None:
    """Its checksum by another algorithm."""
    path = folder / "spec" / "behaviour.yaml"
    path.write_text(path.read_text("utf-8").replace("crc8_sae_j1850", algorithm), "utf-8")


def test_a_checksum_that_nothing_computes_is_refused_and_not_sent_as_zero(project: Path) -> None:
    with_algorithm(project, "crc8_of_nobody")
    linted = run(project, DBCSPEC, "lint", "--json")
    assert linted.returncode == 1
    assert "checksum-algorithm-known" in linted.stdout
    assert "crc8_of_nobody" in linted.stdout
    generated = run(project, DBCSPEC, "generate")
    assert generated.returncode in (1, 2)
    assert "crc8_of_nobody" in generated.stderr
    assert not (project / "acme").exists()


def test_links_send_and_receive_its_11_bit_messages(project: Path) -> None:
    assert run(project, DBCSPEC, "lint").returncode == 0
    generated = run(project, DBCSPEC, "generate")
    assert generated.returncode == 0, generated.stderr
    done = run(project, LINKS)
    assert done.returncode == 0, done.stderr
    # 12.5 km/h is 125 = 7D steps, 100 km/h 1000 = 3E8; byte 0 is the CRC-8 (polynomial 1D,
    # begun with FF, inverted at the end) of the others, as `oracles.bitwise_crc` divides it.
    assert crc(J1850, bytes.fromhex("007d0000000000")) == 0x2F
    assert crc(J1850, bytes.fromhex("01e80300000000")) == 0x3B
    assert done.stdout.splitlines() == [
        "A_STATUS 12.5 0 1",
        "A_STATUS 100.0 1 2",
        "1",
        "101 False 2f007d0000000000",
        "101 False 3b01e80300000000",
        "201 False 0100000000000000",
        "[('main', 500000)] ('AAA', 'BBB')",
    ]


LOG = """(0.0) can0 101#2f007d0000000000
(0.1) can0 101#3b01e80300000000
(0.2) can0 101#3c02e80300000000
(0.3) can0 101#%02x03e80300000000
"""
"""Two frames as they are sent, one with a wrong checksum, and one more."""


def test_its_logs_are_decoded_and_converted_with_that_checksum(project: Path) -> None:
    assert run(project, DBCSPEC, "generate").returncode == 0
    log = project / "drive.log"
    log.write_text(LOG % crc(J1850, bytes.fromhex("03e80300000000")), "ascii")
    arguments = ("--protocol", "acme._generated")
    decoded = run(project, TYPEDCAN, *arguments, "decode", "drive.log")
    assert decoded.returncode == 0, decoded.stderr
    assert "frames 4, decoded 3, unknown 0" in decoded.stderr
    assert "(length 0, checksum 1, counter 1)" in decoded.stderr
    wrong = crc(J1850, bytes.fromhex("02e80300000000"))
    assert f"checksum is 0x3C, the bytes make 0x{wrong:02X}" in decoded.stdout
    output = ("--messages", "A_STATUS", "-o", "drive.parquet")
    converted = run(project, TYPEDCAN, *arguments, "convert", "drive.log", *output)
    assert converted.returncode == 0, converted.stderr
    assert "wrong checksum: A_STATUS 1" in converted.stderr
    assert "wrong counter: A_STATUS 1" in converted.stderr
    table = pq.read_table(project / "drive.parquet")
    assert table.column("A_STATUS_CNT").to_pylist() == [0, 1, 3]


def test_the_spec_that_is_written_of_its_matrix_has_the_checksum_too(project: Path) -> None:
    exported = run(project, DBCSPEC, "matrix", "export", "--output", "acme.xlsx")
    assert exported.returncode == 0, exported.stderr
    imported = run(project, DBCSPEC, "import", "acme.xlsx", "--out", "again")
    assert imported.returncode == 0, imported.stderr
    behaviour = (project / "again" / "behaviour.yaml").read_text("utf-8")
    assert '{signal: A_STATUS_CRC, algorithm: CRC-8/SAE-J1850, bytes: "1~7"}' in behaviour
    compared = run(project, DBCSPEC, "compare", "spec", "again", "--json").stdout
    assert '"wire": 1,' in compared  # a matrix has no transfers
    assert '"message-checksum-same"' not in compared
    assert '"message-counter-same"' not in compared


NODES = (
    WITHOUT
    + """
import can
from acme._generated.protocol import PROTOCOL
from typedcan.node.node import Node
from typedcan.transfer import Text, split

with can.Bus("serial", "virtual") as near, can.Bus("serial", "virtual") as far, \\
        can.Bus("serial", "virtual") as wire, \\
        Node(PROTOCOL, "AAA", near) as a, Node(PROTOCOL, "BBB", far) as b:
    found = []
    b.on(Text, found.append)
    a.set(*split(PROTOCOL.transfer("serial"), "A1-9"), period=0.1)
    frames = 0
    while not found and frames < 100:
        frame = wire.recv(5)
        frames += 1
        print(f"{frame.arbitration_id:X}", frame.data.hex())
    print(found[0].transfer, found[0].text)
"""
)


def test_its_transfer_is_put_together_live_and_in_columns(project: Path) -> None:
    assert run(project, DBCSPEC, "generate").returncode == 0
    done = run(project, NODES)
    assert done.returncode == 0, done.stderr
    *frames, told = done.stdout.splitlines()
    # Two characters a frame, and twice the same before it counts: it is sent again and again.
    assert frames[:4] == ["102 0141310000000000", "102 022d390000000000"] * 2
    assert told == "serial A1-9"
    lines = [frame.replace(" ", "#") for frame in frames[:4]]
    log = "".join(f"({n / 10}) can0 {line}\n" for n, line in enumerate(lines))
    (project / "drive.log").write_text(log, "ascii")
    arguments = ("--protocol", "acme._generated")
    converted = run(project, TYPEDCAN, *arguments, "convert", "drive.log", "-o", "drive")
    assert converted.returncode == 0, converted.stderr
    [row] = pq.read_table(project / "drive" / "serial.parquet").to_pylist()
    assert (row["timestamp"], row["text"]) == (0.3, "A1-9")


WATCHED = (
    WITHOUT
    + """
import queue
import can
from acme._generated.messages import A_STATUS
from acme._generated.protocol import PROTOCOL
from typedcan.node.node import Node
from typedcan.supervise import NotSeen, StateChanged
from typedcan.wire.link import Fault

with can.Bus("watched", "virtual") as near, can.Bus("watched", "virtual") as far, \\
        can.Bus("watched", "virtual") as third, Node(PROTOCOL, "BBB", far) as b:
    told = queue.SimpleQueue()
    for kind in (StateChanged, Fault):
        b.on(kind, told.put)
    with Node(PROTOCOL, "AAA", near) as a:
        a.set(A_STATUS(speed=12.5))
        print(told.get(timeout=10))
        frames = [third.recv(5) for _ in range(20)]
        third.send(can.Message(arbitration_id=0x101, is_extended_id=False, data=bytes(8)))
        print(told.get(timeout=10))
        print(b.last(A_STATUS).message.speed)
    print(told.get(timeout=10), told.get(timeout=10), sep="; ")
spans = [later.timestamp - frame.timestamp for frame, later in zip(frames, frames[1:])]
print(0.08 < sorted(spans)[10] < 0.12)
"""
)


def test_nodes_send_its_messages_periodically_and_supervise_them(project: Path) -> None:
    assert run(project, DBCSPEC, "generate").returncode == 0
    done = run(project, WATCHED)
    assert done.returncode == 0, done.stderr
    alive, wrong, speed, lost, regular = done.stdout.splitlines()
    assert "A_STATUS" in alive
    assert "alive" in alive
    assert wrong == "A_STATUS: checksum is 0x00, the bytes make 0x0A"  # CRC of seven 0, by hand
    assert (speed, regular) == ("12.5", "True")
    assert "late" in lost
    assert "lost" in lost
