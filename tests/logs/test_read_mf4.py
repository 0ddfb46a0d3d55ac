"""MF4 bus logs give the frames that python-can gives, ordered by their times."""

from __future__ import annotations

import os
import random
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from logs.log_files import Row, mixed_frames, row_of, rows_by_python_can, rows_in, write_log
from numpy.typing import NDArray

from typedcan.logs.read.mf4 import Mf4Source
from typedcan.logs.read.source import Damage

asammdf = pytest.importorskip("asammdf", reason="the extra mf4 is not installed")

LOGGED = 2**31  # a time that python-can's writer keeps as it is, because it lies in the future


def read(path: Path, block_size: int = 1000) -> tuple[list[Row], Damage | None]:
    with Mf4Source(path, block_size) as source:
        return rows_in(source), source.damage


def rows(path: Path, block_size: int = 1000) -> list[Row]:
    """What Mf4Source gives for a sound log."""
    with Mf4Source(path, block_size) as source:
        found = rows_in(source)
        assert source.damage is None
        assert source.position == source.size
    return found


def grouped_log(path: Path, groups: list[dict[str, NDArray[Any]]], kind: str) -> Path:
    """A log with these channel groups, each of columns and their ``time``, by asammdf."""
    source = asammdf.Source(
        source_type=asammdf.Source.SOURCE_BUS,
        bus_type=asammdf.Source.BUS_TYPE_CAN,
        name="",
        path="",
        comment="",
    )
    with asammdf.MDF(version="4.10") as mdf:
        for columns in groups:
            names = [name for name in columns if name != "time"]
            record = [
                (f"{kind}.{name}", columns[name].dtype, columns[name].shape[1:]) for name in names
            ]
            samples = np.zeros(len(columns["time"]), record)
            for name in names:
                samples[f"{kind}.{name}"] = columns[name]
            mdf.append(
                asammdf.Signal(samples, columns["time"], name=kind, source=source, comment="")
            )
        mdf.save(path, overwrite=True)
    return path


def columns_of(times: list[float], first_id: int, **more: NDArray[Any]) -> dict[str, NDArray[Any]]:
    count = len(times)
    return {
        "time": np.array(times, float),
        "ID": np.arange(first_id, first_id + count, dtype="<u4"),
        "DataLength": np.full(count, 2, np.uint8),
        "DataBytes": np.full((count, 8), 7, np.uint8),
        **more,
    }


@pytest.mark.parametrize("compression", [0, 1, 2])
def test_logs_of_python_can_are_read_as_it_reads_them(tmp_path: Path, compression: int) -> None:
    frames = mixed_frames(1500, start=LOGGED)
    path = write_log(tmp_path / "bus.mf4", frames, compression_level=compression)
    found = rows(path)
    assert found == rows_by_python_can(path)
    assert [row[1:] for row in found] == [row_of(frame)[1:] for frame in frames]


def test_an_empty_log_has_no_blocks(tmp_path: Path) -> None:
    assert rows(write_log(tmp_path / "bus.mf4", [])) == []


def test_a_file_without_frames_has_no_blocks(tmp_path: Path) -> None:
    path = tmp_path / "measured.mf4"
    with asammdf.MDF(version="4.10") as mdf:
        mdf.append(asammdf.Signal(np.arange(5), np.arange(5.0), name="speed"))
        mdf.save(path)
    assert rows(path) == []


def test_fields_that_are_missing_are_what_python_can_takes_them_for(tmp_path: Path) -> None:
    path = grouped_log(tmp_path / "bus.mf4", [columns_of([0.0, 1.0], 5)], "CAN_DataFrame")
    assert rows(path) == rows_by_python_can(path)
    assert [row[1:] for row in rows(path)] == [(5, 1, None, 2, b"\7\7"), (6, 1, None, 2, b"\7\7")]


def test_directions_may_be_words(tmp_path: Path) -> None:
    columns = columns_of([0.0, 1.0], 5, Dir=np.array([b"Rx", b"Tx"]))
    path = grouped_log(tmp_path / "bus.mf4", [columns], "CAN_DataFrame")
    assert rows(path) == rows_by_python_can(path)
    assert [row[2] & 64 for row in rows(path)] == [0, 64]


@pytest.mark.parametrize("kind", ["CAN_ErrorFrame", "CAN_RemoteFrame"])
def test_error_and_remote_frames_with_few_fields(tmp_path: Path, kind: str) -> None:
    more = {"RTR": np.array([0, 1], np.uint8), "DLC": np.array([3, 8], np.uint8)}
    columns = columns_of([0.0, 1.0], 0x9000_0005, **more)
    path = grouped_log(tmp_path / "bus.mf4", [columns], kind)
    assert rows(path) == rows_by_python_can(path)


def test_an_error_frame_needs_no_field_at_all(tmp_path: Path) -> None:
    columns: dict[str, NDArray[Any]] = {"time": np.arange(2.0), "IDE": np.zeros(2, np.uint8)}
    path = grouped_log(tmp_path / "bus.mf4", [columns], "CAN_ErrorFrame")
    assert rows(path) == rows_by_python_can(path)


TIMES = st.lists(st.sampled_from([0.0, 1.0, 2.0, 2.5, 3.0]), min_size=1, max_size=12)


@settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(groups=st.lists(TIMES, min_size=1, max_size=4), block_size=st.integers(1, 9))
def test_groups_are_merged_in_the_order_of_python_can(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, groups: list[list[float]], block_size: int
) -> None:
    """Also where times repeat, run backwards, or fall into different chunks."""
    monkeypatch.setattr("typedcan.logs.read.mf4._LEAST_CHUNK", 3)
    monkeypatch.setattr("typedcan.logs.read.mf4._CHUNK_BYTES", 1)
    columns = [
        columns_of(times, 100 * number, BusChannel=np.full(len(times), number, np.uint8))
        for number, times in enumerate(groups)
    ]
    path = grouped_log(tmp_path / "bus.mf4", columns, "CAN_DataFrame")
    assert rows(path, block_size) == rows_by_python_can(path)


def test_memory_is_bounded_by_chunks_and_not_by_the_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[int] = []
    get = asammdf.MDF.get

    def counted(self: Any, *names: Any, **options: Any) -> Any:
        asked.append(options["record_count"])
        return get(self, *names, **options)

    monkeypatch.setattr(asammdf.MDF, "get", counted)
    columns = columns_of(np.arange(1_000_000.0).tolist(), 0)
    path = grouped_log(tmp_path / "bus.mf4", [columns], "CAN_DataFrame")
    with Mf4Source(path) as source:
        assert sum(map(len, source)) == sum(asked) == 1_000_000
    assert max(asked) < 200_000


def test_a_log_that_was_never_finished_is_read_and_left_as_it_is(tmp_path: Path) -> None:
    path = write_log(tmp_path / "bus.mf4", mixed_frames(300, start=LOGGED), compression_level=0)
    expected = rows_by_python_can(path)
    content = bytearray(path.read_bytes())
    content[:8] = b"UnFinMF "
    content[60] = 1  # the counts of records are to be made up
    path.write_bytes(content)
    assert rows(path) == expected
    assert path.read_bytes() == bytes(content)


def test_a_log_without_its_end_is_damage_as_its_index_stands_there(tmp_path: Path) -> None:
    path = write_log(tmp_path / "bus.mf4", mixed_frames(300))
    content = path.read_bytes()
    for place in [*range(70), *random.Random(1).sample(range(len(content)), 30)]:
        path.write_bytes(content[:place])
        found, damage = read(path)
        assert found == []
        assert damage is not None
        assert damage.lost == f"{place:,} bytes"


def test_records_before_damaged_data_are_delivered(tmp_path: Path) -> None:
    columns = columns_of(np.arange(500_000.0).tolist(), 0)
    path = grouped_log(tmp_path / "bus.mf4", [columns], "CAN_DataFrame")
    packed = tmp_path / "packed.mf4"
    with asammdf.MDF(path) as mdf:
        mdf.save(packed, compression=1)
    content = bytearray(packed.read_bytes())
    blocks = [place.start() for place in re.finditer(b"##DZ", content)]
    assert len(blocks) == 3
    content[blocks[2] + 1000] ^= 0xFF
    packed.write_bytes(content)
    with Mf4Source(packed) as source:
        found = np.concatenate([block.frame_id for block in source])
        held = int.from_bytes(content[blocks[0] + 32 : blocks[0] + 40], "little")
        before = 2 * held // 21  # bytes of a record, of which 8 are its time
        assert found.tolist() == list(range(before))
        assert source.damage is not None
        assert source.damage.where == f"record {before} of channel group 0"
        assert source.damage.lost == f"{500_000 - before:,} frames"


def test_blocks_that_lead_back_to_themselves_are_damage(tmp_path: Path) -> None:
    path = write_log(tmp_path / "bus.mf4", mixed_frames(100))
    content = path.read_bytes()
    for kind in (b"##DG", b"##CN", b"##FH"):
        place = content.index(kind)
        circular = bytearray(content)
        circular[place + 24 : place + 32] = place.to_bytes(8, "little")  # the link to the next
        path.write_bytes(circular)
        _, damage = read(path)
        assert damage is not None


FUZZ = """
import random, sys
from pathlib import Path
from logs.log_files import mixed_frames, rows_in, write_log
from typedcan.logs.read.mf4 import Mf4Source
folder = Path(sys.argv[1])
content = write_log(folder / "bus.mf4", mixed_frames(200), compression_level=0).read_bytes()
index = content.index(b"##DG")
noise = random.Random(7)
for _ in range(100):
    spoilt = bytearray(content)
    for _ in range(noise.randrange(1, 4)):
        at = noise.choice([noise.randrange(300), noise.randrange(index, len(content) - 8)])
        size = noise.randrange(1, 9)
        spoilt[at:at + size] = noise.choice([bytes(size), noise.randbytes(size), b"\\xff" * size])
    path = folder / "spoilt.mf4"
    path.write_bytes(spoilt)
    with Mf4Source(path) as source:
        for block in source:
            assert len(block)
print("read")
"""


def test_overwritten_bytes_never_crash_the_reader(tmp_path: Path) -> None:
    """In a process of its own, as asammdf reads the file with code in C."""
    # Where asammdf gives a file up, its own temporary one is left open, and the collector says so.
    strict = ["-W", "error", "-W", "ignore::ResourceWarning"]
    command = [sys.executable, *strict, "-c", FUZZ, str(tmp_path)]
    path = str(Path(__file__).parents[1])
    ran = subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
        cwd=path,
        env={"PYTHONPATH": os.pathsep.join([path, *sys.path])},
    )
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "read\n", "")
