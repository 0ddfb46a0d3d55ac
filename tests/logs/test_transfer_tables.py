"""Texts and numbered blocks of a log as tables: in memory, in files, and by the command line."""

from __future__ import annotations

import csv
import json
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any, get_args

import can
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from transfer.rack import project, rack, write

from dbcspec.cli import run as dbcspec
from swapcan.logs import tables as own_tables
from swapcan.messages import Manufacturer
from swapcan.transfer import split_pack_code, split_vin
from swapcan.wire import Codec as OwnCodec
from typedcan.__main__ import main as typedcan
from typedcan.logs.convert import convert_logs, tables
from typedcan.logs.pipeline import Options
from typedcan.logs.protocol import known
from typedcan.logs.summary import _TRANSFERS
from typedcan.logs.transfers.tables import TransferTables
from typedcan.model.transfers.kind import ProblemKind
from typedcan.transfer import Blocks, Text, split
from typedcan.wire.codec import Codec
from typedcan.wire.message import Message

ALL = Options(derived=(TransferTables,))
CODEC = Codec(rack())
VALUES: dict[str, Any] = {
    "name": "电池架 1",
    "serial": Text("serial", "A1B2C3", {"maker": 2}),
    "heats": {0: [20.0] * 4, 1: [30.0] * 3, 2: [40.0] * 2},
    "key": Blocks("key", tuple(range(8)), {"id": 7}),
    "curve": [1.0, 2.0, 3.5, -100.0, 500.0],
}


def frames(codec: Codec, messages: list[Message], begin: float = 0.0) -> list[can.Message]:
    """Frames 10 ms apart."""
    return [
        can.Message(
            timestamp=1_700_000_000.0 + begin + n / 100,
            arbitration_id=type(message).FRAME_ID,
            is_extended_id=type(message).EXTENDED,
            data=codec.encode(message),
        )
        for n, message in enumerate(messages)
    ]


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """Every value twice."""
    messages = [m for name, value in VALUES.items() for m in split(rack().transfer(name), value)]
    path = tmp_path / "drive.blf"
    with can.Logger(path) as logger:
        for frame in (*frames(CODEC, messages), *frames(CODEC, messages, 0.2)):
            logger.on_message_received(frame)
    return path


def test_values_are_rows_with_the_time_at_which_they_were_complete(
    log: Path, tmp_path: Path
) -> None:
    target, summary = convert_logs([log], tmp_path / "out.parquet", ALL, own=known(rack().model))
    found = {path.stem: pq.read_table(path) for path in target.path.iterdir()}
    assert found["name_complete"].column("text").to_pylist() == ["电池架 1"]
    serial = found["serial"].to_pylist()
    assert [(row["text"], row["Serial_Maker"]) for row in serial] == [("A1B2C3", 2)] * 2
    assert found["serial"].column("timestamp").to_pylist() == pytest.approx(
        [1_700_000_000.04, 1_700_000_000.24], abs=1e-5
    )
    assert found["key_complete"].column("data").to_pylist() == [bytes(range(8))] * 2
    assert found["key_complete"].column("Key_Id").to_pylist() == [7, 7]
    assert (
        found["curve_complete"].column("values").to_pylist() == [[1.0, 2.0, 3.5, -100.0, 500.0]] * 2
    )
    assert summary.rows["serial"] == 2
    assert found["heats_1x4_1x3_1x2"].num_rows == 2


def test_what_is_wrong_with_them_is_counted_and_said(tmp_path: Path) -> None:
    messages = {
        name: [*split(rack().transfer(name), VALUES[name])] for name in ("serial", "key", "heats")
    }
    first: Any = messages["key"][0]
    odd = replace(first, block=3)  # it has two
    sent = frames(CODEC, messages["serial"][:1])  # its second message never comes
    sent += frames(CODEC, [odd, odd], 0.1)
    sent += frames(CODEC, messages["heats"][:-1], 0.2)
    sent += frames(CODEC, messages["key"], 60.0)
    logs = [tmp_path / "first.blf", tmp_path / "second.blf"]
    for path in logs:
        with can.Logger(path) as logger:
            for frame in sent:
                logger.on_message_received(frame)
                frame.timestamp += 100
    _, summary = convert_logs(logs, tmp_path / "out", ALL, own=known(rack().model), jobs=1)
    assert summary.as_json()["transfers"] == {
        "serial": {"timeout": 2},
        "key": {"number": 4},
        "heats": {"timeout": 2},
    }
    assert [line for line in summary.lines() if "transfers" in line] == [
        "transfers not complete in time: serial 2, heats 2",
        "transfers with a wrong number: key 4",
    ]
    assert len({*_TRANSFERS}) == len(get_args(ProblemKind))


def test_columns_say_what_they_are(log: Path) -> None:
    protocol = known(rack().model)
    schema = TransferTables(protocol).schemas["serial"]
    assert schema.names == ["timestamp", "channel", "text", "Serial_Maker"]
    assert schema.field("text").type == pa.string()
    metadata = schema.field("Serial_Maker").metadata or {}
    assert metadata[b"signal"] == b"Serial_Maker"
    assert json.loads(metadata[b"labels"])["2"] == "South"
    assert (schema.metadata or {})[b"message"] == b"SERIAL_1, SERIAL_2"


def test_csv_has_bytes_in_hexadecimal_and_numbers_in_brackets(log: Path, tmp_path: Path) -> None:
    target, _ = convert_logs([log], tmp_path / "out.csv", ALL, own=known(rack().model))

    def rows(name: str) -> list[dict[str, str]]:
        with (target.path / f"{name}.csv").open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    assert [row["data"] for row in rows("key_complete")] == ["0001020304050607"] * 2
    assert json.loads(rows("curve_complete")[0]["values"]) == [1.0, 2.0, 3.5, -100.0, 500.0]


def test_mf4_has_them_as_texts_of_a_fixed_length(log: Path, tmp_path: Path) -> None:
    asammdf: Any = pytest.importorskip("asammdf", reason="asammdf is an extra of its own")
    target, _ = convert_logs([log], tmp_path / "out.mf4", ALL, own=known(rack().model))
    with asammdf.MDF(target.path) as measured:
        groups = {each.channel_group.acq_name: n for n, each in enumerate(measured.groups)}
        texts = measured.get("text", group=groups["name_complete"]).samples.tolist()
        data = measured.get("data", group=groups["key_complete"]).samples.tolist()
    assert texts == ["电池架 1".encode()]
    assert data == [b"0001020304050607"] * 2


def test_what_is_known_of_transfers_can_be_handed_to_other_processes(log: Path) -> None:
    own = known(rack().model)
    handed = pickle.loads(pickle.dumps(own))
    found, again = (tables(log, options=ALL, own=each) for each in (own, handed))
    assert found == again
    assert found["serial"].num_rows == 2


def test_a_detail_called_like_a_column_gets_a_name_of_its_own() -> None:
    model = project().protocol
    messages = tuple(
        replace(
            message,
            signals=tuple(
                replace(each, name="text") if each.name == "Serial_Maker" else each
                for each in message.signals
            ),
        )
        for message in model.messages
    )
    transfers = tuple(
        replace(each, details=("text",)) if each.name == "serial" else each
        for each in model.transfers
    )
    protocol = known(replace(model, messages=messages, transfers=transfers))
    schema = TransferTables(protocol).schemas["serial"]
    assert schema.names == ["timestamp", "channel", "text", "text_"]


def test_the_command_line_writes_them_for_any_package(
    log: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = write(tmp_path / "rack_project")
    monkeypatch.chdir(folder)
    assert dbcspec(["lint"]) == 0
    assert dbcspec(["generate"]) == 0
    output = tmp_path / "columns"
    package = str(folder / "rack" / "_generated")
    monkeypatch.setattr(
        "sys.argv",
        ["typedcan", "--protocol", package, "convert", str(log), "-o", str(output)],
    )
    assert typedcan() == 0
    assert pq.read_table(output / "serial.parquet").column("text").to_pylist() == ["A1B2C3"] * 2


def test_the_vin_and_the_pack_code_of_this_standard_have_tables(tmp_path: Path) -> None:
    code = "001PB0A1234567890123ABCD"
    messages: list[Message] = [*split_vin("LSVAA4187E2184847")]
    messages += [*split_pack_code(code, Manufacturer.CATL)] * 2
    path = tmp_path / "drive.blf"
    with can.Logger(path) as logger:
        for frame in frames(OwnCodec(), messages):
            logger.on_message_received(frame)
    found = own_tables(path, options=ALL)
    assert found["vin"].column("text").to_pylist() == ["LSVAA4187E2184847"]
    [row] = found["pack_code"].to_pylist()
    assert (row["text"], row["B2V_SC1_Manufacturer"]) == (code, int(Manufacturer.CATL))
