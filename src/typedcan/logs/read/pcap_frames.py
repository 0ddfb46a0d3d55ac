"""The frame in a packet of SocketCAN."""

from __future__ import annotations

from typedcan.logs.read.frame import (
    BIT_RATE_SWITCH,
    ERROR,
    ERROR_STATE,
    EXTENDED,
    FD,
    LARGEST_ID,
    REMOTE,
    SENT,
    Frame,
    checked,
)
from typedcan.logs.read.pcap_blocks import Packet

_SOCKETCAN, _COOKED, _COOKED_2 = 227, 113, 276
LINKS = frozenset({_SOCKETCAN, _COOKED, _COOKED_2})
"""Link types of networks that may be CAN."""

_CAN, _CAN_FD = 0x000C, 0x000D
_OUTGOING = 4
_HEADER = 8
_IS_EXTENDED, _IS_REMOTE, _IS_ERROR = 0x8000_0000, 0x4000_0000, 0x2000_0000
_STANDARD_ID = 0x7FF
_BRS, _ESI, _FDF = 1, 2, 4
_FD_SIZE = 72


def frame_of(packet: Packet) -> Frame | None:
    """The frame in a packet, or None where it is of another network.

    Raises `ValueError` where it should be one and is none.
    """
    data, protocol, sent = packet.data, _CAN, packet.is_sent
    if packet.link == _COOKED:
        protocol = int.from_bytes(data[14:16])
        sent = sent or int.from_bytes(data[:2]) == _OUTGOING
        data = data[16:]
    elif packet.link == _COOKED_2:
        protocol = int.from_bytes(data[:2])
        sent = sent or data[10:11] == bytes([_OUTGOING])
        data = data[20:]
    elif packet.link != _SOCKETCAN:
        return None
    if protocol not in (_CAN, _CAN_FD):
        return None
    if len(data) < _HEADER:
        raise ValueError("a packet is too short for a frame")
    name = int.from_bytes(data[:4])
    length, bits = data[4], data[5]
    is_fd = protocol == _CAN_FD or bool(bits & _FDF) or len(data) == _FD_SIZE
    flags = SENT * sent | FD * is_fd
    flags |= EXTENDED * bool(name & _IS_EXTENDED) | ERROR * bool(name & _IS_ERROR)
    if is_fd:
        flags |= BIT_RATE_SWITCH * bool(bits & _BRS) | ERROR_STATE * bool(bits & _ESI)
    frame_id = name & (LARGEST_ID if name & (_IS_EXTENDED | _IS_ERROR) else _STANDARD_ID)
    channel = packet.interface.name
    if name & _IS_REMOTE and not is_fd:
        return checked(Frame(packet.time, frame_id, flags | REMOTE, channel, length, b""))
    payload = data[_HEADER : _HEADER + length]
    return checked(Frame(packet.time, frame_id, flags, channel, length, payload))
