"""Log to Parquet beside its peers, in one run: python tests/benchmarks/convert_logs.py.

Nothing here is asserted. The traffic has all messages of the protocol, each in its period, with
changing values. python-can, cantools and pandas convert the first frames of it only, since they
take them one by one; asammdf extracts the whole MF4 log, without writing anything. Rates are of
wall clock time and, in brackets, of processor time; ratios are medians of rounds in which all take
turns. ``--memory 20`` converts a log of so many million frames and prints the peak of its
memory, on Linux.
"""

from __future__ import annotations

import argparse
import heapq
import math
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from functools import cache, partial
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from itertools import islice
from pathlib import Path
from typing import Any

import can
import cantools
import pandas as pd
from cantools.database.can import Database

import swapcan
from swapcan.logs import convert_logs
from swapcan.messages import MESSAGES
from typedcan.wire.errors import EncodeError
from typedcan.wire.fields import PhysicalField
from typedcan.wire.message import Message

_FEW = 20_000
"""Frames for those who take them one by one."""
_ON_EVENT = 5.0
"""Seconds between two frames of messages without a period."""
_VALUES = 180
"""Payloads of a message until they repeat, about."""
_START = 1_700_000_000.0
_SUFFIXES = (".blf", ".log", ".asc", ".mf4")
_CHILD = """
import sys
from pathlib import Path
from swapcan.logs import convert_logs
print(convert_logs([Path(sys.argv[1])], Path(sys.argv[2]))[1].counts.frames)
print(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0])
"""

Run = tuple[int, Callable[[], object]]
"""A number of frames, and what converts them."""


def main() -> None:
    """Print all benchmarks."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--frames", type=int, default=1_000_000)
    options.add_argument("--rounds", type=int, default=3)
    options.add_argument("--memory", type=int, default=0, metavar="MILLIONS")
    given = options.parse_args()
    packages = ("cantools", "python-can", "pandas", "pyarrow", "numpy")
    print(f"Python {sys.version.split()[0]}", *(f"{name} {version(name)}" for name in packages))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        suffixes = [s for s in _SUFFIXES if s != ".mf4" or find_spec("asammdf")]
        whole = _write(folder / "whole", given.frames, suffixes)
        few = _write(folder / "few", min(_FEW, given.frames), suffixes)
        for suffix in suffixes:
            print(f"\n{suffix}, {given.frames:,} frames, {whole[suffix].stat().st_size:,} bytes")
            runs: dict[str, Run] = {
                "python-can, cantools, pandas": (_FEW, partial(_one_by_one, few[suffix], folder)),
                "swapcan": (given.frames, partial(_ours, whole[suffix], folder)),
            }
            if suffix == ".mf4":
                runs[f"asammdf {version('asammdf')}, extraction alone"] = (
                    given.frames,
                    _asammdf(whole[suffix], folder),
                )
            _compare(runs, given.rounds)
        for suffix in suffixes[:2] if given.memory else ():
            _memory(whole[suffix], given.memory * 1_000_000 // given.frames, folder)


def _write(name: Path, frames: int, suffixes: list[str]) -> dict[str, Path]:
    paths = {suffix: name.with_suffix(suffix) for suffix in suffixes}
    with ExitStack() as stack:
        loggers = [stack.enter_context(can.Logger(path)) for path in paths.values()]
        for frame in islice(_traffic(), frames):
            for logger in loggers:
                logger.on_message_received(frame)
    return paths


def _traffic() -> Iterator[can.Message]:
    """The frames of a pack and a truck, for ever."""
    noise = random.Random(1)
    payloads = [_payloads(kind) for kind in MESSAGES]
    due = [((kind.PERIOD or _ON_EVENT) * noise.random(), n, 0) for n, kind in enumerate(MESSAGES)]
    heapq.heapify(due)
    while True:
        at, number, count = due[0]
        kind, own = MESSAGES[number], payloads[number]
        yield can.Message(
            round(_START + at, 6), kind.FRAME_ID, data=own[count % len(own)], channel=1
        )
        period = (kind.PERIOD or _ON_EVENT) * (1 + 0.02 * (noise.random() - 0.5))
        heapq.heapreplace(due, (at + period, number, count + 1))


def _payloads(kind: type[Message]) -> list[bytes]:
    """Payloads with slowly changing values and a running counter."""
    modulus = kind.COUNTER.modulus if kind.COUNTER else 1
    safe: Any = {part.name: part.acting.safe for part in kind.FIELDS.values() if part.acting}
    payloads: list[bytes] = []
    for count in range(modulus * max(1, _VALUES // modulus)):
        swing = 0.3 + 0.2 * math.sin(count / 9)
        values: Any = {
            part.name: part.minimum + (part.maximum - part.minimum) * swing
            for part in kind.FIELDS.values()
            if isinstance(part, PhysicalField)
        }
        counter = count % modulus if kind.COUNTER else None
        try:
            payloads.append(swapcan.encode(kind(**safe, **values), counter=counter))
        except EncodeError:  # a value that would be a reserved code
            payloads.append(swapcan.encode(kind(**safe), counter=counter))
    return payloads


def _one_by_one(log: Path, folder: Path) -> None:
    database = _database()
    rows: dict[str, list[Mapping[str, Any]]] = {}
    with can.LogReader(log) as reader:
        for frame in reader:
            message = database.get_message_by_frame_id(frame.arbitration_id)
            decoded: Any = message.decode(bytes(frame.data), decode_choices=False)
            decoded["timestamp"] = frame.timestamp
            rows.setdefault(message.name, []).append(decoded)
    output = folder / "pandas"
    output.mkdir(exist_ok=True)
    for name, own in rows.items():
        pd.DataFrame(own).to_parquet(output / f"{name}.parquet")


@cache
def _database() -> Database:
    database = cantools.database.load_string(swapcan.dbc_text(), "dbc")
    assert isinstance(database, Database)
    return database


def _ours(log: Path, folder: Path) -> None:
    convert_logs([log], folder / "swapcan.parquet", force=True)


def _asammdf(log: Path, folder: Path) -> Callable[[], None]:
    dbc = folder / "own.dbc"
    dbc.write_text(swapcan.dbc_text(), encoding="ascii", newline="")
    mdf: Any = import_module("asammdf").MDF

    def run() -> None:
        with mdf(log) as opened:
            opened.extract_bus_logging({"CAN": [(dbc, 0)]}).close()

    return run


def _compare(runs: dict[str, Run], rounds: int) -> None:
    """Let all take turns; the first is what the others are compared with."""
    wall: dict[str, list[float]] = {name: [] for name in runs}
    processor: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(rounds):
        for name, (frames, run) in runs.items():
            start, used = time.perf_counter(), time.process_time()
            run()
            processor[name].append((time.process_time() - used) / frames)
            wall[name].append((time.perf_counter() - start) / frames)
    for name in runs:
        cells = []
        for taken in (wall, processor):
            first = next(iter(taken.values()))
            own = taken[name]
            ratio = statistics.median(peer / each for peer, each in zip(first, own, strict=True))
            cells.append(f"{1 / statistics.median(own):,.0f} frames/s, x {ratio:.1f}")
        print(f"  {name:<36} {cells[0]:<30} ({cells[1]})")


def _memory(log: Path, times: int, folder: Path) -> None:
    """Convert the same frames so many times over, from one log, in a process of its own."""
    long = folder / f"long{log.suffix}"
    header = 144 if log.suffix == ".blf" else 0
    with long.open("wb") as file:
        content = log.read_bytes()
        file.write(content[:header])
        for _ in range(times):
            file.write(content[header:])
        if header:  # says how long the file is
            file.seek(16)
            file.write((header + times * (len(content) - header)).to_bytes(8, "little"))
    del content
    start = time.perf_counter()
    command = [sys.executable, "-c", _CHILD, str(long), str(folder / "long.parquet")]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    taken = time.perf_counter() - start
    frames, peak = done.stdout.split()
    megabytes = int(peak) / 1024
    print(f"\n{log.suffix}, {int(frames):,} frames: {taken:.1f} s, peak {megabytes:,.0f} MB")
    long.unlink()
    shutil.rmtree(folder / "long")


if __name__ == "__main__":
    main()
