"""The model to DBC text, in the one shape that every known reader takes the same way."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from dbcspec.emit.extras import NOBODY, ExtraLines, dbc_id, default_of, quote, quoted_codes
from dbcspec.emit.long_names import LongName, shortened
from dbcspec.emit.multiplexing import marker, selector_lists
from dbcspec.emit.templating import template
from typedcan.model.layout import float_limits
from typedcan.model.numbers import number
from typedcan.model.protocol import (
    Aspect,
    Bus,
    ByteOrder,
    Message,
    Node,
    Protocol,
    SendType,
    Signal,
    ValueTable,
)

_FRAME_FORMATS = ("StandardCAN", "ExtendedCAN", "reserved", "J1939PG")
_FD_FRAME_FORMATS = (*_FRAME_FORMATS, *["reserved"] * 10, "StandardCAN_FD", "ExtendedCAN_FD")
_SEND_TYPES = tuple(
    {0: "Cyclic", 7: "IfActive", 8: "NoMsgSendType"}.get(index, "NotUsed") for index in range(9)
)
_LARGEST_INT = 2**31 - 1


@dataclass(frozen=True, slots=True)
class Attribute:
    """An attribute definition: object keyword, name, type and default as DBC writes them."""

    on: str
    name: str
    type: str
    default: str | None
    aspect: Aspect | None = None


def emit_dbc(protocol: Protocol, *, bus: Bus | None = None, english: bool = True) -> str:
    """Render a protocol, or the part of it on one bus, as DBC text with CRLF line ends.

    With ``english`` comments and labels are the English ones, else those of the standard; where a
    text is missing in one language it is that of the other. Names longer than DBC allows get a
    short one and an attribute with the long one. Attributes are defined for what the protocol
    carries. The text is what `dbcspec.lint` passes; it checks nothing, see `foreign.dbc_faults`.
    """
    part, long_names = shortened(_on_bus(protocol, bus) if bus else protocol)
    rates = {each.bit_rate for each in ([bus] if bus else protocol.buses)}
    attributes = _attributes(protocol, long_names)
    extras = ExtraLines(part, {each.name: each.type for each in attributes})
    text = template("dbc.j2").render(
        protocol=part,
        digest=protocol.digest,
        db_name=(f"{protocol.name}-{bus.name}" if bus else protocol.name).replace("-", "_"),
        bus_type="CAN FD" if _has_fd(part) else "CAN",
        bit_rate=rates.pop() if len(rates) == 1 else None,
        attributes=attributes,
        defaults={each.name: each.default for each in attributes if each.default is not None},
        extras=extras,
        value_tables=[_value_table(table, english=english) for table in part.value_tables],
        number=number,
        comment=_comments(english=english),
        quote=quote,
        dbc_id=dbc_id,
        signal_line=_signal_line,
        messages_values=list(_values(part, english=english)),
        float_type=lambda signal: 2 if signal.length == 64 else 1,
        selector_lists=selector_lists,
        frame_format=_frame_format,
        long_names=long_names,
        nobody=NOBODY,
    )
    return text.replace("\n", "\r\n")


def _signal_line(signal: Signal) -> str:
    order = 1 if signal.byte_order is ByteOrder.INTEL else 0
    sign = "-" if signal.signed else "+"
    receivers = ",".join(signal.receivers) or NOBODY
    return (
        f" SG_ {signal.name}{marker(signal)} : {signal.start}|{signal.length}@{order}{sign}"
        f" ({number(signal.factor)},{number(signal.offset)})"
        f" [{_limits(signal)}] {quote(signal.unit)} {receivers}"
    )


def _limits(signal: Signal) -> str:
    """Minimum and maximum; a float that may have any value has none, as plain decimals go."""
    if signal.is_float and (signal.minimum, signal.maximum) == float_limits(signal.length):
        return "0|0"
    return f"{number(signal.minimum)}|{number(signal.maximum)}"


def _comments(*, english: bool) -> Callable[[Protocol | Node | Message | Signal], str]:
    """The comment of each kind of object, in the other language where it must be."""

    def comment(item: Protocol | Node | Message | Signal) -> str:
        if isinstance(item, Message):
            return item.comment(english=english) or item.comment(english=not english)
        text = (item.english or item.title) if english else (item.title or item.english)
        known = (item.number, item.chosen) if isinstance(item, Protocol) else ()
        return ", ".join(part for part in (text, *known) if part)

    return comment


def _has_fd(protocol: Protocol) -> bool:
    return any(message.is_fd for message in protocol.messages)


def _frame_format(message: Message) -> int:
    """The index of VFrameFormat."""
    if message.is_fd:
        return _FD_FRAME_FORMATS.index("ExtendedCAN_FD" if message.extended else "StandardCAN_FD")
    extended = "J1939PG" if message.by_pgn else "ExtendedCAN"
    return _FRAME_FORMATS.index(extended if message.extended else "StandardCAN")


def _value_table(table: ValueTable, *, english: bool) -> tuple[str, str]:
    return table.name, quoted_codes(table.labels(english=english).items())


def _values(protocol: Protocol, *, english: bool) -> Iterator[tuple[Message, Signal, str]]:
    for message, signal in protocol.signals():
        if signal.value_table:
            yield message, signal, _value_table(signal.value_table, english=english)[1]


def _attributes(protocol: Protocol, long_names: list[LongName]) -> list[Attribute]:
    messages = protocol.messages
    longest_period = max([65535, *(message.period or 0 for message in messages)])
    fastest = max([1_000_000, *(bus.bit_rate for bus in protocol.buses)])
    starts = [signal.start_value for _, signal in protocol.signals()]
    lowest, highest = min([0, *starts]), max([_LARGEST_INT, *starts])
    formats = _FD_FRAME_FORMATS if _has_fd(protocol) else _FRAME_FORMATS
    event = _SEND_TYPES[SendType.EVENT.value]
    every = [
        Attribute("", "BusType", "STRING", '"CAN"'),
        Attribute("", "Baudrate", f"INT 0 {fastest}", "250000"),
        Attribute("", "DBName", "STRING", '""'),
        Attribute("", "SpecDigest", "STRING", '""'),
        Attribute("BU_ ", "NmStationAddress", "INT 0 255", "254", Aspect.ADDRESSES),
        Attribute("BO_ ", "GenMsgCycleTime", f"INT 0 {longest_period}", "0", Aspect.PERIODS),
        Attribute("BO_ ", "GenMsgSendType", _enum(_SEND_TYPES), f'"{event}"', Aspect.PERIODS),
        Attribute("BO_ ", "GenMsgILSupport", _enum(("No", "Yes")), '"Yes"'),
        Attribute("BO_ ", "VFrameFormat", _enum(formats), f'"{formats[0]}"'),
        *([Attribute("BO_ ", "CANFD_BRS", _enum("01"), '"1"')] if _has_fd(protocol) else []),
        Attribute("SG_ ", "GenSigStartValue", f"INT {lowest} {highest}", "0", Aspect.START_VALUES),
        *(
            Attribute(on, name, "STRING", '""', Aspect.REFERENCES)
            for on in ("BO_ ", "SG_ ")
            for name in ("SpecReference", "SpecErrata")
        ),
    ]
    kinds = {(name.message is not None, name.is_signal) for name in long_names}
    every += [Attribute(*_LONG[kind], "STRING", '""') for kind in sorted(kinds)]
    foreign = [each for each in protocol.definitions if not each.is_relation]
    names = {each.name for each in foreign}
    own = [each for each in every if each.aspect is None or each.aspect in protocol.carries]
    return [
        *(each for each in own if each.name not in names),
        *(
            Attribute(
                f"{each.of} " if each.of else "",
                each.name,
                each.type,
                None if each.default is None else default_of(each),
            )
            for each in foreign
        ),
    ]


_LONG = {
    (False, False): ("BU_ ", "SystemNodeLongSymbol"),
    (True, False): ("BO_ ", "SystemMessageLongSymbol"),
    (True, True): ("SG_ ", "SystemSignalLongSymbol"),
}
"""The attribute of a long name by whether it is of a message, and of a signal of it."""


def _enum(words: Iterable[str]) -> str:
    return "ENUM " + ",".join(f'"{word}"' for word in words)


def _on_bus(protocol: Protocol, bus: Bus) -> Protocol:
    """The messages that a node of the bus sends to another one of it."""

    def heard(signal: Signal) -> Signal:
        here = tuple(node for node in signal.receivers if node in bus.nodes)
        return dataclasses.replace(signal, receivers=here)

    messages = tuple(
        dataclasses.replace(message, signals=tuple(map(heard, message.signals)))
        for message in protocol.messages
        if set(message.senders) & set(bus.nodes) and set(message.receivers) & set(bus.nodes)
    )
    used = {sig.value_table for message in messages for sig in message.signals}
    return dataclasses.replace(
        protocol,
        nodes=tuple(node for node in protocol.nodes if node.name in bus.nodes),
        messages=messages,
        value_tables=tuple(table for table in protocol.value_tables if table in used),
    )
