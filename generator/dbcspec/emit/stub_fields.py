"""The fields of generated Python classes: what is written for each signal."""

from __future__ import annotations

import math
from dataclasses import dataclass

from dbcspec.emit.stub_acting import acting_codes
from dbcspec.emit.stub_branches import Conditions, conditions
from dbcspec.emit.stub_docs import field_doc, quote
from typedcan.model.kinds import Kind, kind_of
from typedcan.model.naming import member_names
from typedcan.model.protocol import ByteOrder, Message, Signal, ValueTable

_TABLE_BITS = 10
_CODE_BITS = 8
"""The runtime has types of codes for up to so many bits."""


@dataclass(frozen=True, slots=True)
class StubField:
    """A signal, and what the templates write for it.

    ``default`` is None where the field has to be given, ``says`` what the default states, if it
    is more than a number or that there is no value.
    """

    signal: Signal
    kind: Kind
    annotation: str
    default: str | None
    says: str
    doc: str
    expression: str
    arguments: tuple[tuple[str, str], ...]
    conditions: Conditions


def fields_of(message: Message) -> list[StubField]:
    """The fields of a message, in the order in which a DBC reader lists its signals."""
    ordered = sorted(message.signals, key=_bit_order)
    return [
        _field(message, signal, index, conditions(message, ordered, signal))
        for index, signal in enumerate(ordered)
    ]


def _bit_order(signal: Signal) -> int:
    """The order in which a DBC reader lists signals: by start bit, bytes from the left."""
    from_left = 8 * (signal.start // 8) + 7 - signal.start % 8
    return signal.start if signal.byte_order is ByteOrder.INTEL else from_left


def _field(message: Message, signal: Signal, index: int, when: Conditions) -> StubField:
    kind = kind_of(message, signal)
    absent = " | None" if when and kind is not Kind.FILLED else ""
    says = "" if when or kind is Kind.FILLED else _statement(signal)
    return StubField(
        signal=signal,
        kind=kind,
        annotation=_annotation(signal, kind) + absent,
        default="None" if when else None if signal.must_be_given else _default(signal, kind),
        says=says,
        doc=field_doc(signal, says),
        expression=_expression(signal, kind, f"v[{index}]"),
        arguments=tuple(_arguments(signal, kind)),
        conditions=when,
    )


def _states(signal: Signal) -> dict[int, str]:
    pairs = ((signal.invalid_code, "INVALID"), (signal.abnormal_code, "ABNORMAL"))
    return {code: state for code, state in pairs if code is not None}


def _annotation(signal: Signal, kind: Kind) -> str:
    state = " | SignalState" if _states(signal) else ""
    if kind is Kind.LABELLED:
        return f"{_enum_name(signal)} | {code_type(signal) or 'int'}"
    return {
        Kind.PHYSICAL: f"float{state}",
        Kind.FLOAT: "float",
        Kind.NUMBER: f"int{state}",
        Kind.CHARACTER: f"str | int{state}",
        Kind.FILLED: f"int{state} | None",
    }[kind]


def code_type(signal: Signal) -> str | None:
    """The type of the plain codes of a labelled field, which admits no other enum and no bool.

    None where there are too many codes to list, or negative ones: they are ``int``.
    """
    short = signal.length <= _CODE_BITS and not signal.signed
    return f"Code{signal.length}" if short else None


def _default(signal: Signal, kind: Kind) -> str:
    raw = signal.start_value
    if kind is Kind.FILLED:
        return "None"
    if kind is Kind.LABELLED and signal.value_table:
        member = members(signal.value_table).get(raw)
        return f"{_enum_name(signal)}.{member}" if member else str(raw)
    if kind is Kind.FLOAT:
        return _float(_physical(signal, raw))
    if raw in _states(signal):
        return f"SignalState.{_states(signal)[raw]}"
    return _float(_physical(signal, raw)) if kind is Kind.PHYSICAL else str(raw)


def _statement(signal: Signal) -> str:
    """The label of what is sent for a field that is not given, unless it says that it is none."""
    if signal.must_be_given or signal.value_table is None:
        return ""
    if signal.start_value == signal.invalid_code:
        return ""
    return signal.value_table.labels().get(signal.start_value, "")


def _physical(signal: Signal, raw: int) -> float:
    """In the arithmetic of the decoder, so that limits hold to the last bit."""
    return raw * float(signal.factor) + float(signal.offset)


def _float(value: float) -> str:
    """A literal as the formatter wants it."""
    return repr(value).replace("e+", "e")


def _expression(signal: Signal, kind: Kind, raw: str) -> str:
    """Python that turns a raw value into the field's."""
    value = raw
    if kind in (Kind.LABELLED, Kind.CHARACTER):
        table = code_table_name(signal)
        value = f"{table}[{raw}]" if has_short_table(signal) else f"{table}.get({raw}, {raw})"
    if kind is Kind.LABELLED:
        return value
    if kind in (Kind.PHYSICAL, Kind.FLOAT):
        value = f"{raw} * {_float(float(signal.factor))}" if signal.factor != 1 else f"float({raw})"
        if signal.offset:
            start = raw if signal.factor == 1 else value
            sign = "-" if signal.offset < 0 else "+"
            value = f"{start} {sign} {_float(abs(float(signal.offset)))}"
    for code, state in reversed(_states(signal).items()) if kind is not Kind.FLOAT else ():
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
    if kind is Kind.FLOAT:
        return [
            *arguments,
            ("factor", _float(float(signal.factor))),
            ("offset", _float(float(signal.offset))),
            ("minimum", _float(float(signal.minimum))),
            ("maximum", _float(float(signal.maximum))),
        ]
    low, high = _sendable(signal, kind)
    if kind is Kind.PHYSICAL:
        minimum, maximum = _physical_limits(signal, low, high)
        arguments += [
            ("factor", _float(float(signal.factor))),
            ("offset", _float(float(signal.offset))),
            ("minimum", _float(minimum)),
            ("maximum", _float(maximum)),
        ]
    else:
        arguments += [("minimum", str(low)), ("maximum", str(high))]
    if states := _states(signal):
        inner = ", ".join(f"{code}: SignalState.{state}" for code, state in states.items())
        arguments.append(("states", f"{{{inner}}}"))
    if kind in (Kind.LABELLED, Kind.CHARACTER) and signal.value_table:
        arguments.append(("labels", f"enums.{labels_name(signal.value_table)}"))
    if kind is Kind.LABELLED:
        arguments.append(("enum", f"enums.{_enum_name(signal)}"))
    if signal.acting:
        arguments.append(("acting", acting_codes(signal.acting)))
    return arguments


def _sendable(signal: Signal, kind: Kind) -> tuple[int, int]:
    """The raw values of the range and, where they make the field, of the codes; if they fit."""
    (low, high), (least, most) = signal.raw_range, signal.raw_limits
    if kind is Kind.LABELLED and signal.value_table:
        codes = [code.value for code in signal.value_table.codes]
        low, high = min(low, *codes), max(high, *codes)
    return max(low, least), min(high, most)


def _physical_limits(signal: Signal, low: int, high: int) -> tuple[float, float]:
    """The physical values of the raw ends; those of over 53 bits, rounded towards each other."""
    factor, offset = float(signal.factor), float(signal.offset)
    ends = sorted(_physical(signal, raw) for raw in (low, high))
    middle = sum(ends) / 2

    def inwards(value: float) -> float:
        while not low <= round((value - offset) / factor) <= high and value != middle:
            value = math.nextafter(value, middle)
        return value

    return inwards(ends[0]), inwards(ends[1])


def _enum_name(signal: Signal) -> str:
    return signal.value_table.name if signal.value_table else ""


def labels_name(table: ValueTable) -> str:
    """What the labels of a value table are called beside its enum."""
    return "".join(f"_{c}" if c.isupper() and i else c for i, c in enumerate(table.name)).upper()


def code_table_name(signal: Signal) -> str:
    """What the decoder looks codes up in; raw values of other lengths have others."""
    table = signal.value_table
    sign = "_SIGNED" if signal.signed else ""
    return f"_{labels_name(table)}_{signal.length}{sign}" if table else ""


def has_short_table(signal: Signal) -> bool:
    """Whether its decoder looks up every raw value in a tuple, which has no negative places."""
    return signal.length <= _TABLE_BITS and not signal.signed


def members(table: ValueTable) -> dict[int, str]:
    """The members of the enum of a value table by their codes."""
    return member_names([(code.value, code.english) for code in table.codes])
