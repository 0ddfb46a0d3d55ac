"""Arrow to Arrow: the same rows as a conversion, whatever types an engine gives the frames."""

from __future__ import annotations

import pickle
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import can
import pyarrow as pa
import pytest
from logs.log_files import mixed_frames, write_log
from logs.table_logs import START, decoded, traffic, write_frames

import swapcan
from swapcan.logs import Mode, Options, decode_batch, frame_batches, schemas, tables
from swapcan.messages import B2V_ST2, MESSAGES
from typedcan.logs.batch import FRAME_SCHEMA, BatchError, DamagedLogError


@pytest.fixture(scope="module")
def frames() -> list[can.Message]:
    return traffic(6)


@pytest.fixture(scope="module")
def log(frames: list[can.Message], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_frames(tmp_path_factory.mktemp("batch") / "drive.blf", frames)


def _batch(frames: list[can.Message], **more: Any) -> pa.RecordBatch:
    """The least that a batch has."""
    columns: dict[str, Any] = {
        "timestamp": [frame.timestamp for frame in frames],
        "frame_id": [frame.arbitration_id for frame in frames],
        "data": [bytes(frame.data) for frame in frames],
    }
    return pa.RecordBatch.from_pydict({**columns, **more})


def test_frames_become_the_values_of_cantools(frames: list[can.Message]) -> None:
    expected = decoded(frames)
    found = decode_batch(_batch(frames))
    assert found.keys() == expected.keys()
    for name, rows in expected.items():
        for part in swapcan.message_type(name).FIELDS.values():
            codes = {code * part.factor + part.offset for code in part.states}
            values = [row[part.dbc_name] for row in rows]
            assert found[name].column(part.dbc_name).to_pylist() == [
                None if value in codes else value for value in values
            ]


@pytest.mark.parametrize("mode", list(Mode))
def test_batches_of_a_log_become_the_tables_of_its_conversion(log: Path, mode: Mode) -> None:
    parts: dict[str, list[pa.RecordBatch]] = {}
    for batch in frame_batches(log, 100):
        for name, found in decode_batch(batch, mode=mode).items():
            parts.setdefault(name, []).append(found)
    expected = tables(log, options=Options(mode=mode))
    assert {n: pa.Table.from_batches(p).to_pydict() for n, p in parts.items()} == {
        name: table.to_pydict() for name, table in expected.items()
    }
    found_schemas = {name: part[0].schema for name, part in parts.items()}
    assert found_schemas == schemas(mode=mode)


@pytest.mark.parametrize("kinds", ["classic", "classic remote error", "classic remote error fd"])
def test_frame_batches_hold_every_frame_of_the_log(tmp_path: Path, kinds: str) -> None:
    log = write_log(tmp_path / "x.blf", mixed_frames(300, kinds=kinds))
    rows = [row for batch in frame_batches(log, 64) for row in batch.to_pylist()]
    with can.LogReader(log) as reader:
        expected = list(reader)
    assert [row["data"] for row in rows] == [bytes(frame.data) for frame in expected]
    assert [row["timestamp"] for row in rows] == [frame.timestamp for frame in expected]
    assert [row["frame_id"] for row in rows] == [frame.arbitration_id for frame in expected]
    assert [row["channel"] for row in rows] == [str(frame.channel) for frame in expected]
    for bit, name in enumerate(("is_extended_id", "is_remote_frame", "is_error_frame", "is_fd")):
        flags = [bool(row["flags"] >> bit & 1) for row in rows]
        assert flags == [getattr(frame, name) for frame in expected]
    assert all(batch.schema == FRAME_SCHEMA for batch in frame_batches(log))


@pytest.mark.parametrize("kind", [pa.int32(), pa.int64(), pa.uint32(), pa.uint64()])
@pytest.mark.parametrize("data", [pa.binary(), pa.large_binary(), pa.binary(8), pa.binary_view()])
def test_any_integer_and_any_binary_type_will_do(
    frames: list[can.Message], kind: pa.DataType, data: pa.DataType
) -> None:
    batch = _batch(frames)
    schema = pa.schema({"timestamp": pa.float64(), "frame_id": kind, "data": data})
    assert decode_batch(batch.cast(schema)) == decode_batch(batch)


def test_a_slice_of_a_batch_is_decoded_like_a_batch_of_its_own(frames: list[can.Message]) -> None:
    assert decode_batch(_batch(frames).slice(37, 200)) == decode_batch(_batch(frames[37:237]))


def test_times_are_handed_on_whatever_they_are(frames: list[can.Message]) -> None:
    own = [frame for frame in frames if frame.arbitration_id == B2V_ST2.FRAME_ID]
    stamps = pa.array([int(f.timestamp * 1e6) for f in own], pa.timestamp("us", "UTC"))
    found = decode_batch(_batch(own, timestamp=stamps))["B2V_ST2"]
    assert found.column("timestamp") == stamps


def test_11_bit_identifiers_remote_and_error_frames_are_no_messages(
    frames: list[can.Message],
) -> None:
    count = len(frames)
    extended = _batch(frames, is_extended=[True] * count)
    assert decode_batch(extended) == decode_batch(_batch(frames))
    assert decode_batch(_batch(frames, is_extended=[False] * count)) == {}
    for flag in (0, 1 | 2, 1 | 4):
        assert decode_batch(_batch(frames, flags=[flag] * count)) == {}
    assert decode_batch(_batch(frames, flags=[1] * count)) == decode_batch(extended)


def test_rows_without_identifier_or_payload_are_passed_over(frames: list[can.Message]) -> None:
    own = [frame for frame in frames if frame.arbitration_id == B2V_ST2.FRAME_ID][:4]
    batch = _batch(
        own,
        frame_id=pa.array([own[0].arbitration_id, None, own[2].arbitration_id, None]),
        data=pa.array([bytes(own[0].data), bytes(8), None, None]),
    )
    found = decode_batch(batch)["B2V_ST2"]
    assert found.column("timestamp").to_pylist() == [own[0].timestamp]


def test_plain_batches_have_neither_dictionaries_nor_unsigned_integers(
    frames: list[can.Message],
) -> None:
    found = decode_batch(_batch(frames), plain=True)
    rich = decode_batch(_batch(frames))
    for name, batch in found.items():
        for part in batch.schema:
            assert not pa.types.is_dictionary(part.type)
            assert not pa.types.is_unsigned_integer(part.type)
        assert batch.to_pydict() == rich[name].to_pydict()
        assert batch.schema == schemas(plain=True)[name]


def test_a_wrong_checksum_is_refused_unless_asked_for() -> None:
    kind = next(message for message in MESSAGES if message.NAME == "V2B_CMD")
    sound = swapcan.encode(kind(), counter=1)
    wrong = bytes([sound[0] ^ 0xFF, *sound[1:]])
    batch = _batch([can.Message(START, kind.FRAME_ID, data=data) for data in (sound, wrong)])
    assert decode_batch(batch)["V2B_CMD"].num_rows == 1
    assert decode_batch(batch, keep_faulty=True)["V2B_CMD"].num_rows == 2


def test_it_runs_in_many_threads_at_once_and_can_be_sent_to_other_processes(
    frames: list[can.Message],
) -> None:
    expected = decode_batch(_batch(frames))
    task = pickle.loads(pickle.dumps(partial(decode_batch, messages=("B2V_ST2",))))
    assert task(_batch(frames)) == {"B2V_ST2": expected["B2V_ST2"]}
    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(decode_batch, [_batch(frames)] * 12))
    assert found == [expected] * 12


@pytest.mark.parametrize(
    ("columns", "text"),
    [
        ({"frame_id": [1], "data": [b""]}, "no column 'timestamp'"),
        ({"timestamp": [0.0], "frame_id": [-1], "data": [b""]}, "no frames"),
        ({"timestamp": [0.0], "frame_id": ["x"], "data": [b""]}, "no frames"),
        ({"timestamp": [0.0], "frame_id": [1], "data": [bytes(65)]}, "65 bytes"),
    ],
)
def test_a_batch_that_holds_no_frames_is_an_error(columns: dict[str, list[Any]], text: str) -> None:
    with pytest.raises(BatchError, match=text):
        decode_batch(pa.RecordBatch.from_pydict(columns))


def test_an_empty_batch_decodes_to_nothing() -> None:
    assert decode_batch(pa.RecordBatch.from_pylist([], schema=FRAME_SCHEMA)) == {}


def test_a_damaged_log_gives_all_frames_before_the_damage(log: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.log"
    write_frames(cut, traffic(1))
    whole = cut.read_bytes()
    lines = whole.count(b"\n")
    cut.write_bytes(whole + b"(nonsense\n")
    batches = frame_batches(cut, 7)
    rows: list[int] = []
    with pytest.raises(DamagedLogError, match=r"cut\.log") as caught:
        rows.extend(batch.num_rows for batch in batches)
    assert sum(rows) == lines
    assert caught.value.damage.path == cut
