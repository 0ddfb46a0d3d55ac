"""swapcan: the CAN protocol of battery-swap heavy trucks, typed, on any python-can bus."""

from swapcan._generated.protocol import PROTOCOL
from swapcan.bus import Counts, Fault, Link, Received
from swapcan.codec import Codec, decode, encode
from swapcan.database import dbc_text, message_type
from swapcan.errors import (
    ChecksumError,
    DatabaseError,
    DecodeError,
    EncodeError,
    LengthError,
    ReceiveTimeoutError,
    RequestError,
    RequestTimeoutError,
    SendingError,
    SwapcanError,
    TransferError,
    UnknownFrameError,
    UnknownMessageError,
    UnknownNodeError,
)
from swapcan.message import Message, SignalState
from swapcan.node import (
    BatteryInfo,
    BusBack,
    BusLost,
    Event,
    Node,
    Overrun,
    Pending,
    SendFailed,
)
from swapcan.supervise import NotSeen, SignalChanged, State, StateChanged
from swapcan.transfer import CellVoltages, PackCode, ProbeTemperatures, Problem, Vin

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
    "NotSeen",
    "Overrun",
    "PackCode",
    "Pending",
    "ProbeTemperatures",
    "Problem",
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
