"""Vectorised decoding beside its peers, one core, one run: python tests/benchmarks/decode_logs.py.

Nothing here is asserted. Rates are of the processor time of this process, so that another process
costs less of the figures; ratios are medians of rounds in which all take turns. Peers that are not
installed are named and left out.
"""

from __future__ import annotations

import argparse
import random
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import can
import cantools
import numpy as np
from cantools.database.can import Database, Message, Signal
from cantools.database.conversion import BaseConversion

import swapcan
from swapcan.log_protocol import OWN
from typedcan.logs.database import protocol_of
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.plan import Mode
from typedcan.model import protocol as model

_FEW = 20_000
"""Frames for those who take them one by one."""
_MANY = 200_000
"""Frames for asammdf, whose costs per file would hide those per frame."""
_PERIOD = 6e-4
"""Seconds between frames."""
_BLOCKS = (1 << 14, 1 << 16, 1 << 18)

Run = tuple[int, Callable[[], None]]
"""A number of frames, and what decodes them."""


@dataclass(frozen=True)
class Traffic:
    """Frames as columns and, the first of them, as pairs."""

    dbc: str
    database: Database
    block: FrameBlock
    few: list[tuple[int, bytes]]


def main() -> None:
    """Print all benchmarks."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--frames", type=int, default=1 << 20)
    options.add_argument("--rounds", type=int, default=7)
    given = options.parse_args()
    packages = ", ".join(f"{name} {version(name)}" for name in ("cantools", "numpy"))
    print(f"Python {sys.version.split()[0]}, {packages}, median of {given.rounds} rounds")
    own = cantools.database.load_string(swapcan.dbc_text(), "dbc")
    assert isinstance(own, Database)
    dense = _dense(random.Random(1))
    own_text, dense_text = swapcan.dbc_text(), dense.as_dbc_string()
    for title, dbc, database, realistic in (
        ("own DBC, random payloads", own_text, own, False),
        ("own DBC, periodic and slowly changing", own_text, own, True),
        ("25 messages of 17 scaled signals, random", dense_text, dense, False),
    ):
        traffic = _traffic(dbc, database, given.frames, realistic=realistic)
        print(f"\n{title}, {given.frames:,} frames")
        with ExitStack() as stack:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
            runs = {"cantools decode_message": _cantools(traffic), **_ours(traffic, folder)}
            runs.update(_peers(traffic, folder))
            _compare(runs, given.rounds)


def _dense(source: random.Random) -> Database:
    """25 messages, each full of 17 signals of 1 to 8 bits, all of them scaled."""
    messages = []
    for number in range(25):
        lengths = [1] * 17
        while sum(lengths) < 64:
            at = source.randrange(17)
            lengths[at] += lengths[at] < 8
        starts = [sum(lengths[:at]) for at in range(17)]
        signals = [
            Signal(
                f"Signal{number}_{at}",
                start,
                length,
                unit="V",
                conversion=BaseConversion.factory(source.choice([0.1, 0.5]), source.choice([0, 4])),
            )
            for at, (start, length) in enumerate(zip(starts, lengths, strict=True))
        ]
        name = f"Message{number}"
        identifier = 0x18FF0000 + 259 * number
        messages.append(Message(identifier, name, 8, signals, is_extended_frame=True))
    return Database(messages, version="")


def _traffic(dbc: str, database: Database, frames: int, *, realistic: bool) -> Traffic:
    source = np.random.default_rng(1)
    identifiers = np.array([message.frame_id for message in database.messages], np.uint32)
    if realistic:
        turn = np.arange(frames) % len(identifiers)
        slow = source.integers(0, 256, (len(identifiers), 8), dtype=np.uint8)[turn]
        data = slow + (np.arange(frames) // 1000 % 5).astype(np.uint8)[:, None]
    else:
        turn = source.integers(0, len(identifiers), frames)
        data = source.integers(0, 256, (frames, 8), dtype=np.uint8)
    block = FrameBlock(
        timestamp=np.arange(frames, dtype=np.float64) * _PERIOD,
        frame_id=identifiers[turn],
        flags=np.full(frames, FrameFlag.EXTENDED, np.uint8),
        channel=np.zeros(frames, np.int16),
        length=np.full(frames, 8, np.uint8),
        data=data,
        channels=(0,),
    )
    pairs = zip(block.frame_id[:_FEW].tolist(), data[:_FEW], strict=True)
    return Traffic(dbc, database, block, [(number, row.tobytes()) for number, row in pairs])


def _blocks(block: FrameBlock, frames: int) -> Iterator[FrameBlock]:
    for start in range(0, len(block), frames):
        cut = slice(start, start + frames)
        yield FrameBlock(
            block.timestamp[cut],
            block.frame_id[cut],
            block.flags[cut],
            block.channel[cut],
            block.length[cut],
            block.data[cut],
            block.channels,
        )


def _cantools(traffic: Traffic) -> Run:
    def run() -> None:
        for number, data in traffic.few:
            traffic.database.decode_message(number, data, decode_choices=False, scaling=True)

    return len(traffic.few), run


def _ours(traffic: Traffic, folder: Path) -> dict[str, Run]:
    path = folder / "ours.dbc"
    path.write_text(traffic.dbc, encoding="ascii", newline="")
    messages, reserved = protocol_of(path, OWN).messages, OWN.reserved
    runs: dict[str, Run] = {}
    for size in _BLOCKS:
        blocks = list(_blocks(traffic.block, size))
        for name, decoder in {
            "raw": Decoder(messages, mode=Mode.RAW),
            "physical": Decoder(messages),
            "physical, states": Decoder(messages, reserved=reserved),
            "labels": Decoder(messages, mode=Mode.LABELS, reserved=reserved),
        }.items():
            run = partial(_decode, blocks, decoder.decode)
            runs[f"{name}, blocks of {size}"] = len(traffic.block), run
    blocks = list(_blocks(traffic.block, _BLOCKS[-1]))
    for mode in (Mode.RAW, Mode.PHYSICAL):
        run = partial(_decode, blocks, partial(_decode_once, messages, mode))
        runs[f"{mode.value}, new memory each block"] = len(traffic.block), run
    return runs


def _decode(blocks: list[FrameBlock], decode: Callable[[FrameBlock], object]) -> None:
    for block in blocks:
        decode(block)


def _decode_once(messages: Sequence[model.Message], mode: Mode, block: FrameBlock) -> None:
    Decoder(messages, mode=mode).decode(block)


def _peers(traffic: Traffic, folder: Path) -> dict[str, Run]:
    """What is installed of opendbc, can_decoder and asammdf."""
    path = folder / "peers.dbc"
    path.write_text(traffic.dbc, encoding="ascii", newline="")
    makers = {"opendbc": _opendbc, "can_decoder": _can_decoder, "asammdf": _asammdf}
    runs: dict[str, Run] = {}
    for name, make in makers.items():
        if find_spec(name) is None:
            print(f"  {name} is not installed")
        else:
            runs[f"{name} {version(name)}"] = make(traffic, path)
    return runs


def _opendbc(traffic: Traffic, path: Path) -> Run:
    parser = import_module("opendbc.can.parser").CANParser
    extended = 0x80000000
    names = [(message.name, 0) for message in traffic.database.messages]
    frames = [
        (at, [(number | extended, data, 0)]) for at, (number, data) in enumerate(traffic.few, 1)
    ]

    def run() -> None:
        made = parser(str(path), names, 0)
        for frame in frames:
            made.update([frame])

    return len(traffic.few), run


def _can_decoder(traffic: Traffic, path: Path) -> Run:
    package = import_module("can_decoder")
    decoder = package.DataFrameDecoder(package.load_dbc(str(path)))
    pandas = import_module("pandas")
    times = pandas.to_datetime(traffic.block.timestamp[:_FEW], unit="s")
    frames = pandas.DataFrame(
        {
            "ID": [number for number, _ in traffic.few],
            "IDE": True,
            "DataBytes": [list(data) for _, data in traffic.few],
        },
        index=pandas.DatetimeIndex(times, name="TimeStamp"),
    )

    def run() -> None:
        decoder.decode_frame(frames)

    return len(traffic.few), run


def _asammdf(traffic: Traffic, path: Path) -> Run:
    """Reading is part of it: asammdf extracts from its own files only."""
    log = path.with_name("peer.mf4")
    block = next(_blocks(traffic.block, _MANY))
    with can.Logger(log) as writer:
        rows = zip(block.timestamp, block.frame_id.tolist(), block.data, strict=True)
        for at, number, row in rows:
            writer(can.Message(at, number, data=row.tobytes(), channel=1))
    mdf: Any = import_module("asammdf").MDF

    def run() -> None:
        with mdf(log) as opened:
            opened.extract_bus_logging({"CAN": [(path, 0)]}).close()

    return len(block), run


def _compare(runs: dict[str, Run], rounds: int) -> None:
    """Let all take turns; the first is what the others are compared with."""
    taken: dict[str, list[float]] = {name: [] for name in runs}
    for measured in (False, *[True] * rounds):
        for name, (frames, run) in runs.items():
            start = time.process_time()
            run()
            if measured:
                taken[name].append((time.process_time() - start) / frames)
    first = next(iter(taken.values()))
    for name, times in taken.items():
        ratio = statistics.median(peer / own for peer, own in zip(first, times, strict=True))
        rate = 1 / statistics.median(times)
        print(f"  {name:<34} {rate:>13,.0f} frames/s   x {ratio:.2f}")


if __name__ == "__main__":
    main()
