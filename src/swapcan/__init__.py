"""swapcan: the CAN protocol of battery-swap heavy trucks, typed, on any python-can bus."""

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
    "DatabaseError",
    "DecodeError",
    "EncodeError",
    "LengthError",
    "Message",
    "ReceiveTimeoutError",
    "SignalState",
    "SwapcanError",
    "UnknownFrameError",
    "UnknownMessageError",
    "dbc_text",
    "decode",
    "encode",
    "message_type",
]
