"""The model to typed Python: enums, message classes, and the functions that decode them fast."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass

from dbcspec.emit.dbc import number
from dbcspec.emit.kinds import Kind, enums, kind_of
from dbcspec.emit.templating import template
from dbcspec.layout import whole_byte
from dbcspec.model import ByteOrder, Message, Protocol, Signal, ValueTable
from dbcspec.naming import member_names

_WIDTH = 92
_LONGEST_LINE = 100
_TABLE_BITS = 10


@dataclass(frozen=True, slots=True)
class _StubField:
    """A signal, and what the templates write for it."""

    signal: Signal
    kind: Kind
    annotation: str
    default: str
    doc: str
    expression: str
    arguments: tuple[tuple[str, str], ...]


def emit_stubs(protocol: Protocol, runtime: str) -> dict[str, str]:
    """Render the modules of a stub package, file name to text.

    ``runtime`` is the package whose ``message`` module has the base classes.
    """
    stubs = [(message, _fields(message)) for message in protocol.messages]
    tables = enums(protocol.messages)
    fields = [field for _, fields in stubs for field in fields]
    labelled = {
        field.signal.value_table: _labels_name(field.signal.value_table)
        for field in fields
        if field.signal.value_table and field.kind in (Kind.LABELLED, Kind.CHARACTER)
    }
    base = {"Field", "Message", "SignalState", "fields_by_name"}
    base |= {"Checksum" for message in protocol.messages if message.checksum}
    base |= {"Counter" for message in protocol.messages if message.counter}
    context = {
        "protocol": protocol,
        "runtime": runtime,
        "stubs": stubs,
        "enums": [(table, _members(table), _enum_doc(users)) for table, users in tables.items()],
        "labelled": labelled,
        "code_tables": _code_tables(stubs),
        "imports": sorted(base | {field.kind.value for field in fields}, key=_import_order),
        "used_enums": sorted((table.name for table in tables), key=str.lower),
        "doc": _message_doc,
        "whole_byte": whole_byte,
        "signal_of": lambda message, name: next(s for s in message.signals if s.name == name),
        "quote": quote,
        "assigned": _assigned,
        "receivers": _receivers,
    }
    return {
        name: template(f"{name}.j2").render(context)
        for name in ("__init__.py", "enums.py", "messages.py", "decoders.py")
    }


def quote(text: str) -> str:
    """A string literal as the formatter wants it."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _import_order(name: str) -> tuple[bool, str]:
    """Classes before functions, as import sorters have it."""
    return name[0].islower(), name.lower()


def _assigned(target: str, value: str) -> str:
    """An assignment in a block, in parentheses where it is too long, as the formatter wants it."""
    line = f"    {target} = {value}"
    return line if len(line) <= _LONGEST_LINE else f"    {target} = (\n        {value}\n    )"


def _receivers(message: Message) -> str:
    """The class variable with the receivers, one a line where they are too many for one."""
    target = "    RECEIVERS: ClassVar[tuple[str, ...]] ="
    names = [quote(name) for name in message.receivers]
    line = f"{target} ({', '.join(names)}{',' if len(names) == 1 else ''})"
    if len(line) <= _LONGEST_LINE:
        return line
    return "\n".join((f"{target} (", *(f"        {name}," for name in names), "    )"))


def _fields(message: Message) -> list[_StubField]:
    ordered = sorted(message.signals, key=_bit_order)
    return [_field(message, signal, index) for index, signal in enumerate(ordered)]


def _bit_order(signal: Signal) -> int:
    """The order in which a DBC reader lists signals: by start bit, bytes from the left."""
    from_left = 8 * (signal.start // 8) + 7 - signal.start % 8
    return signal.start if signal.byte_order is ByteOrder.INTEL else from_left


def _field(message: Message, signal: Signal, index: int) -> _StubField:
    kind = kind_of(message, signal)
    return _StubField(
        signal=signal,
        kind=kind,
        annotation=_annotation(signal, kind),
        default=_default(signal, kind),
        doc=_field_doc(signal),
        expression=_expression(signal, kind, f"v[{index}]"),
        arguments=tuple(_arguments(signal, kind)),
    )


def _states(signal: Signal) -> dict[int, str]:
    pairs = ((signal.invalid_code, "INVALID"), (signal.abnormal_code, "ABNORMAL"))
    return {code: state for code, state in pairs if code is not None}


def _annotation(signal: Signal, kind: Kind) -> str:
    state = " | SignalState" if _states(signal) else ""
    if kind is Kind.LABELLED:
        return f"{_enum_name(signal)} | int"
    return {
        Kind.PHYSICAL: f"float{state}",
        Kind.NUMBER: f"int{state}",
        Kind.CHARACTER: "str | int",
        Kind.FILLED: f"int{state} | None",
    }[kind]


def _default(signal: Signal, kind: Kind) -> str:
    raw = signal.start_value
    if kind is Kind.FILLED:
        return "None"
    if kind is Kind.LABELLED and signal.value_table:
        member = _members(signal.value_table).get(raw)
        return f"{_enum_name(signal)}.{member}" if member else str(raw)
    if raw in _states(signal):
        return f"SignalState.{_states(signal)[raw]}"
    return repr(_physical(signal, raw)) if kind is Kind.PHYSICAL else str(raw)


def _physical(signal: Signal, raw: int) -> float:
    """In the arithmetic of the decoder, so that limits hold to the last bit."""
    return raw * float(signal.factor) + float(signal.offset)


def _expression(signal: Signal, kind: Kind, raw: str) -> str:
    """Python that turns a raw value into the field's."""
    if kind in (Kind.LABELLED, Kind.CHARACTER):
        table = _code_table_name(signal)
        return f"{table}[{raw}]" if signal.length <= _TABLE_BITS else f"{table}.get({raw}, {raw})"
    value = raw
    if kind is Kind.PHYSICAL:
        value = f"{raw} * {float(signal.factor)!r}" if signal.factor != 1 else f"float({raw})"
        if signal.offset:
            start = raw if signal.factor == 1 else value
            sign = "-" if signal.offset < 0 else "+"
            value = f"{start} {sign} {abs(float(signal.offset))!r}"
    for code, state in reversed(_states(signal).items()):
        value = f"{state} if {raw} == {code} else {value}"
    return value


def _arguments(signal: Signal, kind: Kind) -> list[tuple[str, str]]:
    """Keyword arguments of the runtime field, those with a default left out."""
    arguments = [
        ("name", quote(signal.python_name)),
        ("dbc_name", quote(signal.name)),
        ("title", quote(signal.english)),
    ]
    if signal.unit:
        arguments.append(("unit", quote(signal.unit)))
    arguments += [("reference", quote(signal.reference)), ("length", str(signal.length))]
    low, high = signal.raw_range
    if kind is Kind.PHYSICAL:
        arguments += [
            ("factor", repr(float(signal.factor))),
            ("offset", repr(float(signal.offset))),
            ("minimum", repr(_physical(signal, low))),
            ("maximum", repr(_physical(signal, high))),
        ]
    else:
        arguments += [("minimum", str(low)), ("maximum", str(high))]
    if states := _states(signal):
        inner = ", ".join(f"{code}: SignalState.{state}" for code, state in states.items())
        arguments.append(("states", f"{{{inner}}}"))
    if kind in (Kind.LABELLED, Kind.CHARACTER) and signal.value_table:
        arguments.append(("labels", f"enums.{_labels_name(signal.value_table)}"))
    return arguments


def _enum_name(signal: Signal) -> str:
    return signal.value_table.name if signal.value_table else ""


def _labels_name(table: ValueTable) -> str:
    return "".join(f"_{c}" if c.isupper() and i else c for i, c in enumerate(table.name)).upper()


def _code_table_name(signal: Signal) -> str:
    table = signal.value_table
    return f"_{_labels_name(table)}_{signal.length}" if table else ""


def _code_tables(stubs: list[tuple[Message, list[_StubField]]]) -> list[tuple[str, str]]:
    """The look-up tables of the decoders: name and the expression that makes it."""
    tables: dict[str, str] = {}
    for _, fields in stubs:
        for field in fields:
            table = field.signal.value_table
            if table and field.kind in (Kind.LABELLED, Kind.CHARACTER):
                labelled = field.kind is Kind.LABELLED
                source = f"enums.{table.name if labelled else _labels_name(table)}"
                if field.signal.length <= _TABLE_BITS:
                    source = f"code_table({source}, {field.signal.length})"
                elif labelled:
                    source = f"{{member.value: member for member in {source}}}"
                tables[_code_table_name(field.signal)] = source
    return sorted(tables.items())


def _members(table: ValueTable) -> dict[int, str]:
    return member_names([(code.value, code.english) for code in table.codes])


def _enum_doc(users: tuple[Signal, ...]) -> str:
    first, *others = users
    more = f" and {len(others)} more" if others else ""
    return f"Codes of {first.name}{more}, {first.reference}."


def _field_doc(signal: Signal) -> str:
    english = signal.english or signal.title or signal.name
    title = f" ({signal.title})" if signal.title not in ("", english) else ""
    unit = f" {signal.unit}" if signal.unit else ""
    limits = f"{number(signal.minimum)} to {number(signal.maximum)}{unit}"
    text = f"{english}{title}: {limits}. {signal.name}, {signal.reference}."
    return _wrapped(text)


def _message_doc(message: Message) -> str:
    when = f", every {message.period} ms" if message.period else ""
    while_ = f", sent {message.condition}" if message.condition else ""
    route = f"{message.sender} to {' and '.join(message.receivers)}"
    facts = f"Identifier 0x{message.frame_id:08X}, {route}{when}{while_}. {message.reference}."
    title = f"{message.title}.\n\n    " if message.title else ""
    return f"{message.english or message.name}.\n\n    {title}{_wrapped(facts)}"


def _wrapped(text: str) -> str:
    return "\n    ".join(
        textwrap.wrap(text, _WIDTH, break_long_words=False, break_on_hyphens=False)
    )
