"""A second protocol, known by its DBC alone: 11 bits and 29, with and without periods."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import can
import cantools
from cantools.database.can import Database
from monitor.monitored import Monitored

from typedcan.databases.dbc import read_database
from typedcan.dynamic import typed_protocol
from typedcan.monitor.watch import Watch
from typedcan.wire.codec import Codec

MACHINE = Path(__file__).with_name("machine.dbc")
CODEC = Codec(typed_protocol(read_database(MACHINE)))


@cache
def _dbc() -> Database:
    database = cantools.database.load_file(MACHINE)
    assert isinstance(database, Database)
    return database


def frame(name: str, at: float = 0.0, **signals: float) -> can.Message:
    """A frame of a message, by cantools; signals that are not given are 0, but for branches."""
    message = _dbc().get_message_by_name(name)
    always = {each.name: each.offset for each in message.signals if not each.multiplexer_ids}
    values = always | signals
    return can.Message(
        arbitration_id=message.frame_id,
        is_extended_id=message.is_extended_frame,
        data=message.encode(values),
        timestamp=at,
    )


def machine(bitrate: float | None = None) -> Monitored:
    """A session that watches the machine from 0 s on."""
    return Monitored(Watch(0.0, CODEC, bitrate=bitrate))
