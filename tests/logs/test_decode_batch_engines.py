"""`decode_batch` unchanged beside DuckDB and inside Dask, where these are installed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from logs.table_logs import traffic, write_frames

from swapcan.logs import decode_batch, frame_batches, schemas, tables


@pytest.fixture(scope="module")
def lake(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, pa.Table]:
    """A Parquet file of bare frames, as a fleet stores them, and what they decode to."""
    folder = tmp_path_factory.mktemp("engines")
    log = write_frames(folder / "drive.blf", traffic(8))
    frames = pa.Table.from_batches(list(frame_batches(log)))
    pq.write_table(frames, folder / "frames.parquet", row_group_size=200)
    return folder / "frames.parquet", tables(log)["B2V_ST2"]


def test_duckdb_reads_frames_hands_them_over_and_queries_what_they_decode_to(
    lake: tuple[Path, pa.Table],
) -> None:
    duckdb: Any = pytest.importorskip("duckdb", reason="the engine duckdb is not installed")
    path, expected = lake
    with duckdb.connect() as connection:
        asked = connection.sql(
            "select * from read_parquet(?) order by timestamp", params=[str(path)]
        )
        frames = asked.to_arrow_reader(100)
        decoded = (decode_batch(batch, messages=("B2V_ST2",)) for batch in frames)
        batches = [each["B2V_ST2"] for each in decoded if each]
        reader = pa.RecordBatchReader.from_batches(schemas()["B2V_ST2"], batches)
        connection.register("st2", reader)
        found = connection.execute(
            'select count(*), avg("B2V_ST2_SOC"), max("B2V_ST2_Current") from st2'
        ).fetchone()
    soc = [value for value in expected.column("B2V_ST2_SOC").to_pylist() if value is not None]
    current = expected.column("B2V_ST2_Current").to_pylist()
    assert found[0] == expected.num_rows
    assert found[1] == pytest.approx(sum(soc) / len(soc))
    assert found[2] == max(value for value in current if value is not None)


def test_dask_decodes_the_pieces_of_a_log_in_its_threads(lake: tuple[Path, pa.Table]) -> None:
    bag: Any = pytest.importorskip("dask.bag", reason="the engine dask is not installed")
    path, expected = lake
    pieces = pq.read_table(path).to_batches(150)
    decoded = bag.from_sequence(pieces, npartitions=4).map(decode_batch)
    found = decoded.compute(scheduler="threads")
    batches = [each["B2V_ST2"] for each in found if "B2V_ST2" in each]
    assert len(batches) > 4
    assert pa.Table.from_batches(batches).to_pydict() == expected.to_pydict()
