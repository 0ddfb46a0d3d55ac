"""Frames made by cantools from the DBC, and a session that hears them on a clock set by hand."""

from __future__ import annotations

from functools import cache, reduce
from operator import xor
from pathlib import Path

import can
import cantools
from cantools.database.can import Database

from swapcan import Codec
from swapcan.glance.look import PackGlance, PackLook
from typedcan.monitor.picture import Picture
from typedcan.monitor.rows import MessageRow, SignalRow
from typedcan.monitor.session import Session
from typedcan.monitor.watch import Watch
from typedcan.node.clock import SimulatedClock

_DBC = Path(__file__).parents[2] / "dbc" / "caamtb-swap.dbc"
_XOR_IN_BYTE_0 = ("V2B_CMD", "V2B_RQData", "B2V_ST1", *(f"B2V_SysCode{n}" for n in range(1, 5)))


@cache
def dbc() -> Database:
    """The DBC as cantools reads it."""
    database = cantools.database.load_file(_DBC)
    assert isinstance(database, Database)
    return database


def frame(name: str, at: float, **signals: float) -> can.Message:
    """A frame of a message; signals without the message's prefix, the others raw 0."""
    message = dbc().get_message_by_name(name)
    values = {signal.name: signal.offset for signal in message.signals}
    for signal_name, value in signals.items():
        known = [each for each in values if f"_{each}".endswith(f"_{signal_name}")]
        assert len(known) == 1, (signal_name, known)
        values[known[0]] = value
    data = bytearray(message.encode(values, strict=False))
    if name in _XOR_IN_BYTE_0:
        data[0] = reduce(xor, data[1:])
    return can.Message(arbitration_id=message.frame_id, data=data, timestamp=at)


class Monitored:
    """A session, of this standard unless said otherwise, and the time that it lives in."""

    def __init__(self, watch: Watch | None = None) -> None:
        self.clock = SimulatedClock()
        watch = watch or Watch(0.0, Codec(), glance=PackGlance())
        self.session = Session(watch, self.clock)

    def hear(self, *frames: can.Message) -> None:
        """Let the session hear frames at the times of their timestamps."""
        for each in frames:
            self.clock.advance_to(each.timestamp)
            self.session.take(each)

    def at(self, seconds: float) -> Picture:
        """What the session knows at that time."""
        self.clock.advance_to(seconds)
        return self.session.picture()


def look(picture: Picture) -> PackLook:
    """What is shown of the pack."""
    assert isinstance(picture.look, PackLook)
    return picture.look


def row(picture: Picture, name: str) -> MessageRow:
    """The row of a message."""
    return next(row for row in picture.messages if row.name == name)


def signal(picture: Picture, message: str, name: str) -> SignalRow:
    """The row of a signal, which is named without the message's prefix."""
    return next(row for row in picture.signals(message) if row.name.endswith(name))
