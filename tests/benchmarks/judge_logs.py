"""Judging millions of frames by all rules: python tests/benchmarks/judge_logs.py [--frames 20].

Nothing here is asserted. The frames are those of all five simulated nodes with a pack of 2 CSCs
and with one of 18, recorded for some minutes and repeated until there are as many as asked for,
alive counters and checksums going on. Prints frames per second of processor time, on one core: the
vectorised decoder alone, all rules together, and what each rule takes. ``--log`` also writes the
frames of the first pack to a BLF file and judges that, reading included.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import can
import numpy as np
from rules.recorded import block_of, recorded

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import RULES, Judge, judge_log
from swapcan.log_protocol import OWN
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings
from typedcan.judge.rule import Rule, Watcher
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock
from typedcan.logs.plan import Mode
from typedcan.model.layout import bits

_BLOCK = 1 << 17
_PLAN = "hv_on@1s, ask@2s, drive@3s+80s, charge@95s+60s, hv_off@170s"
_RUN = 180.0
_PACKS = (2, 18)


def repeated(once: FrameBlock, frames: int) -> Iterator[FrameBlock]:
    """The same again and again, later each time, in blocks."""
    places = np.arange(_BLOCK)
    for begin in range(0, frames, _BLOCK):
        at = begin + places[: frames - begin]
        rounds, rows = np.divmod(at, len(once))
        data = once.data[rows]
        _count_on(once, data, rounds, rows)
        yield FrameBlock(
            once.timestamp[rows] + rounds * _RUN,
            once.frame_id[rows],
            once.flags[rows],
            once.channel[rows],
            once.length[rows],
            data,
            once.channels,
        )


def _count_on(once: FrameBlock, data: np.ndarray, rounds: np.ndarray, rows: np.ndarray) -> None:
    """Let alive counters run on from round to round, and mend the checksums."""
    for kind in PROTOCOL.messages:
        if kind.COUNTER is None:
            continue
        own = np.flatnonzero(once.frame_id[rows] == kind.FRAME_ID)
        step = int((once.frame_id == kind.FRAME_ID).sum()) % kind.COUNTER.modulus
        signal = kind.MODEL.signal(kind.COUNTER.signal)
        byte, shift = divmod(bits(signal)[0], 8)
        mask = (1 << signal.length) - 1
        held = data[own, byte].astype(np.int64)
        count = ((held >> shift & mask) + rounds[own] * step) % kind.COUNTER.modulus
        data[own, byte] = (held & ~(mask << shift)) | count << shift
        if kind.CHECKSUM is not None and kind.CHECKSUM.algorithm == "xor":
            data[own, 0] = np.bitwise_xor.reduce(data[own, 1:], axis=1)


class _Timed(Watcher):
    """Takes chunks for a rule, and notes the seconds that it needs."""

    def __init__(self, rule: Rule, spent: dict[str, float], findings: Findings) -> None:
        super().__init__(findings)
        self._watcher = rule.watch(findings)
        self.wants_cycles = self._watcher.wants_cycles  # type: ignore[misc]
        self._id = rule.id
        self._spent = spent

    def feed(self, chunk: Chunk) -> None:
        """Let the rule judge."""
        begin = time.process_time()
        self._watcher.feed(chunk)
        self._spent[self._id] += time.process_time() - begin

    def finish(self, end: LogEnd) -> None:
        """Let the rule come to its end."""
        self._watcher.finish(end)


def main() -> None:
    """Print all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=float, default=20.0, metavar="MILLIONS")
    parser.add_argument("--log", action="store_true")
    options = parser.parse_args()
    frames = int(options.frames * 1e6)
    print(f"Python {sys.version.split()[0]}, numpy {np.__version__}, rules: {len(RULES)}")
    for cscs in _PACKS:
        once = block_of(recorded(_PLAN, seconds=_RUN, cscs=cscs))
        rate = len(once) / _RUN
        print(f"\na pack of {cscs} x 12 cells: {frames:,} frames, {rate:,.0f} a second on the bus")
        decoder = Decoder(OWN.messages, mode=Mode.RAW)
        decoding = judging = 0.0
        judge = Judge()
        for block in repeated(once, frames):
            begin = time.process_time()
            decoder.decode(block)
            middle = time.process_time()
            judge.feed(block)
            judging += time.process_time() - middle
            decoding += middle - begin
        begin = time.process_time()
        judgement = judge.finish()
        judging += time.process_time() - begin
        found = sum(result.count for result in judgement.results)
        print(f"  decoder alone {frames / decoding / 1e6:8.2f} M frames/s")
        print(f"  all rules     {frames / judging / 1e6:8.2f} M frames/s, found: {found}")
        _each_rule(once, min(frames, 2_000_000))
    if options.log:
        _judge_file(once, frames)


def _each_rule(once: FrameBlock, frames: int) -> None:
    spent: dict[str, float] = defaultdict(float)
    rules = [replace(rule, watch=partial(_Timed, rule, spent)) for rule in RULES]
    judge = Judge(rules=rules)
    for block in repeated(once, frames):
        judge.feed(block)
    print(f"  ns a frame    {'total':<28}{sum(spent.values()) / frames * 1e9:8.1f}")
    for rule_id, seconds in sorted(spent.items(), key=lambda item: -item[1])[:15]:
        print(f"                {rule_id:<28}{seconds / frames * 1e9:8.1f}")


def _judge_file(once: FrameBlock, frames: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "pack.blf"
        with can.BLFWriter(path) as writer:
            for block in repeated(once, frames):
                for time_, number, channel, data in zip(
                    block.timestamp, block.frame_id, block.channel, block.data, strict=True
                ):
                    writer.on_message_received(
                        can.Message(time_ + 1.7e9, int(number), channel=int(channel), data=data)
                    )
        begin = time.process_time()
        judge_log(path)
        seconds = time.process_time() - begin
        print(
            f"\nBLF of {frames:,} frames, read and judged: {frames / seconds / 1e6:.2f} M frames/s"
        )


if __name__ == "__main__":
    main()
