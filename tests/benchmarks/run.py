"""Benchmarks, beside the peers and in one run: python tests/benchmarks/run.py [--rounds N].

Nothing here is asserted. Times are those of the processor, rounds of peer and ours take turns, and
ratios, the medians of all rounds, say how many times as fast swapcan is. Payloads are new in each
round: random ones, then recorded traffic; which share of them came before is told.
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
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from importlib.metadata import version
from itertools import islice
from pathlib import Path
from typing import Any

import can
import cantools
from cantools.database.can import Database

import swapcan
from dbcspec.artifacts import artifacts, verify
from dbcspec.config import find_config
from dbcspec.project import load
from swapcan import Codec, Link, Message
from swapcan.messages import MESSAGES
from swapcan.simulate import Battery, Layout, Simulation, plan_of
from typedcan.simulate.simulated_bus import SimulatedBus

_FRAMES = 2000
_ROUNDS = 15
_CSCS = 18
"""Of the pack in the recorded traffic, with 12 cells each."""

_NO_BYTECODE = {"PYTHONDONTWRITEBYTECODE"}

Parts = Callable[[], Iterator[list[can.Message]]]
"""Begins to give frames, a part for each round; they go on for ever."""


def main() -> None:
    """Print all benchmarks."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=_ROUNDS, help="rounds of each comparison")
    options.add_argument("--log", help="recorded traffic of your own, in place of a simulated one")
    chosen = options.parse_args()
    rounds: int = chosen.rounds
    packages = ", ".join(f"{name} {version(name)}" for name in ("cantools", "python-can"))
    print(f"Python {sys.version.split()[0]}, {packages}, median of {rounds} rounds")
    database = cantools.database.load_string(swapcan.dbc_text(), "dbc")
    assert isinstance(database, Database)
    long = [kind for kind in MESSAGES if len(kind.FIELDS) > 15]
    for title, parts in (
        ("random payloads, 25 messages in turn", partial(_random, MESSAGES)),
        ("random payloads, messages of 20 to 33 signals", partial(_random, long)),
        ("recorded traffic", partial(_in_parts, _recorded(chosen.log))),
    ):
        repeats = _repeats([frame for part in islice(parts(), rounds) for frame in part])
        print(f"\n{title}, {repeats:.0%} of them repeats; frames a second of processor time")
        _decode(database, parts, rounds)
        _encode(database, parts, rounds)
        _receive(database, parts, rounds)
    _generate(rounds)
    _imports(rounds)


def _random(kinds: Sequence[type[Message]]) -> Iterator[list[can.Message]]:
    """Frames with random values that can be sent again, and counters that go on."""
    source, codec, counted = random.Random(1), Codec(), Counter[type[Message]]()
    while True:
        frames: list[can.Message] = []
        while len(frames) < _FRAMES:
            kind = kinds[len(frames) % len(kinds)]
            message = codec.decode(kind, source.randbytes(kind.LENGTH), verify=False)
            counter = counted[kind] % kind.COUNTER.modulus if kind.COUNTER else None
            try:
                data = codec.encode(message, counter=counter, renew=True)
            except swapcan.EncodeError:
                continue
            counted[kind] += 1
            frames.append(can.Message(arbitration_id=kind.FRAME_ID, data=data))
        yield frames


def _recorded(log: str | None) -> list[can.Message]:
    """The frames of the protocol in a log, or in two simulated minutes of a drive and a charge."""
    frames: list[can.Message] = []
    if log:
        with can.LogReader(log) as reader:
            frames.extend(reader)
    else:
        plan = plan_of("hv_on@1s, ask@2s, drive@3s+60s, hv_off@70s, charge@80s")
        battery = Battery(Layout(cscs=_CSCS))
        with Simulation.simulated(plan=plan, battery=battery) as simulation:
            buses = [SimulatedBus(wire) for wire in simulation.wires]

            def listen() -> None:
                for bus in buses:
                    while frame := bus.recv(0):
                        frames.append(frame)

            simulation.world.after_each_step(listen)
            simulation.world.run(120.0)
            for bus in buses:
                bus.shutdown()
    known = {kind.FRAME_ID for kind in MESSAGES}
    return [frame for frame in frames if frame.arbitration_id in known]


def _repeats(frames: Sequence[can.Message]) -> float:
    """The share of frames whose payload was among the last 256 different ones of their message."""
    seen: dict[int, deque[bytes]] = {}
    repeats = 0
    for frame in frames:
        last, data = seen.setdefault(frame.arbitration_id, deque(maxlen=256)), bytes(frame.data)
        if data in last:
            repeats += 1
        else:
            last.append(data)
    return repeats / max(len(frames), 1)


def _in_parts(frames: Sequence[can.Message]) -> Iterator[list[can.Message]]:
    """Recorded frames, one part after the other."""
    while True:
        for start in range(0, max(len(frames) - _FRAMES, 1), _FRAMES):
            yield list(frames[start : start + _FRAMES])


Prepare = Callable[[list[can.Message]], Callable[[], object]]
"""Prepares a round with its frames, and gives what is measured of it."""


def _pairs(frames: Sequence[can.Message]) -> list[tuple[int, bytes]]:
    return [(frame.arbitration_id, bytes(frame.data)) for frame in frames]


def _decode(database: Database, parts: Parts, rounds: int) -> None:
    """Both look the identifier up and end in physical values and labels."""
    decode, decode_and_verify = Codec().decode, Codec().decode
    decode_message = database.decode_message

    def peer(frames: list[can.Message]) -> Callable[[], object]:
        pairs = _pairs(frames)
        return lambda: [decode_message(number, data) for number, data in pairs]

    def ours(frames: list[can.Message]) -> Callable[[], object]:
        pairs = _pairs(frames)
        return lambda: [decode(number, data, verify=False) for number, data in pairs]

    def verified(frames: list[can.Message]) -> Callable[[], object]:
        pairs = _pairs(frames)
        return lambda: [decode_and_verify(number, data) for number, data in pairs]

    runs = {"cantools decode_message": peer, "decode": ours, "decode, verified": verified}
    _compare(parts, rounds, runs)


def _encode(database: Database, parts: Parts, rounds: int) -> None:
    """Both check every value."""
    codec, encode_message = Codec(), database.encode_message

    def messages(frames: list[can.Message]) -> list[Message]:
        return [Codec().decode_frame(frame, verify=False) for frame in frames]

    def peer(frames: list[can.Message]) -> Callable[[], object]:
        values = [(number, _plain(database, number, data)) for number, data in _pairs(frames)]
        return lambda: [encode_message(number, signals) for number, signals in values]

    def ours(frames: list[can.Message]) -> Callable[[], object]:
        made = messages(frames)
        return lambda: [codec.encode(message) for message in made]

    def constructed(frames: list[can.Message]) -> Callable[[], object]:
        given = [
            (type(each), {name: getattr(each, name) for name in each.FIELDS})
            for each in messages(frames)
        ]
        return lambda: [codec.encode(kind(**values)) for kind, values in given]

    runs = {
        "cantools encode_message": peer,
        "encode": ours,
        "construct and encode": constructed,
    }
    _compare(parts, rounds, runs)


def _plain(database: Database, frame_id: int, data: bytes) -> dict[str, Any]:
    """Physical values of a payload, codes as numbers."""
    values = database.decode_message(frame_id, data, decode_choices=False)
    assert isinstance(values, dict)
    return values


def _receive(database: Database, parts: Parts, rounds: int) -> None:
    """From a bus that has the frames ready to values that are read."""
    decode_message = database.decode_message
    with (
        can.Bus("benchmark", "virtual", ignore_config=True) as sender,
        can.Bus("benchmark", "virtual", ignore_config=True) as bus,
    ):
        link = Link(bus)

        def send(frames: list[can.Message]) -> range:
            for frame in frames:
                sender.send(frame)
            return range(len(frames))

        def peer(frames: list[can.Message]) -> Callable[[], object]:
            def read() -> object:
                frame = bus.recv(1.0)
                assert frame
                return decode_message(frame.arbitration_id, frame.data)  # type: ignore[arg-type]

            count = send(frames)
            return lambda: [read() for _ in count]

        def ours(frames: list[can.Message]) -> Callable[[], object]:
            count = send(frames)
            return lambda: [link.receive().message for _ in count]

        def unread(frames: list[can.Message]) -> Callable[[], object]:
            count = send(frames)
            return lambda: [link.receive() for _ in count]

        runs = {
            "recv and decode_message": peer,
            "Link.receive, read": ours,
            "Link.receive, unread": unread,
        }
        _compare(parts, rounds, runs)


def _compare(parts: Parts, rounds: int, runs: Mapping[str, Prepare]) -> None:
    """Run all in turn, with the same frames; the first is the peer."""
    times: dict[str, list[float]] = {name: [] for name in runs}
    for frames in islice(parts(), rounds):
        for name, prepare in runs.items():
            run = prepare(frames)
            start = time.process_time()
            run()
            times[name].append((time.process_time() - start) / len(frames))
    peer, *_ = times.values()
    for name, taken in times.items():
        ratios = [theirs / mine for theirs, mine in zip(peer, taken, strict=True)]
        rate = 1 / statistics.median(taken)
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
