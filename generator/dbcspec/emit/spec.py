"""The model to a first spec folder: YAML that reads back as the same protocol.

What a spec cannot say is left out: value tables that no signal has, errata, and references to a
standard, which a spec makes from its own tables.
"""

from __future__ import annotations

import re
from collections import Counter as Counts
from collections.abc import Collection, Iterator

from dbcspec.emit.spec_database import database_lines
from dbcspec.emit.spec_yaml import Pairs, flow_entries, list_lines, mapping_lines, scalar
from typedcan.model.acting import usual_start
from typedcan.model.layout import float_limits
from typedcan.model.naming import field_name, shared_prefix, unused
from typedcan.model.numbers import number
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import ByteOrder, Message, Protocol, SendType, Signal, ValueTable

_TYPES = {SendType.CYCLIC: "Cyclic", SendType.IF_ACTIVE: "IfActive", SendType.EVENT: "Event"}


def emit_spec(protocol: Protocol) -> dict[str, bytes]:
    """The files of a spec folder, path below it to bytes in UTF-8.

    One table per message; a signal whose name several messages have gets its row for each.
    """
    names = Counts(signal.name for _, signal in protocol.signals())
    repeated = {name for name, count in names.items() if count > 1}
    with_signals = [message for message in protocol.messages if message.signals]
    width = max(2, len(str(len(with_signals))))
    files = {
        "standard.yaml": _standard(protocol, repeated),
        "messages.yaml": _messages(protocol),
        "behaviour.yaml": _behaviour(protocol, repeated),
    }
    if lines := database_lines(protocol):
        files["database.yaml"] = iter(lines)
    for count, message in enumerate(with_signals, start=1):
        files[f"tables/{count:0{width}}-{message.name}.yaml"] = _table(message, count, repeated)
    return {name: ("\n".join(lines) + "\n").encode("utf-8") for name, lines in files.items()}


def _standard(protocol: Protocol, repeated: set[str]) -> Iterator[str]:
    yield "# The protocol, who takes part, on which buses, and the conventions of its tables."
    yield f"number: {scalar(protocol.number)}"
    yield f"title: {scalar(protocol.title)}"
    yield f"english: {scalar(protocol.english)}"
    if protocol.edition:
        yield f"edition: {scalar(protocol.edition)}"
    yield from _participants(protocol)
    yield f"frame_format: {protocol.frame_format}"
    yield "profile: foreign"
    if any(message.reserved for message in protocol.messages):
        yield f"reserved: [{_reserved_name(protocol)}]"
    for key, labels in _state_labels(protocol).items():
        if labels:
            yield f"{key}: [{', '.join(map(scalar, labels))}]"
    named = _named_tables(protocol, repeated)
    if named:
        yield "value_tables:"
        yield from (f"  {name}: {signal}" for name, signal in named.items())


def _participants(protocol: Protocol) -> Iterator[str]:
    yield from list_lines(
        "nodes",
        (
            [
                ("name", node.name),
                ("title", node.title or None),
                ("english", node.english),
                ("address", node.address),
                ("other_addresses", node.other_addresses or None),
            ]
            for node in protocol.nodes
        ),
    )
    yield from list_lines(
        "buses",
        (
            [
                ("name", re.sub(r"\W|^(?=\d)", "_", bus.name, flags=re.ASCII)),
                ("title", bus.title or None),
                ("english", bus.english),
                ("bit_rate", bus.bit_rate),
                ("nodes", bus.nodes),
            ]
            for bus in protocol.buses
        ),
    )


def _state_labels(protocol: Protocol) -> dict[str, list[str]]:
    """The labels of the codes that are invalid or abnormal."""
    found: dict[str, dict[str, None]] = {"invalid_labels": {}, "abnormal_labels": {}}
    for _, signal in protocol.signals():
        labels = signal.value_table.labels(english=False) if signal.value_table else {}
        states = (signal.invalid_code, signal.abnormal_code)
        for key, code in zip(found, states, strict=True):
            if code in labels:
                found[key][labels[code]] = None
    return {key: list(labels) for key, labels in found.items()}


def _named_tables(protocol: Protocol, repeated: set[str]) -> dict[str, str]:
    """Each value table with the first signal that has it."""
    users: dict[ValueTable, str] = {}
    for message, signal in protocol.signals():
        if signal.value_table:
            users.setdefault(signal.value_table, _signal_name(message, signal, repeated))
    first = [table for table in protocol.value_tables if table in users]
    return {table.name: users[table] for table in dict.fromkeys((*first, *users))}


def _signal_name(message: Message, signal: Signal, repeated: set[str]) -> str:
    return f"{message.name}.{signal.name}" if signal.name in repeated else signal.name


def _messages(protocol: Protocol) -> Iterator[str]:
    orders = Counts(signal.byte_order for _, signal in protocol.signals())
    usual = orders.most_common(1)[0][0] if orders else ByteOrder.INTEL
    yield "# The layout of the frames."
    yield "annex: messages"
    yield f"byte_order: {usual.value}"
    yield "messages:" if protocol.messages else "messages: []"
    for message in protocol.messages:
        yield from message_lines(message, protocol, usual)


def message_lines(message: Message, protocol: Protocol, usual: ByteOrder) -> Iterator[str]:
    """An entry of messages.yaml; the protocol tells what goes without saying."""
    extended = protocol.frame_format != "StandardCAN"
    by_pgn = message.extended and protocol.frame_format == "J1939PG"
    orders = Counts(signal.byte_order for signal in message.signals)
    order = orders.most_common(1)[0][0] if orders else usual
    yield f"  - id: 0x{message.frame_id:X}"
    yield from mapping_lines(
        4,
        [
            ("name", message.name),
            ("english", message.english or (None if message.signals else message.title) or None),
            ("length", message.length),
            ("type", _TYPES[message.send_type]),
            ("period", message.period or 0),
            ("byte_order", order.value if order is not usual else None),
            ("extended", ("no", "yes")[message.extended] if message.extended != extended else None),
            ("by_pgn", ("no", "yes")[message.by_pgn] if message.by_pgn != by_pgn else None),
            ("fd", "yes" if message.is_fd else None),
            ("bit_rate_switch", "no" if message.is_fd and not message.bit_rate_switch else None),
            ("sender", message.sender or None if not message.signals else None),
            ("other_senders", message.other_senders or None),
        ],
    )
    prefixes = (f"{message.name}_", shared_prefix([signal.name for signal in message.signals]))
    yield "    signals:" if message.signals or message.reserved else "    signals: []"
    for signal in message.signals:
        yield f"      - {{{flow_entries(field_pairs(signal, order, prefixes))}}}"
    for bits in message.reserved:
        own_order = bits.byte_order.value if bits.byte_order is not order else None
        place: Pairs = [("length", bits.length), ("start", bits.start), ("byte_order", own_order)]
        yield f"      - {{{flow_entries([('name', _reserved_name(protocol)), *place])}}}"


def _reserved_name(protocol: Protocol) -> str:
    """What fields are called that are no signals."""
    return unused("Reserved", {signal.name for _, signal in protocol.signals()})


def field_pairs(signal: Signal, order: ByteOrder, prefixes: tuple[str, ...]) -> Pairs:
    """A signal's place in its message, whose byte order is given, as messages.yaml has it."""
    derived = field_name(signal.name, prefixes)
    kind = "float" if signal.is_float else "signed"
    usual = usual_start(signal.invalid_code, signal.acting)
    return [
        ("name", signal.name),
        ("length", signal.length),
        ("start", signal.start),
        ("field", signal.python_name if signal.python_name not in ("", derived) else None),
        ("byte_order", signal.byte_order.value if signal.byte_order is not order else None),
        ("type", kind if signal.signed or signal.is_float else None),
        ("initial", signal.start_value if signal.start_value != usual else None),
        ("selector", "yes" if signal.is_selector else None),
        ("multiplexer", signal.multiplexer or None),
        ("selectors", signal.selectors or None),
    ]


def _table(message: Message, count: int, repeated: set[str]) -> Iterator[str]:
    yield f"number: {count}"
    yield f"title: {scalar(message.title)}"
    yield f"english: {scalar(message.english)}"
    yield f'clause: "{count}"'
    yield "rows:"
    for row, signal in enumerate(message.signals, start=1):
        yield f"  - no: {row}"
        yield from mapping_lines(4, row_pairs(message, signal, repeated))


def row_pairs(message: Message, signal: Signal, repeated: Collection[str]) -> Pairs:
    """A row of a table; with its message where the signal's name is ``repeated`` in another."""
    limits = signal.minimum, signal.maximum
    is_open = signal.is_float and limits == float_limits(signal.length)
    codes = signal.value_table.codes if signal.value_table else ()
    english = {code.value: code.english for code in codes if code.english != code.label}
    return [
        ("name", signal.name),
        ("message", message.name if signal.name in repeated else None),
        ("title", signal.title or None),
        ("english", signal.english or None),
        ("length", signal.length),
        ("codes", {code.value: code.label for code in codes} or None),
        ("english_codes", english or None),
        ("factor", number(signal.factor)),
        ("offset", number(signal.offset)),
        ("unit", signal.unit),
        ("range", None if is_open else f"{number(signal.minimum)}~{number(signal.maximum)}"),
        ("route", f"{message.sender or '-'}>{','.join(signal.receivers) or '-'}"),
    ]


def _behaviour(protocol: Protocol, repeated: set[str]) -> Iterator[str]:
    yield "# What happens on the bus beyond the layout."
    messages = protocol.messages
    sections: dict[str, list[Pairs]] = {
        "checksums": [
            _checksum(checksum, _carrier(message, checksum.signal, repeated))
            for message in messages
            if (checksum := message.checksum)
        ],
        "counters": [
            _counter(counter, _carrier(message, counter.signal, repeated))
            for message in messages
            if (counter := message.counter)
        ],
        "transfers": [list(transfer.given().items()) for transfer in protocol.transfers],
        "requests": [
            [
                ("signal", request.signal),
                ("code", request.code),
                ("withdraw", request.withdraw),
                ("answers", request.answers),
            ]
            for request in protocol.requests
        ],
        "acts": list(_acts(protocol, repeated)),
        "timing": [
            [
                ("name", message.name),
                ("condition", message.condition),
                ("messages", (message.name,)),
            ]
            for message in messages
            if message.condition
        ],
    }
    for key, rows in sections.items():
        yield from list_lines(key, rows) if rows else [f"{key}: []"]
    if any(bits.value for message in messages for bits in message.reserved):
        yield "padding: {reserved: 1}"


def _carrier(message: Message, name: str, repeated: set[str]) -> str:
    return f"{message.name}.{name}" if name in repeated else name


def _checksum(checksum: Checksum, signal: str) -> Pairs:
    return [
        ("signal", signal),
        ("algorithm", checksum.algorithm),
        ("open", "yes" if checksum.is_open else None),
        ("bytes", checksum.covers()),
        ("before", checksum.before or None),
        ("after", checksum.after or None),
        ("data_ids", checksum.data_ids or None),
    ]


def _counter(counter: Counter, signal: str) -> Pairs:
    if (counter.first, counter.step) == (0, 1):
        return [("signal", signal), ("modulus", counter.modulus)]
    return [
        ("signal", signal),
        ("range", f"{counter.first}~{counter.last}"),
        ("step", counter.step),
    ]


def _acts(protocol: Protocol, repeated: set[str]) -> Iterator[Pairs]:
    for message, signal in protocol.signals():
        if acting := signal.acting:
            yield [
                ("signal", _signal_name(message, signal, repeated)),
                ("codes", acting.codes),
                ("safe", acting.safe),
                ("kind", acting.kind if acting.reports else None),
                ("cite", acting.reference or None),
            ]
