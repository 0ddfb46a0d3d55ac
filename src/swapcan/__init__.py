"""swapcan: the CAN protocol of battery-swap heavy trucks, typed, on any python-can bus."""

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
    SwapcanError,
    UnknownFrameError,
    UnknownMessageError,
)
from swapcan.message import Message, SignalState

__all__ = [
    "ChecksumError",
    "Codec",
    "Counts",
    "DatabaseError",
    "DecodeError",
    "EncodeError",
    "Fault",
    "LengthError",
    "Link",
    "Message",
    "ReceiveTimeoutError",
    "Received",
    "SignalState",
    "SwapcanError",
    "UnknownFrameError",
    "UnknownMessageError",
    "dbc_text",
    "decode",
    "encode",
    "message_type",
]
