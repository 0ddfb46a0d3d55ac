"""Benchmarks of live nodes beside their peers, in one run: cd tests; python -m benchmarks.live.

Nothing here is asserted. All of it is on python-can's virtual bus, in one process, so that senders
and receivers share one interpreter: a machine under load changes the absolute figures more than
the ratios.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from typing import NamedTuple

import can
from benchmarks.live_listeners import LISTENERS, PEER, Listen, bare_cantools
from benchmarks.live_traffic import for_bmu, in_turn, of_a_pack, open_bus, sending
from defaults import default_of

import swapcan
from swapcan import Message
from swapcan._generated.protocol import PROTOCOL
from swapcan.node import Node

_LOAD = 2000
_PERIODS = (0.01, 0.02, 0.05, 0.1)

_STRIDE = 100
"""After how many frames the time is looked at."""


class _Speed(NamedTuple):
    """Frames in a second, and microseconds of the processor that the listener spends on one."""

    rate: float
    cpu: float


def main() -> None:
    """Print all benchmarks."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--seconds", type=float, default=5.0, help="of each latency and cycle")
    options.add_argument("--flat-out", type=float, default=2.0, help="seconds of a sender flat out")
    options.add_argument("--rounds", type=int, default=7, help="of each comparison of throughput")
    arguments = options.parse_args()
    packages = ", ".join(f"{name} {version(name)}" for name in ("cantools", "python-can"))
    print(f"Python {sys.version.split()[0]}, {packages}, virtual bus")
    for title, make in (("all messages in turn", in_turn), ("a pack of 18 CSCs", of_a_pack)):
        for changing in (False, True):
            frames = make(changing=changing)
            what = f"{title}, {'values that change' if changing else 'the same values'}"
            _throughput(f"{what}, queue filled", frames, arguments.rounds, _of_queue)
            _throughput(
                f"{what}, sender flat out",
                frames,
                arguments.rounds,
                lambda frames, listen: _flat_out(frames, listen, arguments.flat_out),
            )
    _latency(in_turn(changing=True), arguments.seconds)
    _cycles(arguments.seconds)


def _throughput(
    title: str,
    frames: Sequence[can.Message],
    rounds: int,
    measure: Callable[[Sequence[can.Message], Listen], _Speed],
) -> None:
    """Each listener in turn, round by round."""
    speeds: dict[str, list[_Speed]] = {name: [] for name in LISTENERS}
    for _ in range(rounds):
        for name, listen in LISTENERS.items():
            speeds[name].append(measure(frames, listen))
    print(f"\n{title}; x: beside bare cantools, the median of {rounds} rounds and each of them")
    for name, mine in speeds.items():
        pairs = list(zip(mine, speeds[PEER], strict=True))
        ratios = [my.rate / its.rate for my, its in pairs]
        cpu = statistics.median(its.cpu / my.cpu for my, its in pairs)
        rate = statistics.median(speed.rate for speed in mine)
        spent = statistics.median(speed.cpu for speed in mine)
        each = " ".join(f"{ratio:.2f}" for ratio in ratios)
        print(
            f"  {name:<26} {rate:>8,.0f} frames/s x {statistics.median(ratios):.2f} ({each})"
            f"   {spent:5.2f} us of CPU x {cpu:.2f}"
        )


class _Tally:
    """Counts frames in the listener's thread, and the time since the first ones.

    What a listener does before, such as reading a DBC, is left out.
    """

    def __init__(self, until: int | None = None) -> None:
        self.done = threading.Event()
        self._until = until
        self._taken = 0
        # Frames, seconds, and seconds that the thread has spent.
        self._first = self._last = (0, 0.0, 0.0)

    def __call__(self, _: can.Message) -> None:
        """Count a frame."""
        self._taken += 1
        if self._taken % _STRIDE == 0:
            self._last = (self._taken, time.perf_counter(), time.thread_time())
            if self._taken == _STRIDE:
                self._first = self._last
        if self._taken == self._until:
            self.done.set()

    def speed(self) -> _Speed:
        """How fast frames were counted."""
        (begun, start, idle), (frames, end, busy) = self._first, self._last
        return _Speed((frames - begun) / (end - start), (busy - idle) / (frames - begun) * 1e6)


def _of_queue(frames: Sequence[can.Message], listen: Listen) -> _Speed:
    """How fast frames are taken that wait on the bus."""
    tally = _Tally(len(frames))
    with open_bus() as sender, open_bus() as bus:
        for frame in frames:
            sender.send(frame)
        with listen(bus, tally):
            tally.done.wait()
    return tally.speed()


def _flat_out(frames: Sequence[can.Message], listen: Listen, seconds: float) -> _Speed:
    """How fast frames are taken beside a thread that sends as fast as it can."""
    tally = _Tally()
    with open_bus() as bus, listen(bus, tally), sending(frames):
        time.sleep(seconds)
        return tally.speed()


def _latency(frames: Sequence[can.Message], seconds: float) -> None:
    """From the sender's call to the callback."""
    print(f"\nlatency at {_LOAD} frames/s, microseconds   mean     p50     p99   worst")
    for name, listen in LISTENERS.items():
        taken: list[float] = []
        with open_bus() as bus, listen(bus, _noting_age(taken)), sending(frames, _LOAD):
            time.sleep(seconds)
        print(f"  {name:<36} {_row(taken, 1e6, '7.0f')}")


def _noting_age(ages: list[float]) -> Callable[[can.Message], None]:
    return lambda frame: ages.append(time.time() - frame.timestamp)


def _row(values: Sequence[float], scale: float, form: str) -> str:
    """Mean, median, 99 % and worst."""
    ordered = sorted(values)
    p50, p99 = (ordered[int(len(ordered) * part)] for part in (0.5, 0.99))
    shown = (statistics.mean(ordered), p50, p99, ordered[-1])
    return " ".join(f"{value * scale:{form}}" for value in shown)


def _cycles(seconds: float) -> None:
    """All messages of a BMU in four periods, while it receives and decodes."""
    kinds = PROTOCOL.sent_by("BMU")
    periods = {kind: _PERIODS[number % len(_PERIODS)] for number, kind in enumerate(kinds)}
    print(
        f"\n{len(kinds)} cyclic messages beside {_LOAD} received frames/s: intervals off by, in ms"
    )
    print("                             period       mean     p50     p99   worst")
    print(f"  a thread that only sleeps    10 ms    {_row(_asleep(seconds), 1e3, '7.3f')}")
    for name, send in (("bus.send_periodic", _send_periodic), ("swapcan Node", _send_by_node)):
        with open_bus() as recorder, open_bus() as bus, sending(for_bmu(), _LOAD):
            with send(bus, periods):
                time.sleep(seconds)
            off = _intervals(recorder, periods)
        for period in _PERIODS:
            print(f"  {name:<26} {period * 1e3:4.0f} ms    {_row(off[period], 1e3, '7.3f')}")


def _asleep(seconds: float) -> list[float]:
    """What the machine itself does to a period of 10 ms at this moment."""
    off = []
    due = last = time.perf_counter()
    for _ in range(int(seconds / 0.01)):
        due += 0.01
        time.sleep(max(due - time.perf_counter(), 0))
        now = time.perf_counter()
        off.append(abs(now - last - 0.01))
        last = now
    return off


@contextmanager
def _send_periodic(bus: can.BusABC, periods: dict[type[Message], float]) -> Iterator[None]:
    with bare_cantools(bus, lambda _: None):
        for kind, period in periods.items():
            frame = can.Message(arbitration_id=kind.FRAME_ID, data=swapcan.encode(default_of(kind)))
            bus.send_periodic(frame, period)
        try:
            yield
        finally:
            bus.stop_all_periodic_tasks()


@contextmanager
def _send_by_node(bus: can.BusABC, periods: dict[type[Message], float]) -> Iterator[None]:
    with Node(PROTOCOL, "BMU", bus) as node:
        for kind, period in periods.items():
            node.set(default_of(kind), period=period)
        yield


def _intervals(
    recorder: can.BusABC, periods: dict[type[Message], float]
) -> dict[float, list[float]]:
    """By period: how far each interval between two frames is off."""
    by_id = {kind.FRAME_ID: period for kind, period in periods.items()}
    last: dict[int, float] = {}
    off: dict[float, list[float]] = defaultdict(list)
    while frame := recorder.recv(0):
        period = by_id.get(frame.arbitration_id)
        if period is not None:
            if frame.arbitration_id in last:
                interval = frame.timestamp - last[frame.arbitration_id]
                off[period].append(abs(interval - period))
            last[frame.arbitration_id] = frame.timestamp
    return off


if __name__ == "__main__":
    main()
