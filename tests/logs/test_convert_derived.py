"""Further tables, made of the decoded blocks beside the usual ones."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
from logs.table_logs import START, traffic, write_frames

from swapcan.logs import convert_logs
from typedcan.logs.columns import DecodedBlock
from typedcan.logs.pipeline import Options
from typedcan.logs.protocol import Protocol
from typedcan.logs.shapes import Batch, Shape


class _Busiest(Shape):
    """The number of messages in each block, and at the end of the log their sum."""

    def __init__(self) -> None:
        self._sum = 0

    @property
    def schemas(self) -> Mapping[str, pa.Schema]:
        """One column."""
        return {"busy": pa.schema({"frames": pa.int64()})}

    def take(self, decoded: DecodedBlock) -> Iterator[Batch]:
        """A row per block."""
        frames = sum(map(len, decoded.messages.values()))
        self._sum += frames
        yield "busy", pa.RecordBatch.from_pydict({"frames": [frames]}, self.schemas["busy"])

    def finish(self) -> Iterator[Batch]:
        """The last row."""
        yield "busy", pa.RecordBatch.from_pydict({"frames": [self._sum]}, self.schemas["busy"])


def _busiest(protocol: Protocol) -> Shape:
    assert protocol.messages
    return _Busiest()


def test_a_derived_table_stands_beside_the_others(tmp_path: Path) -> None:
    logs = [write_frames(tmp_path / f"{n}.log", traffic(3, START + 10 * n)) for n in range(2)]
    options = Options(messages=("B2V_ST2",), derived=(_busiest,))
    _, summary = convert_logs(logs, tmp_path / "out.parquet", options, jobs=1)
    assert {path.stem for path in (tmp_path / "out").iterdir()} == {"B2V_ST2", "busy"}
    # Two logs, each with one block and the end.
    found = pq.read_table(tmp_path / "out" / "busy.parquet").column("frames").to_pylist()
    assert found == [30] * 4
    assert summary.rows == {"B2V_ST2": 60, "busy": 4}
