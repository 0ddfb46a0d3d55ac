"""A protocol as canonical text, one fact a line, for `git diff` of DBC files.

Every line says by itself what it is about, so that a hunk of a diff can be read without the lines
around it. The order of the file, its spacing and its encoding do not matter.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from typedcan.model.numbers import number
from typedcan.model.protocol import (
    Aspect,
    Message,
    Node,
    Protocol,
    Request,
    Signal,
    ValueTable,
)
from typedcan.model.transfer import Transfer
from typedcan.shell.printing import printable, printable_json

_Fact = tuple[str, object]
"""What is said, and the value: text is quoted, None and "" are left out."""


def textconv(protocol: Protocol) -> str:
    """The protocol as lines: messages by identifier, signals by place, codes by value.

    What the source of the protocol cannot say is left out, and so is the name of the whole: a
    DBC file without one is called by its file name, which git makes up.
    """
    return "".join(f"{printable(line)}\n" for line in _lines(protocol))


def _lines(protocol: Protocol) -> Iterator[str]:
    yield from _about("protocol", _protocol(protocol))
    for node in sorted(protocol.nodes, key=lambda node: node.name):
        yield from _about(f"node {node.name}", _node(node))
    for bus in sorted(protocol.buses, key=lambda bus: bus.name):
        facts: list[_Fact] = [("bit rate", bus.bit_rate), *_words(bus.title, bus.english)]
        yield from _about(
            f"bus {bus.name}", [*facts, *(("node", _Bare(name)) for name in sorted(bus.nodes))]
        )
    used = {signal.value_table for _, signal in protocol.signals()}
    for table in sorted(protocol.value_tables, key=lambda table: table.name):
        if table not in used:
            yield from _about(f"value table {table.name}", _codes(table))
    for message in sorted(protocol.messages, key=_by_identifier):
        yield from _about(message.name, _message(message, protocol.carries))
        for signal in sorted(message.signals, key=lambda each: (each.start, each.name)):
            yield from _about(f"{message.name} {signal.name}", _signal(signal, protocol.carries))
    for transfer in sorted(protocol.transfers, key=lambda each: each.name):
        yield from _about(f"transfer {transfer.name}", _transfer(transfer))
    for request in sorted(protocol.requests, key=lambda each: (each.signal, each.code)):
        yield from _about(f"request {request.signal} {request.code}", _request(request))


def _by_identifier(message: Message) -> tuple[bool, int, str]:
    return message.extended, message.frame_id, message.name


class _Bare(str):
    """A name or number that needs no quotes."""

    __slots__ = ()


def _about(subject: str, facts: Iterable[_Fact]) -> Iterator[str]:
    yield subject
    for name, value in facts:
        if value is not None and value != "":
            yield f"{subject}: {name} {_written(value)}"


def _written(value: object) -> str:
    bare = not isinstance(value, str) or (isinstance(value, _Bare) and value.isprintable())
    return str(value) if bare else printable_json(value)


def _words(title: str, english: str) -> list[_Fact]:
    """Title and translation, once where they are the same."""
    return [("title", title), ("english", english if english != title else "")]


def _names(fact: str, names: Iterable[str]) -> list[_Fact]:
    return [(fact, _Bare(name)) for name in names]


def _protocol(protocol: Protocol) -> list[_Fact]:
    return [
        ("number", protocol.number),
        ("edition", protocol.edition),
        *_words(protocol.title, protocol.english),
        ("frame format", _Bare(protocol.frame_format)),
    ]


def _node(node: Node) -> list[_Fact]:
    addresses = sorted(node.other_addresses)
    return [
        *_words(node.title, node.english),
        ("address", None if node.address is None else _Bare(f"0x{node.address:02X}")),
        *(("other address", _Bare(f"0x{address:02X}")) for address in addresses),
    ]


def _message(message: Message, carries: frozenset[Aspect]) -> list[_Fact]:
    width = "29 bits" if message.extended else "11 bits"
    facts: list[_Fact] = [
        ("identifier", _Bare(f"0x{message.frame_id:X}, {width}")),
        ("length", message.length),
        ("frame format", _Bare(message.frame_kind) if message.is_fd else None),
        ("found by", _Bare("PGN") if message.by_pgn else None),
        ("sender", _Bare(message.sender)),
        *_names("other sender", message.other_senders),
        *_words(message.title, message.english),
        ("condition", message.condition),
    ]
    if Aspect.PERIODS in carries:
        facts += [("send type", _Bare(message.send_type.name)), ("period", message.period)]
    for bits in message.reserved:
        place = f"{bits.byte_order.value} {bits.start}|{bits.length}"
        facts.append(("reserved bits", _Bare(f"{place}, sent as {bits.value}")))
    if check := message.checksum:
        facts.append(("checksum", _Bare(f"{check.signal} {check}")))
    if counter := message.counter:
        facts.append(("counter", _Bare(f"{counter.signal} {counter}")))
    return [*facts, ("reference", message.reference), *_names("erratum", message.errata)]


def _signal(signal: Signal, carries: frozenset[Aspect]) -> list[_Fact]:
    kind = "float" if signal.is_float else "signed" if signal.signed else "unsigned"
    facts: list[_Fact] = [
        ("start bit", signal.start),
        ("length", signal.length),
        ("order", _Bare(signal.byte_order.value)),
        ("type", _Bare(kind)),
        ("factor", _Bare(number(signal.factor))),
        ("offset", _Bare(number(signal.offset))),
        ("minimum", _Bare(number(signal.minimum))),
        ("maximum", _Bare(number(signal.maximum))),
        ("unit", signal.unit),
        *_names("receiver", sorted(signal.receivers)),
        ("selects", "the layout" if signal.is_selector else None),
        *((f"present where {signal.multiplexer} is", raw) for raw in sorted(signal.selectors)),
        *_words(signal.title, signal.english),
    ]
    if Aspect.START_VALUES in carries:
        facts.append(("start value", signal.start_value))
    if Aspect.PYTHON_NAMES in carries:
        facts.append(("field", _Bare(signal.python_name)))
    facts += [
        ("invalid code", signal.invalid_code),
        ("abnormal code", signal.abnormal_code),
        *_acts(signal),
        ("reference", signal.reference),
        *_names("erratum", signal.errata),
    ]
    if (table := signal.value_table) is None:
        return facts
    named = Aspect.VALUE_TABLE_NAMES in carries
    return [*facts, ("value table", _Bare(table.name) if named else None), *_codes(table)]


def _acts(signal: Signal) -> Iterator[_Fact]:
    if acting := signal.acting:
        for code in acting.codes:
            yield f"code that acts as {acting.kind}", code
        yield "safe code", acting.safe
        yield "place of the codes that act", acting.reference


def _codes(table: ValueTable) -> Iterator[_Fact]:
    for code in sorted(table.codes, key=lambda code: code.value):
        yield f"code {code.value} is", code.label
        if code.english != code.label:
            yield f"code {code.value} in English is", code.english


def _transfer(transfer: Transfer) -> list[_Fact]:
    facts: list[_Fact] = []
    for name, value in transfer.given().items():
        words = name.replace("_", " ")
        if isinstance(value, tuple):
            facts += _names(words.removesuffix("s"), map(str, value))
        elif name != "name":
            bare = isinstance(value, str) and name != "english"
            facts.append((words, _Bare(value) if bare else value))
    return facts


def _request(request: Request) -> list[_Fact]:
    return [("withdrawn by", request.withdraw), *_names("answer", request.answers)]
