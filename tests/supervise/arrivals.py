"""Frames as they come from a bus: bits by cantools, checksums by hand."""

from functools import cache, reduce
from operator import xor
from pathlib import Path

import can
import cantools
from cantools.database.can import Database

from swapcan.wire import Receiver
from typedcan.wire.link import Fault, Received
from typedcan.wire.message import Message

DBC = Path(__file__).parents[2] / "dbc" / "caamtb-swap.dbc"
XOR_IN_BYTE_0 = {"V2B_CMD", "V2B_RQData", "B2V_ST1", "B2V_SysCode1"}


@cache
def _database() -> Database:
    database = cantools.database.load_file(DBC)
    assert isinstance(database, Database)
    return database


def frame(message: str, timestamp: float = 0.0, **raw: int) -> can.Message:
    """A frame with these raw values, by the signals' names behind the message's prefix or whole.

    All other signals are 0.
    """
    known = _database().get_message_by_name(message)
    values = dict.fromkeys((signal.name for signal in known.signals), 0)
    for name, value in raw.items():
        (full,) = (one for one in values if one == name or one.endswith(f"_{name}"))
        values[full] = value
    data = bytearray(known.encode(values, scaling=False, strict=False))
    if message in XOR_IN_BYTE_0:
        data[0] = reduce(xor, data[1:])
    return can.Message(arbitration_id=known.frame_id, data=data, timestamp=timestamp)


def received(message: str, timestamp: float = 0.0, **raw: int) -> Received[Message]:
    """The same as a receiver hands it on; counters are not checked."""
    taken = Receiver().take(frame(message, timestamp, **raw))
    assert isinstance(taken, Received)
    return taken


def refused(message: str) -> Fault:
    """A frame of that message that is one byte short."""
    short = frame(message)
    short.data = short.data[:-1]
    taken = Receiver().take(short)
    assert isinstance(taken, Fault)
    return taken
