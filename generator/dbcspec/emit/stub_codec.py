"""Generated functions that move the bits of a message in straight lines, both ways.

Only the whole numbers of sound messages: what else there is takes the way through cantools' formats
and the fields, as everything can.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from dbcspec.emit.stub_branches import Branches
from dbcspec.emit.stub_fields import StubField, literal
from dbcspec.emit.stub_names import StubNames
from typedcan.model.kinds import Kind
from typedcan.model.layout import bits
from typedcan.model.limits import sending_limits
from typedcan.model.protocol import ByteOrder, Message, Signal
from typedcan.model.scaling import is_fine, is_whole, scaling_of

_FEW_READS = 3
"""Bytes that are read one by one; more of a classic frame are unpacked at once."""

_CLASSIC = 8
_LONGEST_LINE = 100
_IN_A_LINE = 4
"""Parts of a raw value that have room in a line."""

_KINDS = frozenset({Kind.PHYSICAL, Kind.NUMBER, Kind.LABELLED, Kind.CHARACTER, Kind.FILLED})
"""The kinds of fields whose raw values are whole numbers."""


class _Part(NamedTuple):
    """Bits of a raw value, from its bit ``at`` on, that lie beside each other in one byte."""

    byte: int
    low: int
    length: int
    at: int


def can_decode(message: Message, fields: list[StubField]) -> bool:
    """Whether a function that decodes a message can be written."""
    room = range(8 * message.length)
    return bool(fields) and all(
        field.kind in _KINDS and all(bit in room for bit in bits(field.signal)) for field in fields
    )


def can_encode(message: Message, fields: list[StubField]) -> bool:
    """Whether one that encodes it can: without branches, and no two signals in the same bits."""
    taken = [bit for field in fields for bit in bits(field.signal)]
    return (
        can_decode(message, fields)
        and not any(field.conditions for field in fields)
        and len(taken) == len({*taken})
    )


def decoding(message: Message, fields: list[StubField], branches: Branches) -> Iterator[str]:
    """The lines that take the payload ``d`` apart and set the fields of ``m``."""
    parts = [_parts(field.signal) for field in fields]
    read = [part.byte for each in parts for part in each]
    unpacked = len(read) > _FEW_READS and message.length <= _CLASSIC
    if unpacked:
        names = [f"b{byte}" if byte in read else "_" for byte in range(message.length)]
        yield f"    {', '.join(names)}{',' if len(names) == 1 else ''} = d"
    selectors = sorted({index for field in fields for index, _ in field.conditions})
    raws = [_raw(each, "b{}" if unpacked else "d[{}]") for each in parts]
    for index in selectors:  # those of a branch may lie behind its other signals
        yield from _assigning(f"v{index}", raws[index], fields[index].signal)
    for index, field in enumerate(fields):
        raw = raws[index]
        placeholder = f"v[{index}]"
        twice = field.expression.count(placeholder) > 1
        if index in selectors:
            value = f"v{index}"
        elif len(raw) > 1 or field.signal.signed or twice:
            value = "r"
            yield from _assigning(value, raw, field.signal)
        else:
            value = raw[0]
        if " " in value and not _stands_alone(field.expression, placeholder):
            value = f"({value})"
        expression = field.expression.replace(placeholder, value)
        yield branches.decoded(f"m.{field.signal.python_name}", expression, field.conditions)


def _stands_alone(expression: str, placeholder: str) -> bool:
    """Whether no operator stands beside the raw value."""
    within = (f"[{placeholder}]", f"({placeholder})", f"({placeholder}, {placeholder})")
    return expression == placeholder or any(each in expression for each in within)


def _parts(signal: Signal) -> list[_Part]:
    found: list[_Part] = []
    for at, bit in enumerate(bits(signal)):
        byte, low = divmod(bit, 8)
        last = found[-1] if found else None
        if last and (last.byte, last.low + last.length) == (byte, low):
            found[-1] = last._replace(length=last.length + 1)
        else:
            found.append(_Part(byte, low, 1, at))
    return found


def _read(part: _Part, byte: str) -> str:
    value = byte.format(part.byte)
    if part.low:
        value = f"{value} >> {part.low}"
    if part.low + part.length < 8:
        value = f"{value} & {(1 << part.length) - 1}"
    if part.at:
        value = f"({value}) << {part.at}" if " " in value else f"{value} << {part.at}"
    return value


def _raw(parts: list[_Part], byte: str) -> list[str]:
    """The raw value, in parts that have room in a line each."""
    found = [_read(part, byte) for part in parts]
    return [" | ".join(found[at : at + _IN_A_LINE]) for at in range(0, len(found), _IN_A_LINE)]


def _assigning(name: str, raw: list[str], signal: Signal) -> Iterator[str]:
    yield f"    {name} = {raw[0]}"
    yield from (f"    {name} |= {each}" for each in raw[1:])
    if signal.signed:
        sign = 1 << signal.length - 1
        yield f"    {name} = ({name} ^ {sign}) - {sign}"


def encoding(
    message: Message, fields: list[StubField], names: StubNames, fallback: str
) -> Iterator[str]:
    """The lines that put the fields of ``m`` together to the number ``w``, byte 0 lowest.

    What a field takes at once is tested here; all else, what is refused too, is left to the field.
    """
    counter = message.counter and message.counter.signal
    for index, field in enumerate(fields):
        slow = f"{fallback}[{index}]"
        yield f"    x = m.{field.signal.python_name}"
        yield from _tested(field, slow, names)
        if field.signal.name == counter:
            yield "    if c is not None:"
            yield "        r = c"
        for number, placed in enumerate(_placed(field.signal)):
            yield f"    {'w |=' if index or number else 'w: int ='} {placed}"


def _tested(field: StubField, slow: str, names: StubNames) -> Iterator[str]:
    """The lines that make the raw value ``r`` of what is given, ``x``."""
    signal, kind = field.signal, field.kind
    if kind is Kind.FILLED:
        yield f"    r = 0 if x is None else {slow}(x)"
        return
    test = _test(field, names)
    line = f"    if {test}:"
    if not test or len(line) > _LONGEST_LINE:
        yield f"    r = {slow}(x)"
        return
    if kind is Kind.LABELLED:
        yield "    k = type(x)"
    yield line
    yield f"        r = {_scaled(signal) if kind is Kind.PHYSICAL else 'x'}"
    if kind is Kind.PHYSICAL and signal.states:
        yield f"        if {' or '.join(f'r == {code}' for code in signal.states)}:"
        yield f"            r = {slow}(x)"
    for code, state in signal.states.items() if kind is not Kind.LABELLED else ():
        yield f"    elif x is {state.name}:"
        yield f"        r = {code}"
    yield "    else:"
    yield f"        r = {slow}(x)"


def _test(field: StubField, names: StubNames) -> str:
    """Whether the field would take what is given as it is; empty where that is not tested here."""
    signal, table = field.signal, field.signal.value_table
    low, high = sending_limits(signal, field.kind)
    if field.kind is Kind.PHYSICAL and not (is_fine(signal) or is_whole(signal)):
        return f"type(x) is float and {literal(low)} <= x <= {literal(high)}"
    if field.kind is Kind.NUMBER and signal.factor == 1 and not signal.offset:
        others = "".join(f" and x != {code}" for code in signal.states if low <= code <= high)
        return f"type(x) is int and {low} <= x <= {high}{others}"
    if field.kind is Kind.LABELLED and table:
        enum = f"k is enums.{names.enum_of(table)}"
        if all(low <= code.value <= high for code in table.codes):
            return f"{enum} or (k is int and {low} <= x <= {high})"
        return f"({enum} or k is int) and {low} <= x <= {high}"
    return ""


def _scaled(signal: Signal) -> str:
    """In the arithmetic of the field, which rounds to the nearest step."""
    factor, offset = scaling_of(signal)
    steps = "x"
    if offset:
        steps = f"x {'+' if offset < 0 else '-'} {literal(abs(offset))}"
    if factor != 1:
        steps = f"({steps}) / {literal(factor)}" if offset else f"x / {literal(factor)}"
    return f"round({steps})"


def _placed(signal: Signal) -> Iterator[str]:
    """The raw value at its place in the payload, in parts that have room in a line."""
    if signal.byte_order is ByteOrder.INTEL:
        value = f"r & {(1 << signal.length) - 1}" if signal.signed else "r"
        shifted = f"({value}) << {signal.start}" if " " in value else f"{value} << {signal.start}"
        yield shifted if signal.start else value
        return
    parts = [_placed_part(part) for part in _parts(signal)]
    yield from (" | ".join(parts[at : at + _IN_A_LINE]) for at in range(0, len(parts), _IN_A_LINE))


def _placed_part(part: _Part) -> str:
    value = f"r >> {part.at}" if part.at else "r"
    value = f"{value} & {(1 << part.length) - 1}"
    place = 8 * part.byte + part.low
    return f"({value}) << {place}" if place else value
