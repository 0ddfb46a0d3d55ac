"""The model to DBC text, in the one shape that every known reader takes the same way."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal

from dbcspec.emit.templating import template
from dbcspec.model import (
    Bus,
    ByteOrder,
    Message,
    Protocol,
    SendType,
    Signal,
    ValueTable,
)

NOBODY = "Vector__XXX"
_EXTENDED = 0x8000_0000
_FRAME_FORMATS = ("StandardCAN", "ExtendedCAN", "reserved", "J1939PG")
_SEND_TYPES = tuple(
    {0: "Cyclic", 7: "IfActive", 8: "NoMsgSendType"}.get(index, "NotUsed") for index in range(9)
)
_LARGEST_INT = 2**31 - 1


@dataclass(frozen=True, slots=True)
class Attribute:
    """An attribute definition: object keyword, name, type as DBC writes it, default."""

    on: str
    name: str
    type: str
    default: str


def emit_dbc(protocol: Protocol, *, bus: Bus | None = None, english: bool = True) -> str:
    """Render a protocol, or the part of it on one bus, as DBC text with CRLF line ends.

    With ``english`` comments and labels are the English ones, else those of the standard. The
    text is what `dbcspec.lint` passes; it checks nothing.
    """
    part = _on_bus(protocol, bus) if bus else protocol
    rates = {each.bit_rate for each in ([bus] if bus else protocol.buses)}
    text = template("dbc.j2").render(
        protocol=part,
        digest=protocol.digest,
        db_name=(f"{protocol.name}-{bus.name}" if bus else protocol.name).replace("-", "_"),
        bit_rate=rates.pop() if len(rates) == 1 else None,
        attributes=_attributes(protocol),
        defaults={each.name: each.default for each in _attributes(protocol)},
        value_tables=[_value_table(table, english=english) for table in part.value_tables],
        number=number,
        english=english,
        dbc_id=dbc_id,
        signal_line=_signal_line,
        messages_values=list(_values(part, english=english)),
        frame_format=_FRAME_FORMATS.index(part.frame_format),
        nobody=NOBODY,
    )
    return text.replace("\n", "\r\n")


def dbc_id(message: Message) -> int:
    """The identifier as BO_ has it: bit 31 marks an extended frame."""
    return message.frame_id | _EXTENDED if message.extended else message.frame_id


def number(value: Decimal) -> str:
    """A plain decimal: leading digit, no exponent, no trailing zeros."""
    plain = format(value.normalize(), "f")
    return "0" if plain == "-0" else plain


def _signal_line(signal: Signal) -> str:
    order = 1 if signal.byte_order is ByteOrder.INTEL else 0
    sign = "-" if signal.signed else "+"
    receivers = ",".join(signal.receivers) or NOBODY
    return (
        f" SG_ {signal.name} : {signal.start}|{signal.length}@{order}{sign}"
        f" ({number(signal.factor)},{number(signal.offset)})"
        f" [{number(signal.minimum)}|{number(signal.maximum)}]"
        f' "{signal.unit}" {receivers}'
    )


def _value_table(table: ValueTable, *, english: bool) -> tuple[str, str]:
    return table.name, " ".join(
        f'{value} "{label}"' for value, label in table.labels(english=english).items()
    )


def _values(protocol: Protocol, *, english: bool) -> Iterator[tuple[Message, Signal, str]]:
    for message, signal in protocol.signals():
        if signal.value_table:
            yield message, signal, _value_table(signal.value_table, english=english)[1]


def _attributes(protocol: Protocol) -> list[Attribute]:
    longest_period = max([65535, *(message.period or 0 for message in protocol.messages)])
    frame_formats = ",".join(f'"{name}"' for name in _FRAME_FORMATS)
    send_types = ",".join(f'"{name}"' for name in _SEND_TYPES)
    return [
        Attribute("", "BusType", "STRING", '"CAN"'),
        Attribute("", "Baudrate", "INT 0 1000000", "250000"),
        Attribute("", "DBName", "STRING", '""'),
        Attribute("", "SpecDigest", "STRING", '""'),
        Attribute("BU_ ", "NmStationAddress", "INT 0 255", "254"),
        Attribute("BO_ ", "GenMsgCycleTime", f"INT 0 {longest_period}", "0"),
        Attribute(
            "BO_ ", "GenMsgSendType", f"ENUM {send_types}", f'"{_SEND_TYPES[SendType.EVENT.value]}"'
        ),
        Attribute("BO_ ", "GenMsgILSupport", 'ENUM "No","Yes"', '"Yes"'),
        Attribute("BO_ ", "VFrameFormat", f"ENUM {frame_formats}", f'"{_FRAME_FORMATS[0]}"'),
        Attribute("SG_ ", "GenSigStartValue", f"INT 0 {_LARGEST_INT}", "0"),
        *(
            Attribute(on, name, "STRING", '""')
            for on in ("BO_ ", "SG_ ")
            for name in ("SpecReference", "SpecErrata")
        ),
    ]


def _on_bus(protocol: Protocol, bus: Bus) -> Protocol:
    """The messages that a node of the bus sends to another one of it."""

    def heard(signal: Signal) -> Signal:
        here = tuple(node for node in signal.receivers if node in bus.nodes)
        return dataclasses.replace(signal, receivers=here)

    messages = tuple(
        dataclasses.replace(message, signals=tuple(map(heard, message.signals)))
        for message in protocol.messages
        if message.sender in bus.nodes and set(message.receivers) & set(bus.nodes)
    )
    used = {sig.value_table for message in messages for sig in message.signals}
    return dataclasses.replace(
        protocol,
        nodes=tuple(node for node in protocol.nodes if node.name in bus.nodes),
        messages=messages,
        value_tables=tuple(table for table in protocol.value_tables if table in used),
    )
