"""Benchmarks, beside the peers and in one run: python tests/benchmarks/run.py [--seconds S].

Nothing here is asserted. Ratios say how many times as fast swapcan is as the peer; a machine under
load changes the absolute figures more than the ratios.
"""

from __future__ import annotations

import argparse
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path

import cantools
from cantools.database.can import Database

import swapcan
from dbcspec.artifacts import artifacts, verify
from dbcspec.config import find_config
from dbcspec.project import load
from swapcan.messages import MESSAGES

_FRAMES = 2000
_ROUNDS = 7
_NO_BYTECODE = {"PYTHONDONTWRITEBYTECODE"}


def main() -> None:
    """Print all benchmarks."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=_ROUNDS, help="rounds of each comparison")
    rounds = options.parse_args().rounds
    packages = ", ".join(f"{name} {version(name)}" for name in ("cantools", "python-can"))
    print(f"Python {sys.version.split()[0]}, {packages}, median of {rounds} rounds")
    database = cantools.database.load_string(swapcan.dbc_text(), "dbc")
    assert isinstance(database, Database)
    frames = _frames(random.Random(1))
    _decode(database, frames, rounds, "25 messages in turn")
    long = [frame for frame in frames if len(_kind(frame[0]).FIELDS) > 15]
    _decode(database, long, rounds, "messages of 20 to 33 signals")
    _encode(database, frames, rounds, "25 messages in turn")
    _encode(database, long, rounds, "messages of 20 to 33 signals")
    _generate(rounds)
    _imports(rounds)


def _kind(frame_id: int) -> type[swapcan.Message]:
    return next(kind for kind in MESSAGES if frame_id == kind.FRAME_ID)


def _frames(source: random.Random) -> list[tuple[int, bytes]]:
    """Frames of all messages whose values can be sent again."""
    frames: list[tuple[int, bytes]] = []
    while len(frames) < _FRAMES:
        kind = MESSAGES[len(frames) % len(MESSAGES)]
        payload = source.randbytes(kind.LENGTH)
        message = swapcan.decode(kind.FRAME_ID, payload, verify=False)
        try:
            frames.append((kind.FRAME_ID, swapcan.encode(message)))
        except swapcan.EncodeError:
            continue
    return frames


def _decode(
    database: Database, frames: Sequence[tuple[int, bytes]], rounds: int, title: str
) -> None:
    """Both look the identifier up and end in physical values and labels."""

    def stubs() -> None:
        for frame_id, data in frames:
            swapcan.decode(frame_id, data, verify=False)

    def verified() -> None:
        for frame_id, data in frames:
            with suppress(swapcan.ChecksumError):
                swapcan.decode(frame_id, data)

    def peer() -> None:
        for frame_id, data in frames:
            database.decode_message(frame_id, data)

    print(f"\ndecode, {title}, frames/s")
    _compare(len(frames), rounds, "cantools decode_message", peer, stubs=stubs, verified=verified)


def _encode(
    database: Database, frames: Sequence[tuple[int, bytes]], rounds: int, title: str
) -> None:
    messages = [swapcan.decode(frame_id, data, verify=False) for frame_id, data in frames]
    values = [
        (frame_id, database.decode_message(frame_id, data, decode_choices=False))
        for frame_id, data in frames
    ]

    def stubs() -> None:
        for message in messages:
            swapcan.encode(message)

    def peer() -> None:
        for frame_id, signals in values:
            database.encode_message(frame_id, signals)

    print(f"\nencode, {title}, frames/s")
    _compare(len(frames), rounds, "cantools encode_message", peer, stubs=stubs)


def _compare(
    frames: int, rounds: int, peer_name: str, peer: Callable[[], None], **ours: Callable[[], None]
) -> None:
    """Run peer and ours in turn, so that a drifting machine meets all of them."""
    times: dict[str, list[float]] = {peer_name: [], **{name: [] for name in ours}}
    for _ in range(rounds):
        for name, run in {peer_name: peer, **ours}.items():
            start = time.perf_counter()
            run()
            times[name].append(time.perf_counter() - start)
    for name, taken in times.items():
        ratios = [theirs / mine for theirs, mine in zip(times[peer_name], taken, strict=True)]
        rate = frames / statistics.median(taken)
        print(f"  {name:<26} {rate:>10,.0f}   x {statistics.median(ratios):.2f}")


def _generate(rounds: int) -> None:
    config = find_config(Path(__file__).resolve())
    taken = []
    for _ in range(rounds):
        start = time.perf_counter()
        project = load(config)
        project.findings()
        verify(config.root, artifacts(project.protocol, config), project.protocol, config)
        taken.append(time.perf_counter() - start)
    print(f"\ndbcspec generate, all steps after start-up: {statistics.median(taken):.3f} s")
    print(f"  the first time in a process:               {taken[0]:.3f} s")


def _imports(rounds: int) -> None:
    """Whole processes, in turn, with the bytecode of all modules cached."""
    programs: dict[str, list[float]] = {
        program: [] for program in ("import cantools, can", "import swapcan", "pass")
    }
    environment = {name: value for name, value in os.environ.items() if name not in _NO_BYTECODE}
    with tempfile.TemporaryDirectory() as cache:
        environment["PYTHONPYCACHEPREFIX"] = cache
        for measured in (False, *[True] * rounds):
            for program, taken in programs.items():
                start = time.perf_counter()
                subprocess.run([sys.executable, "-c", program], check=True, env=environment)
                if measured:
                    taken.append(time.perf_counter() - start)
    print("\nimports, seconds of a whole process")
    for program, taken in programs.items():
        ratio = statistics.median(
            mine / theirs
            for mine, theirs in zip(taken, programs["import cantools, can"], strict=True)
        )
        print(f"  {program:<26} {statistics.median(taken):.3f}   x {ratio:.2f}")


if __name__ == "__main__":
    main()
