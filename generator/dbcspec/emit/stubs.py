"""The model to typed Python: enums, message classes, and functions that move their bits fast."""

from __future__ import annotations

from collections.abc import Callable

from dbcspec.emit.stub_branches import Branches, assigned, called, declared
from dbcspec.emit.stub_codec import can_decode, can_encode, decoding, encoding
from dbcspec.emit.stub_docs import enum_doc, line, message_doc, quote
from dbcspec.emit.stub_fields import (
    StubField,
    code_type,
    fields_of,
    has_short_table,
    members,
)
from dbcspec.emit.stub_names import StubNames
from dbcspec.emit.templating import template
from typedcan.model.kinds import Kind, enums
from typedcan.model.layout import filler
from typedcan.model.protocol import Message, Protocol
from typedcan.model.serial import to_json

_LONGEST_LINE = 100

RUNTIME = "typedcan.wire"
"""The package that the stubs stand on; among themselves they import relatively."""


def emit_stubs(protocol: Protocol) -> dict[str, str]:
    """Render the modules of a stub package, file name to text; they load wherever they lie."""
    names = StubNames(protocol)
    protocol = names.protocol
    stubs = [(message, fields_of(message, names)) for message in protocol.messages]
    context = {
        "protocol": protocol,
        "runtime": RUNTIME,
        "stubs": stubs,
        "imports": _imports(protocol, [field for _, fields in stubs for field in fields]),
        "code_tables": _code_tables(stubs, names),
        "branches": Branches(protocol),
        "selects": _selects,
        "class_of": names.class_of,
        "class_names": sorted(map(names.class_of, protocol.messages)),
        "doc": _doc,
        "quote": quote,
        "line": line,
        "assigned": assigned,
        "declared": declared,
        "called": called,
        "head": _head,
        "names": names,
        "filler": filler,
        "straight": [(message, fields) for message, fields in stubs if can_decode(message, fields)],
        "can_encode": can_encode,
        "decoding": decoding,
        "encoding": encoding,
        "entry": _entry(names),
        "receivers": _receivers,
        "binding": _binding(protocol),
        **_enum_context(names),
    }
    modules = ("__init__", "model", "enums", "messages", "codec", "protocol")
    rendered = {f"{name}.py": template(f"{name}.py.j2").render(context) for name in modules}
    return {**rendered, MODEL_FILE: to_json(protocol)}


MODEL_FILE = "protocol.json"
"""The whole model, beside the modules."""


def _enum_context(names: StubNames) -> dict[str, object]:
    tables = enums(names.protocol.messages)
    return {
        "enums": [(table, members(table), enum_doc(users)) for table, users in tables.items()],
        "enum_of": names.enum_of,
        "used_enums": sorted(map(names.enum_of, tables), key=str.lower),
    }


def _imports(protocol: Protocol, fields: list[StubField]) -> list[str]:
    """What the messages take from the runtime's messages."""
    names = {"Field", "Message"}
    names |= {"Checksum" for message in protocol.messages if message.checksum}
    names |= {"Counter" for message in protocol.messages if message.counter}
    names |= {"Selected" for message in protocol.messages if _selects(message)}
    names |= {"SignalState" for field in fields if "SignalState" in field.annotation}
    codes = {code_type(field.signal) for field in fields if field.kind is Kind.LABELLED}
    names |= {name for name in codes if name}
    return sorted(names, key=_import_order)


def _binding(protocol: Protocol) -> list[str]:
    """What binds classes to the model; a field cannot have such a name with an underscore."""
    names = ["fields_of"] if protocol.messages else []
    return names + (["selected_of"] if any(map(_selects, protocol.messages)) else [])


def _selects(message: Message) -> bool:
    """Whether a signal of a message selects others."""
    names = {signal.name for signal in message.signals}
    return any(signal.multiplexer in names for signal in message.signals)


def _import_order(name: str) -> tuple[bool, str]:
    """Classes before functions, as import sorters have it."""
    return name[0].islower(), name.lower()


def _head(name: str, arguments: str, result: str) -> str:
    """The first lines of a function."""
    line = f"def {name}({arguments}) -> {result}:"
    if len(line) <= _LONGEST_LINE:
        return line
    line = f"def {name}(\n    {arguments},\n) -> {result}:"
    return line if "," not in arguments else line.replace(",\n)", "\n)")


def _entry(names: StubNames) -> Callable[[Message, list[StubField]], str]:
    """Writes which functions a class has."""

    def entry(message: Message, fields: list[StubField]) -> str:
        name = names.class_of(message)
        encode = f"_encode_{name}" if can_encode(message, fields) else "None"
        line = f"    messages.{name}: StraightLine(_decode_{name}, {encode}),"
        if len(line) <= _LONGEST_LINE:
            return line
        line = f"        _decode_{name}, {encode}"
        if len(line) > _LONGEST_LINE:
            line = f"        _decode_{name},\n        {encode},"
        return f"    messages.{name}: StraightLine(\n{line}\n    ),"

    return entry


def _doc(message: Message, fields: list[StubField]) -> str:
    said = [field.says for field in fields if field.says]
    return message_doc(message, said, [f.signal.python_name for f in fields if f.default is None])


def _receivers(message: Message) -> str:
    """The class variable with the receivers, one a line where they are too many for one."""
    target = "    RECEIVERS: ClassVar[tuple[str, ...]] ="
    names = [quote(name) for name in message.receivers]
    line = f"{target} ({', '.join(names)}{',' if len(names) == 1 else ''})"
    if len(line) <= _LONGEST_LINE:
        return line
    return "\n".join((f"{target} (", *(f"        {name}," for name in names), "    )"))


def _code_tables(
    stubs: list[tuple[Message, list[StubField]]], names: StubNames
) -> list[tuple[str, str]]:
    """The look-up tables of the decoders: name and the expression that makes it."""
    tables: dict[str, str] = {}
    for message, fields in stubs:
        for field in fields:
            if field.signal.value_table and field.kind in (Kind.LABELLED, Kind.CHARACTER):
                expression = _code_table(message, field, names)
                tables.setdefault(names.codes_of(field.signal), expression)
    return sorted(tables.items())


def _code_table(message: Message, field: StubField, names: StubNames) -> str:
    table = field.signal.value_table
    if field.kind is Kind.LABELLED and table:
        source = f"enums.{names.enum_of(table)}"
        members_of = f"{{member.value: member for member in {source}}}"
    else:
        field_name = quote(field.signal.python_name)
        source = members_of = f"messages.{names.class_of(message)}.FIELDS[{field_name}].labels"
    if has_short_table(field.signal):
        return f"code_table({source}, {field.signal.length})"
    return members_of
