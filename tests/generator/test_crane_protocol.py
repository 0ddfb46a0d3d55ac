"""A protocol with CAN FD, branches in branches, floats and 64-bit integers: YAML to columns.

The spec is linted, generated from, imported, sent, received and converted; cantools says of every
payload what is right.
"""

from __future__ import annotations

import importlib
import math
import random
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import can
import cantools.database
import pyarrow.parquet as pq
import pytest
from cantools.database.can import Database

from typedcan.wire.codec import Codec
from typedcan.wire.errors import EncodeError
from typedcan.wire.link import Link
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

CRANE = Path(__file__).parent.parent / "fixtures" / "crane"
WITHOUT = "import sys; sys.modules['swapcan'] = None\n"
DBCSPEC = WITHOUT + "from dbcspec.cli import run; sys.exit(run(sys.argv[1:]))"
TYPEDCAN = WITHOUT + "from typedcan.__main__ import main; sys.exit(main())"
PAYLOADS = 60


def run(folder: Path, program: str, *arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The project, linted and generated."""
    made = tmp_path_factory.mktemp("crane") / "crane"
    shutil.copytree(CRANE, made)
    assert "no findings" in run(made, DBCSPEC, "lint")
    run(made, DBCSPEC, "generate")
    return made


@pytest.fixture(scope="module")
def protocol(folder: Path) -> Iterator[Protocol]:
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder))
        yield importlib.import_module("crane._generated.protocol").PROTOCOL
    for name in [name for name in sys.modules if name.split(".")[0] == "crane"]:
        del sys.modules[name]


@pytest.fixture(scope="module")
def theirs(folder: Path) -> Database:
    database = cantools.database.load_file(folder / "dbc" / "crane.dbc")
    assert isinstance(database, Database)
    return database


def payloads(kind: type[Message]) -> list[bytes]:
    """Random payloads, with pages and parts of which most mean something."""
    source = random.Random(kind.NAME)
    found = [bytes(kind.LENGTH), *(source.randbytes(kind.LENGTH) for _ in range(PAYLOADS))]
    if kind.NAME != "HOIST_SERVICE":
        return found
    return [bytes((at % 5, at // 5 % 5)) + each[2:] for at, each in enumerate(found)]


def decoded_by_cantools(theirs: Database, kind: type[Message], data: bytes) -> dict[str, Any]:
    """Its values; of a page or part that selects nothing those that are there all the same."""
    message = theirs.get_message_by_name(kind.NAME)
    try:
        values: Any = message.decode(data, decode_choices=False)
    except cantools.database.DecodeError:
        values = {"HOIST_SERVICE_Page": data[0] & 0xF, "HOIST_SERVICE_Known": data[19]}
        if data[0] & 0xF in (1, 2):
            values["HOIST_SERVICE_Part"] = data[1]
    return dict(values)


def same(value: Any, expected: Any) -> bool:
    if isinstance(expected, float) and math.isnan(expected):
        return isinstance(value, float) and math.isnan(value)
    return bool(value == expected)


NAMES = ["HOIST_STATE", "HOIST_SERVICE", "CAB_CMD", "SLEW_LOG", "WAKE"]


@pytest.mark.parametrize("name", NAMES)
def test_every_payload_decodes_as_cantools_has_it_and_encodes_back(
    name: str, protocol: Protocol, theirs: Database
) -> None:
    kind, codec, sent = protocol.message(name), Codec(protocol), 0
    reasons: set[str] = set()
    for data in payloads(kind):
        message = codec.decode(kind.FRAME_ID, data, verify=False)
        expected = decoded_by_cantools(theirs, kind, data)
        for field in kind.FIELDS.values():
            value = getattr(message, field.name)
            if str(value) == "Signal Invalid":
                value = 3
            assert (value is None) == (field.dbc_name not in expected)
            assert value is None or same(value, expected[field.dbc_name])
        try:
            again = codec.encode(message)
        except EncodeError as error:
            reasons.add(error.problem.partition("is ")[2][:12])
            continue
        sent += 1
        assert codec.decode(kind.FRAME_ID, again, verify=False) == message
    assert sent
    assert reasons <= {"out of range", "not a finite"}


def test_its_frames_are_of_two_formats_and_come_in_as_they_went_out(
    protocol: Protocol, near: can.BusABC, far: can.BusABC
) -> None:
    made: dict[str, Any] = {kind.NAME: kind for kind in protocol.messages}
    messages = [
        made["HOIST_STATE"](runtime=(1 << 56) - 1, serial=(1 << 64) - 1, height=(1 << 60) * 10 + 5),
        made["HOIST_SERVICE"](page=1, part=2, wear=12.5, hours=(1 << 63) + 1),
        made["CAB_CMD"](speed=-3.5),
        made["SLEW_LOG"](time=(1 << 64) - 3, first=-359.5, last=0.0000001),
        made["WAKE"](),
    ]
    codec = Codec(protocol)
    sender, receiver = Link(near, codec), Link(far, codec)
    for message in messages:
        frame = sender.send(message)
        received = receiver.receive(timeout=1.0)
        assert received.faults == ()
        assert type(received.message) is type(message)
        if message.NAME != "CAB_CMD":
            assert received.message == message
        assert (frame.is_fd, frame.bitrate_switch, len(frame.data), frame.is_extended_id) == {
            "HOIST_STATE": (True, True, 48, False),
            "HOIST_SERVICE": (True, False, 20, False),
            "CAB_CMD": (False, False, 8, False),
            "SLEW_LOG": (True, True, 64, True),
            "WAKE": (False, False, 0, False),
        }[message.NAME]
    assert receiver.counts.received == len(messages)


def sealed(protocol: Protocol, kind: type[Message], data: bytes) -> bytes:
    """The payload with its checksum, if it has one, so that nobody refuses the frame."""
    codec = Codec(protocol)
    message = codec.decode(kind.FRAME_ID, data, verify=False)
    return codec.encode(message, renew=True) if kind.CHECKSUM else data


def test_its_logs_become_columns_with_the_values_of_cantools(
    folder: Path, protocol: Protocol, theirs: Database
) -> None:
    lines: list[str] = []
    expected: dict[str, list[dict[str, Any]]] = {}
    for kind in protocol.messages:
        model = kind.MODEL
        frames = [sealed(protocol, kind, data) for data in payloads(kind)]
        expected[kind.NAME] = [decoded_by_cantools(theirs, kind, data) for data in frames]
        for data in frames:
            digits = f"{kind.FRAME_ID:08X}" if kind.EXTENDED else f"{kind.FRAME_ID:03X}"
            mark = f"##{int(model.bit_rate_switch)}" if model.is_fd else "#"
            lines.append(f"({len(lines) / 1000:.6f}) can0 {digits}{mark}{data.hex()}\n")
    (folder / "drive.log").write_text("".join(lines))
    arguments = ("--protocol", "crane._generated", "convert", "drive.log", "-o", "drive")
    said = run(folder, TYPEDCAN, *arguments)
    assert "selector without a branch: HOIST_SERVICE" in said
    for name, rows in expected.items():
        table = pq.read_table(folder / "drive" / f"{name}.parquet")
        assert table.num_rows == len(rows)
        for column in table.column_names[2:]:
            if column.endswith(".state"):
                continue
            for value, row in zip(table[column].to_pylist(), rows, strict=True):
                wanted = row.get(column)
                if column == "HOIST_STATE_Brake" and wanted == 3:
                    wanted = None
                number = int(value) if isinstance(value, str) else value  # over 64 bits: digits
                assert (number is None) == (wanted is None)
                assert number is None or same(number, wanted), (name, column)


@pytest.mark.parametrize("other", ["dbc/crane.dbc", "crane.xlsx", "again"])
def test_what_is_written_of_it_says_the_same_on_the_wire(other: str, folder: Path) -> None:
    if other == "crane.xlsx":
        run(folder, DBCSPEC, "matrix", "export", "--output", other)
    if other == "again":
        run(folder, DBCSPEC, "matrix", "export", "--output", "again.xlsx")
        run(folder, DBCSPEC, "import", "again.xlsx", "--out", other)
    run(folder, DBCSPEC, "compare", "spec", other, "--fail-on", "wire")
