"""What two independent DBC readers find in a file, and what the model says, in one shape."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

import canmatrix.formats
import cantools
from cantools.database.can import Database
from cantools.database.can import Message as CantoolsMessage
from cantools.database.can import Node as CantoolsNode
from cantools.database.can import Signal as CantoolsSignal

from typedcan.model.protocol import Bus, ByteOrder, Message, Protocol, SendType, Signal

_SEND_TYPES = {
    SendType.CYCLIC: "Cyclic",
    SendType.IF_ACTIVE: "IfActive",
    SendType.EVENT: "NoMsgSendType",
}


@dataclass(frozen=True)
class NodeFacts:
    """A node."""

    address: int | None
    comment: str


@dataclass(frozen=True)
class MessageFacts:
    """A message, without its comment."""

    frame_id: int
    extended: bool
    length: int
    senders: tuple[str, ...]
    cycle_time: int
    send_type: str
    frame_format: str
    signals: frozenset[str]


@dataclass(frozen=True)
class SignalFacts:
    """A signal; ``start`` as DBC counts it: Motorola signals by their most significant bit."""

    start: int
    length: int
    intel: bool
    signed: bool
    factor: Decimal
    offset: Decimal
    minimum: Decimal
    maximum: Decimal
    unit: str
    codes: tuple[tuple[int, str], ...]
    receivers: frozenset[str]
    start_value: int
    comment: str


@dataclass(frozen=True)
class Facts:
    """All that a file says, by name; signals by message and name."""

    nodes: Mapping[str, NodeFacts]
    messages: Mapping[str, MessageFacts]
    signals: Mapping[tuple[str, str], SignalFacts]
    comments: Mapping[str, str]


def of_model(protocol: Protocol, bus: Bus | None, *, english: bool) -> Facts:
    """The model, or the part of it on one bus; comments of messages are left out."""
    here = bus.nodes if bus else tuple(node.name for node in protocol.nodes)
    messages = [
        message
        for message in protocol.messages
        if message.sender in here and not set(here).isdisjoint(message.receivers)
    ]
    return Facts(
        nodes={
            node.name: NodeFacts(node.address, node.english if english else node.title)
            for node in protocol.nodes
            if node.name in here
        },
        messages={message.name: _message_of_model(message) for message in messages},
        signals={
            (message.name, signal.name): _signal_of_model(signal, here, english=english)
            for message in messages
            for signal in message.signals
        },
        comments={},
    )


def _message_of_model(message: Message) -> MessageFacts:
    return MessageFacts(
        frame_id=message.frame_id,
        extended=message.extended,
        length=message.length,
        senders=(message.sender,),
        cycle_time=message.period or 0,
        send_type=_SEND_TYPES[message.send_type],
        frame_format="ExtendedCAN",
        signals=frozenset(signal.name for signal in message.signals),
    )


def _signal_of_model(signal: Signal, here: Iterable[str], *, english: bool) -> SignalFacts:
    codes = signal.value_table.codes if signal.value_table else ()
    return SignalFacts(
        start=signal.start,
        length=signal.length,
        intel=signal.byte_order is ByteOrder.INTEL,
        signed=signal.signed,
        factor=signal.factor,
        offset=signal.offset,
        minimum=signal.minimum,
        maximum=signal.maximum,
        unit=signal.unit,
        codes=tuple((code.value, code.english if english else code.label) for code in codes),
        receivers=frozenset(here).intersection(signal.receivers),
        start_value=signal.start_value,
        comment=signal.english if english else signal.title,
    )


def by_cantools(path: Path, encoding: str) -> Facts:
    """The file as cantools reads it, overlaps and impossible lengths refused."""
    dbc = cantools.database.load_file(path, encoding=encoding, strict=True)
    assert isinstance(dbc, Database)
    return Facts(
        nodes={node.name: _node_by_cantools(node) for node in dbc.nodes},
        messages={message.name: _message_by_cantools(message) for message in dbc.messages},
        signals={
            (message.name, signal.name): _signal_by_cantools(signal)
            for message in dbc.messages
            for signal in message.signals
        },
        comments={message.name: message.comment or "" for message in dbc.messages},
    )


def _node_by_cantools(node: CantoolsNode) -> NodeFacts:
    assert node.dbc
    return NodeFacts(int(node.dbc.attributes["NmStationAddress"].value), node.comment or "")


def _message_by_cantools(message: CantoolsMessage) -> MessageFacts:
    assert message.dbc
    frame_format = message.dbc.attributes["VFrameFormat"]
    return MessageFacts(
        frame_id=message.frame_id,
        extended=message.is_extended_frame,
        length=message.length,
        senders=tuple(message.senders),
        cycle_time=message.cycle_time or 0,
        send_type=message.send_type or "",
        frame_format=frame_format.definition.choices[int(frame_format.value)],
        signals=frozenset(signal.name for signal in message.signals),
    )


def _signal_by_cantools(signal: CantoolsSignal) -> SignalFacts:
    assert signal.raw_initial is not None
    return SignalFacts(
        start=signal.start,
        length=signal.length,
        intel=signal.byte_order == "little_endian",
        signed=signal.is_signed,
        factor=Decimal(str(signal.scale)),
        offset=Decimal(str(signal.offset)),
        minimum=Decimal(str(signal.minimum)),
        maximum=Decimal(str(signal.maximum)),
        unit=signal.unit or "",
        codes=tuple((code, str(label)) for code, label in (signal.choices or {}).items()),
        receivers=frozenset(signal.receivers),
        start_value=int(signal.raw_initial),
        comment=signal.comment or "",
    )


def by_canmatrix(path: Path, encoding: str) -> Facts:
    """The file as canmatrix reads it."""
    options = {"dbcImportEncoding": encoding, "dbcImportCommentEncoding": encoding}
    dbc: Any = canmatrix.formats.loadp_flat(str(path), **options)
    assert dbc.load_errors == []
    return Facts(
        nodes={ecu.name: _node_by_canmatrix(ecu) for ecu in dbc.ecus},
        messages={frame.name: _message_by_canmatrix(frame, dbc) for frame in dbc.frames},
        signals={
            (frame.name, signal.name): _signal_by_canmatrix(signal)
            for frame in dbc.frames
            for signal in frame.signals
        },
        comments={frame.name: frame.comment or "" for frame in dbc.frames},
    )


def _node_by_canmatrix(ecu: Any) -> NodeFacts:
    return NodeFacts(int(ecu.attributes["NmStationAddress"]), ecu.comment or "")


def _message_by_canmatrix(frame: Any, dbc: Any) -> MessageFacts:
    return MessageFacts(
        frame_id=frame.arbitration_id.id,
        extended=bool(frame.arbitration_id.extended),
        length=frame.size,
        senders=tuple(frame.transmitters),
        cycle_time=int(frame.cycle_time),
        send_type=str(frame.attribute("GenMsgSendType", dbc)),
        frame_format=str(frame.attribute("VFrameFormat", dbc)),
        signals=frozenset(signal.name for signal in frame.signals),
    )


def _signal_by_canmatrix(signal: Any) -> SignalFacts:
    return SignalFacts(
        # Inside, canmatrix counts the bits of a byte from the left; 1 asks for the DBC's count.
        start=signal.get_startbit(bit_numbering=1),
        length=signal.size,
        intel=signal.is_little_endian,
        signed=signal.is_signed,
        factor=Decimal(signal.factor),
        offset=Decimal(signal.offset),
        minimum=Decimal(signal.min),
        maximum=Decimal(signal.max),
        unit=signal.unit,
        codes=tuple(sorted((int(code), label) for code, label in signal.values.items())),
        receivers=frozenset(signal.receivers),
        start_value=int(signal.attributes["GenSigStartValue"]),
        comment=signal.comment or "",
    )
