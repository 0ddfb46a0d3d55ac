"""Comparing two large DBC files, beside the peers: python tests/benchmarks/compare.py.

Nothing here is asserted. Every figure comes with its ratio to the time that cantools takes to load
the same two files, in the same round; a machine under load changes the absolute figures more.
"""

from __future__ import annotations

import argparse
import dataclasses
import importlib
import logging
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from decimal import Decimal
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import canmatrix.compare
import canmatrix.formats
import cantools

from dbcspec.compare.run import compare
from dbcspec.emit.dbc import emit_dbc
from typedcan.databases.dbc import read_dbc
from typedcan.model.protocol import Bus, Code, Message, Node, Protocol, SendType, Signal, ValueTable

_ROUNDS = 3
_BITS = 4
_NODES = tuple(f"ECU_{number}" for number in range(20))
_BASE = "cantools loads both"


def main() -> None:
    """Print the benchmark."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--messages", type=int, default=2000)
    options.add_argument("--signals", type=int, default=15, help="signals of each message, 1 to 16")
    options.add_argument("--rounds", type=int, default=_ROUNDS)
    chosen = options.parse_args()
    logging.disable(logging.WARNING)
    names = ("cantools", "canmatrix", "dbcdiff")
    packages = ", ".join(f"{name} {_version(name)}" for name in names)
    print(f"Python {sys.version.split()[0]}, {packages}, median of {chosen.rounds} rounds")
    print(
        f"two files of {chosen.messages:,} messages, {chosen.messages * chosen.signals:,} signals"
    )
    old = _protocol(chosen.messages, chosen.signals)
    for title, new in (
        ("one signal in a hundred is different", _changed(old, 100)),
        ("every signal is different", _changed(old, 1)),
    ):
        with tempfile.TemporaryDirectory() as folder:
            paths = Path(folder, "old.dbc"), Path(folder, "new.dbc")
            for path, protocol in zip(paths, (old, new), strict=True):
                path.write_text(emit_dbc(protocol), "utf-8", newline="")
            print(f"\n{title}, seconds and ratio to {_BASE}")
            _run(paths, chosen.rounds)


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "absent"


def _protocol(messages: int, signals: int) -> Protocol:
    """A protocol of short signals with codes, comments and attributes."""
    tables = [
        ValueTable(f"State{number}", tuple(_code(number, value) for value in range(4)))
        for number in range(50)
    ]
    return Protocol(
        name="large",
        nodes=tuple(Node(name=name, english=name, address=i) for i, name in enumerate(_NODES)),
        buses=(Bus(name="main", bit_rate=500_000, nodes=_NODES),),
        messages=tuple(_message(number, signals, tables) for number in range(messages)),
        value_tables=tuple(tables),
    )


def _code(table: int, value: int) -> Code:
    return Code(value, f"State {table} {value}", f"State {table} {value}")


def _message(number: int, signals: int, tables: list[ValueTable]) -> Message:
    return Message(
        name=f"Message_{number}",
        english=f"What message {number} carries",
        frame_id=0x10000000 + number,
        length=8,
        sender=_NODES[number % len(_NODES)],
        period=100,
        send_type=SendType.CYCLIC,
        signals=tuple(
            Signal(
                name=f"Signal_{number}_{index}",
                english=f"Signal {index} of message {number}",
                start=index * _BITS,
                length=_BITS,
                factor=Decimal("0.5"),
                minimum=Decimal(0),
                maximum=Decimal("7.5"),
                unit="V",
                value_table=tables[(number + index) % len(tables)] if index % 3 == 0 else None,
                start_value=1,
                receivers=(_NODES[(number + 1) % len(_NODES)],),
            )
            for index in range(signals)
        ),
    )


def _changed(protocol: Protocol, every: int) -> Protocol:
    """The same with another factor in one of so many signals."""
    count = 0

    def other(signal: Signal) -> Signal:
        nonlocal count
        count += 1
        return signal if count % every else dataclasses.replace(signal, factor=Decimal("0.25"))

    messages = tuple(
        dataclasses.replace(message, signals=tuple(map(other, message.signals)))
        for message in protocol.messages
    )
    return dataclasses.replace(protocol, messages=messages)


def _run(paths: tuple[Path, Path], rounds: int) -> None:
    """All in turn, so that a drifting machine meets all of them."""
    found: dict[str, int] = {}
    times: dict[str, list[float]] = {}

    def measured(name: str, run: Callable[[], Any]) -> Any:
        start = time.perf_counter()
        result = run()
        times.setdefault(name, []).append(time.perf_counter() - start)
        return result

    for _ in range(rounds):
        databases = measured(_BASE, lambda: [cantools.database.load_file(path) for path in paths])
        protocols = measured("dbcspec loads both", lambda: [read_dbc(path) for path in paths])
        items = measured("dbcspec compares", partial(compare, *protocols))
        found["dbcspec compares"] = len(items)
        matrices = measured(
            "canmatrix loads both",
            lambda: [canmatrix.formats.loadp_flat(str(path)) for path in paths],
        )
        measured(
            "canmatrix compares",
            partial(canmatrix.compare.compare_db, *matrices),
        )
        if _version("dbcdiff") != "absent":
            engine = importlib.import_module("dbcdiff.engine")
            entries = measured("dbcdiff compares", partial(engine.compare_databases, *databases))
            found["dbcdiff compares"] = len(entries)
    whole = [
        ("dbcspec in all", "dbcspec loads both", "dbcspec compares"),
        ("canmatrix in all", "canmatrix loads both", "canmatrix compares"),
        ("dbcdiff in all", _BASE, "dbcdiff compares"),
    ]
    for name, *parts in whole:
        if all(part in times for part in parts):
            times[name] = [sum(taken) for taken in zip(*(times[p] for p in parts), strict=True)]
    for name, taken in times.items():
        ratio = statistics.median(
            mine / base for mine, base in zip(taken, times[_BASE], strict=True)
        )
        count = f"   {found[name]:,} findings" if name in found else ""
        print(f"  {name:<22} {statistics.median(taken):>8.3f}   x {ratio:.2f}{count}")


if __name__ == "__main__":
    main()
