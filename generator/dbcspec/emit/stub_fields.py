"""The fields of generated Python classes: what is written for each signal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from dbcspec.emit.stub_branches import Conditions, conditions
from dbcspec.emit.stub_docs import field_doc
from dbcspec.emit.stub_names import StubNames
from typedcan.model.kinds import Kind, kind_of
from typedcan.model.layout import readable
from typedcan.model.naming import member_names
from typedcan.model.protocol import Message, Signal, ValueTable
from typedcan.model.scaling import is_whole, scaling_of

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
    conditions: Conditions


def fields_of(message: Message, names: StubNames) -> list[StubField]:
    """The fields of a message, in the order in which a DBC reader lists its signals."""
    ordered = readable(message)
    by_name = {signal.name: (index, signal) for index, signal in enumerate(ordered)}
    return [_field(message, signal, index, by_name, names) for index, signal in enumerate(ordered)]


def _field(
    message: Message,
    signal: Signal,
    index: int,
    by_name: Mapping[str, tuple[int, Signal]],
    names: StubNames,
) -> StubField:
    when = conditions(signal, by_name)
    selector = by_name[signal.multiplexer][1].python_name if when else ""
    kind = kind_of(message, signal)
    absent = " | None" if when and kind is not Kind.FILLED else ""
    says = "" if when or kind is Kind.FILLED else _statement(signal)
    return StubField(
        signal=signal,
        kind=kind,
        annotation=_annotation(signal, kind, names) + absent,
        default="None" if when else None if signal.must_be_given else _default(signal, kind, names),
        says=says,
        doc=field_doc(signal, says, selector),
        expression=_expression(signal, kind, f"v[{index}]", names.codes_of(signal)),
        conditions=when,
    )


def _annotation(signal: Signal, kind: Kind, names: StubNames) -> str:
    state = " | SignalState" if signal.states else ""
    if kind is Kind.LABELLED and signal.value_table:
        return f"{names.enum_of(signal.value_table)} | {code_type(signal) or 'int'}"
    return {
        Kind.PHYSICAL: f"{'int' if is_whole(signal) else 'float'}{state}",
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


def _default(signal: Signal, kind: Kind, names: StubNames) -> str:
    raw = signal.start_value
    if kind is Kind.FILLED:
        return "None"
    if kind is Kind.LABELLED and signal.value_table:
        member = members(signal.value_table).get(raw)
        enum = names.enum_of(signal.value_table)
        return f"{enum}.{member}" if member else str(raw)
    if kind is Kind.FLOAT:
        return literal(_physical(signal, kind, raw))
    if raw in signal.states:
        return f"SignalState.{signal.states[raw].name}"
    return literal(_physical(signal, kind, raw))


def _statement(signal: Signal) -> str:
    """The label of what is sent for a field that is not given, unless it says that it is none."""
    if signal.must_be_given or signal.value_table is None:
        return ""
    if signal.start_value == signal.invalid_code:
        return ""
    return signal.value_table.labels().get(signal.start_value, "")


def _scaling(signal: Signal, kind: Kind) -> tuple[float, float]:
    return scaling_of(signal) if kind in (Kind.PHYSICAL, Kind.FLOAT) else (1, 0)


def _physical(signal: Signal, kind: Kind, raw: int) -> float:
    """In the arithmetic of the decoder, so that limits hold to the last bit."""
    factor, offset = _scaling(signal, kind)
    return raw * factor + offset


def literal(value: float) -> str:
    """A number as the formatter wants it."""
    return repr(value).replace("e+", "e")


def _expression(signal: Signal, kind: Kind, raw: str, table: str) -> str:
    """Python that turns a raw value into the field's."""
    value = raw
    if kind in (Kind.LABELLED, Kind.CHARACTER):
        value = f"{table}[{raw}]" if has_short_table(signal) else f"{table}.get({raw}, {raw})"
    if kind is Kind.LABELLED:
        return value
    factor, offset = _scaling(signal, kind)
    if factor != 1:
        value = f"{raw} * {literal(factor)}"
    elif isinstance(factor, float):
        value = f"float({raw})"
    if offset or (isinstance(factor, float) and factor < 0):  # 0 x -2.0 is -0.0, 0.0 with an offset
        start = raw if factor == 1 else value
        value = f"{start} {'-' if offset < 0 else '+'} {literal(abs(offset))}"
    for code, state in reversed([*signal.states.items()]) if kind is not Kind.FLOAT else ():
        value = f"{state.name} if {raw} == {code} else {value}"
    return value


def has_short_table(signal: Signal) -> bool:
    """Whether its decoder looks up every raw value in a tuple, which has no negative places."""
    return signal.length <= _TABLE_BITS and not signal.signed


def members(table: ValueTable) -> dict[int, str]:
    """The members of the enum of a value table by their codes."""
    return member_names([(code.value, code.english) for code in table.codes])
