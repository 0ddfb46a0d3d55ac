"""The load of a bus as text for the terminal and as plain data for machines."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from dbcspec.load.analysis import BusLoad, MessageLoad
from typedcan.shell.printing import aligned


def text(load: BusLoad) -> Iterator[str]:
    """Lines of tables: messages as they win arbitration, nodes, and what still fits."""
    yield (
        f"{load.bus.name}, {load.bus.bit_rate / 1000:g} kbit/s: load {_percent(load.bare)},"
        f" {_percent(load.stuffed)} with the most stuff bits"
    )
    yield ""
    headings = ("message", "identifier", "sender", "frames", "period", "load", "stuffed", "worst")
    yield from aligned(headings, [_row(each) for each in load.messages])
    yield ""
    nodes = load.by_node().items()
    rows = [(name, _percent(bare), _percent(stuffed)) for name, (bare, stuffed) in nodes]
    yield from aligned(("node", "load", "stuffed"), rows)
    yield ""
    for name, most in load.fitting.items():
        yield f"{name}: up to {most} items with every message in time"
    if load.silent:
        yield f"not counted, on event only: {', '.join(each.name for each in load.silent)}"
    for each in load.late:
        yield f"{each.message.name} can be later than its period of {each.message.period} ms"


def data(load: BusLoad) -> dict[str, Any]:
    """Plain data: loads are parts of 1, times are in ms."""
    return {
        "bus": load.bus.name,
        "bit_rate": load.bus.bit_rate,
        "load": float(load.bare),
        "load_stuffed": float(load.stuffed),
        "in_time": not load.late,
        "messages": [_message_data(each) for each in load.messages],
        "nodes": {
            name: {"load": float(bare), "load_stuffed": float(stuffed)}
            for name, (bare, stuffed) in load.by_node().items()
        },
        "fitting": dict(load.fitting),
        "not_counted": [each.name for each in load.silent],
    }


def _message_data(each: MessageLoad) -> dict[str, Any]:
    worst = each.response.worst
    return {
        "name": each.message.name,
        "id": each.message.frame_id,
        "sender": each.message.sender,
        "frames": each.frames,
        "period": float(each.response.stream.period * 1000),
        "load": float(each.bare),
        "load_stuffed": float(each.stuffed),
        "worst_response": None if worst is None else float(worst * 1000),
        "in_time": each.response.in_time,
    }


def _row(each: MessageLoad) -> tuple[str, ...]:
    worst = each.response.worst
    late = "" if each.response.in_time else "  late"
    return (
        each.message.name,
        f"0x{each.message.frame_id:X}",
        each.message.sender,
        str(each.frames),
        f"{float(each.response.stream.period * 1000):g} ms",
        _percent(each.bare),
        _percent(each.stuffed),
        "no bound  late" if worst is None else f"{float(worst * 1000):.2f} ms{late}",
    )


def _percent(part: Fraction) -> str:
    return f"{float(part * 100):.2f} %"
