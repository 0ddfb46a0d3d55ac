"""Logs of this standard to tables: what `swapcan.logs` has, with its protocol set."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa

from swapcan.log_protocol import OWN
from typedcan.logs import batch as batches
from typedcan.logs import convert
from typedcan.logs.checksums import NONE
from typedcan.logs.pipeline import Options, Watch
from typedcan.logs.plan import Mode
from typedcan.logs.summary import Summary
from typedcan.logs.write.target import Target
from typedcan.model.checksums.registry import Given


def convert_logs(
    logs: Sequence[Path],
    output: Path,
    options: Options | None = None,
    *,
    jobs: int | None = None,
    force: bool = False,
    watch: Watch | None = None,
) -> tuple[Target, Summary]:
    """Convert logs to files of tables; see `typedcan.logs.convert.convert_logs`."""
    return convert.convert_logs(logs, output, options, own=OWN, jobs=jobs, force=force, watch=watch)


def tables(*logs: Path | str, options: Options | None = None) -> dict[str, pa.Table]:
    """The tables of logs in memory, by name; see `typedcan.logs.convert.tables`."""
    return convert.tables(*logs, options=options, own=OWN)


def decode_batch(
    batch: pa.RecordBatch,
    *,
    dbc: Path | str | None = None,
    messages: Sequence[str] = (),
    signals: Sequence[str] = (),
    mode: Mode = Mode.PHYSICAL,
    plain: bool = False,
    keep_faulty: bool = False,
    algorithms: Given = NONE,
) -> dict[str, pa.RecordBatch]:
    """Decode frames; see `typedcan.logs.batch.decode_batch`."""
    return batches.decode_batch(
        batch,
        own=OWN,
        dbc=dbc,
        messages=messages,
        signals=signals,
        mode=mode,
        plain=plain,
        keep_faulty=keep_faulty,
        algorithms=algorithms,
    )


def schemas(
    *,
    dbc: Path | str | None = None,
    messages: Sequence[str] = (),
    signals: Sequence[str] = (),
    mode: Mode = Mode.PHYSICAL,
    plain: bool = False,
) -> dict[str, pa.Schema]:
    """What `decode_batch` gives for the same arguments; see `typedcan.logs.batch.schemas`."""
    return batches.schemas(
        own=OWN, dbc=dbc, messages=messages, signals=signals, mode=mode, plain=plain
    )
