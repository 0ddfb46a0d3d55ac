"""swapcan: the CAN protocol of battery-swap heavy trucks, typed, on any python-can bus."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from swapcan._generated.protocol import PROTOCOL
from swapcan.wire import Codec, Link, SwapcanError, dbc_text, decode, encode, message_type
from typedcan.wire.errors import (
    ChecksumError,
    DatabaseError,
    DecodeError,
    EncodeError,
    LengthError,
    ReceiveTimeoutError,
    RequestError,
    RequestTimeoutError,
    SendingError,
    StillActingError,
    TransferError,
    UnknownFrameError,
    UnknownMessageError,
    UnknownNodeError,
)
from typedcan.wire.link import Counts, Fault, Received
from typedcan.wire.message import Message, SignalState

# Live nodes are imported when they are used: a program that decodes a frame starts without them.
# All names, with their types, stand in __init__.pyi.
_HOMES = {
    "BatteryInfo": "swapcan.node",
    "BusBack": "swapcan.node",
    "BusLost": "swapcan.node",
    "Event": "swapcan.node",
    "Node": "swapcan.node",
    "NodeFailed": "swapcan.node",
    "Overrun": "swapcan.node",
    "Pending": "swapcan.node",
    "ReceiveFailed": "swapcan.node",
    "SendFailed": "swapcan.node",
    "NotSeen": "typedcan.supervise",
    "SignalChanged": "typedcan.supervise",
    "State": "typedcan.supervise",
    "StateChanged": "typedcan.supervise",
    "CellVoltages": "swapcan.transfer",
    "PackCode": "swapcan.transfer",
    "ProbeTemperatures": "swapcan.transfer",
    "Problem": "swapcan.transfer",
    "Vin": "swapcan.transfer",
}

__all__ = [
    "PROTOCOL",
    "BatteryInfo",
    "BusBack",
    "BusLost",
    "CellVoltages",
    "ChecksumError",
    "Codec",
    "Counts",
    "DatabaseError",
    "DecodeError",
    "EncodeError",
    "Event",
    "Fault",
    "LengthError",
    "Link",
    "Message",
    "Node",
    "NodeFailed",
    "NotSeen",
    "Overrun",
    "PackCode",
    "Pending",
    "ProbeTemperatures",
    "Problem",
    "ReceiveFailed",
    "ReceiveTimeoutError",
    "Received",
    "RequestError",
    "RequestTimeoutError",
    "SendFailed",
    "SendingError",
    "SignalChanged",
    "SignalState",
    "State",
    "StateChanged",
    "StillActingError",
    "SwapcanError",
    "TransferError",
    "UnknownFrameError",
    "UnknownMessageError",
    "UnknownNodeError",
    "Vin",
    "dbc_text",
    "decode",
    "encode",
    "message_type",
]


def __getattr__(name: str) -> Any:
    """A name of live nodes, from the module that has it."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value
