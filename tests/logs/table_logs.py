"""Logs of this package's own protocol, and what the live runtime and cantools make of them."""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import can
import cantools
from cantools.database.can import Database
from defaults import default_of, needed_by

import swapcan
from swapcan.messages import MESSAGES
from typedcan.wire.errors import EncodeError
from typedcan.wire.fields import PhysicalField
from typedcan.wire.message import Message

START = 1_700_000_000.0
"""When the logs begin, in seconds since 1970."""

_NEEDED = {"charge_control": 1, "reqst_tms_hv_on": 1, "charger_start": 1}
"""What has to be given where a message has it: stop and off."""


@cache
def own_database() -> Database:
    """The packaged DBC as cantools has it."""
    database = cantools.database.load_string(swapcan.dbc_text(), "dbc")
    assert isinstance(database, Database)
    return database


@cache
def _payload(name: str, count: int) -> bytes:
    return payload(swapcan.message_type(name), count)


def payload(kind: type[Message], count: int) -> bytes:
    """The payload of the ``count``-th frame of a message: values that change, a counter that runs.

    Every seventh has what a message has where no value is given: reserved codes.
    """
    swing = 0.3 + 0.2 * math.sin(count)
    values = needed_by(kind)
    values |= {
        part.name: part.minimum + (part.maximum - part.minimum) * swing
        for part in kind.FIELDS.values()
        if isinstance(part, PhysicalField) and count % 7
    }
    counter = count % kind.COUNTER.modulus if kind.COUNTER else None
    try:
        return swapcan.encode(kind(**values), counter=counter)
    except EncodeError:  # a value that would be a reserved code
        return swapcan.encode(default_of(kind), counter=counter)


def traffic(seconds: float, start: float = START) -> list[can.Message]:
    """What all nodes send in so many seconds: each message in its period, others each second."""
    noise = random.Random(1)
    frames = []
    for kind in MESSAGES:
        period = kind.PERIOD or 1.0
        first = period * noise.random()
        for count in range(max(0, math.ceil((seconds - first) / period))):
            at = round(start + first + count * period, 6)
            data = _payload(kind.NAME, count)
            frames.append(can.Message(at, kind.FRAME_ID, data=data, channel=0))
    return sorted(frames, key=lambda frame: frame.timestamp)


def write_frames(path: Path, frames: Iterable[can.Message]) -> Path:
    """A log of these frames; its suffix says of which kind."""
    with can.Logger(path) as logger:
        for frame in frames:
            logger.on_message_received(frame)
    return path


def decoded(frames: Iterable[can.Message]) -> dict[str, list[Mapping[str, Any]]]:
    """By message, what cantools makes of each frame, without labels."""
    database = own_database()
    rows: dict[str, list[Mapping[str, Any]]] = {}
    for frame in frames:
        message = database.get_message_by_frame_id(frame.arbitration_id)
        values: Any = message.decode(bytes(frame.data), decode_choices=False)
        rows.setdefault(message.name, []).append(values)
    return rows
