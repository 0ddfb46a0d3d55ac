"""The model to typed Python: enums, message classes, and the functions that decode them fast."""

from __future__ import annotations

import builtins
import keyword

from dbcspec.emit.stub_branches import Branches, called, declared, selected
from dbcspec.emit.stub_docs import enum_doc, message_doc, quote
from dbcspec.emit.stub_fields import (
    StubField,
    code_table_name,
    code_type,
    fields_of,
    has_short_table,
    labels_name,
    members,
)
from dbcspec.emit.stub_protocol import References, tuple_of
from dbcspec.emit.templating import template
from typedcan.model.kinds import Kind, enums
from typedcan.model.layout import whole_byte
from typedcan.model.protocol import Message, Protocol

_LONGEST_LINE = 100
TAKEN = {
    *keyword.kwlist,
    *dir(builtins),
    *(kind.value for kind in Kind),
    *("MESSAGES", "Any", "ClassVar", "Mapping", "dataclass", "enums", "annotations", "messages"),
    *(f"Code{bits}" for bits in range(1, 9)),
    *("Message", "SignalState", "Checksum", "Counter", "ActingCodes", "Field", "fields_by_name"),
}
"""What stands in the modules of the stubs already."""


RUNTIME = "typedcan.wire"
"""The package that the stubs stand on; among themselves they import relatively."""


def emit_stubs(protocol: Protocol) -> dict[str, str]:
    """Render the modules of a stub package, file name to text; they load wherever they lie."""
    stubs = [(message, fields_of(message)) for message in protocol.messages]
    context = {
        "protocol": protocol,
        "runtime": RUNTIME,
        "stubs": stubs,
        "imports": _imports(protocol, [field for _, fields in stubs for field in fields]),
        "code_tables": _code_tables(stubs),
        "branches": Branches(protocol),
        "selected": selected,
        "class_of": class_name,
        "class_names": sorted(map(class_name, protocol.messages)),
        "function_of": _function_names(protocol).__getitem__,
        "doc": _doc,
        "whole_byte": whole_byte,
        "signal_of": lambda message, name: next(s for s in message.signals if s.name == name),
        "quote": quote,
        "declared": declared,
        "called": called,
        "head": _head,
        "receivers": _receivers,
        "refs": References(protocol, class_name),
        "node_names": [quote(node.name) for node in protocol.nodes],
        "tuple_of": tuple_of,
        **_enum_context(protocol, [field for _, fields in stubs for field in fields]),
    }
    return {
        name: template(f"{name}.j2").render(context)
        for name in ("__init__.py", "enums.py", "messages.py", "decoders.py", "protocol.py")
    }


def _enum_context(protocol: Protocol, fields: list[StubField]) -> dict[str, object]:
    tables = enums(protocol.messages)
    labelled = {
        field.signal.value_table: labels_name(field.signal.value_table)
        for field in fields
        if field.signal.value_table and field.kind in (Kind.LABELLED, Kind.CHARACTER)
    }
    return {
        "enums": [(table, members(table), enum_doc(users)) for table, users in tables.items()],
        "labelled": labelled,
        "used_enums": sorted((table.name for table in tables), key=str.lower),
        "multiplexed": any(field.conditions for field in fields),
    }


def _imports(protocol: Protocol, fields: list[StubField]) -> list[str]:
    """What the messages take from the runtime."""
    names = {"Field", "Message", "SignalState", "fields_by_name"}
    names |= {"Checksum" for message in protocol.messages if message.checksum}
    names |= {"Counter" for message in protocol.messages if message.counter}
    names |= {"ActingCodes" for _, signal in protocol.signals() if signal.acting}
    names |= {field.kind.value for field in fields}
    codes = {code_type(field.signal) for field in fields if field.kind is Kind.LABELLED}
    names |= {name for name in codes if name}
    return sorted(names, key=_import_order)


def class_name(message: Message) -> str:
    """The class of a message: its name, if that is not taken in the modules of the stubs."""
    return f"{message.name}_" if message.name in TAKEN else message.name


def _function_names(protocol: Protocol) -> dict[Message, str]:
    """The decoder of each message: its name in small letters, if that is its alone."""
    classes = [class_name(message) for message in protocol.messages]
    small = [name.lower() for name in classes]
    return {
        message: f"_{low}" if small.count(low) == 1 and low not in classes else f"_decode_{name}"
        for message, name, low in zip(protocol.messages, classes, small, strict=True)
    }


def _import_order(name: str) -> tuple[bool, str]:
    """Classes before functions, as import sorters have it."""
    return name[0].islower(), name.lower()


def _head(function: str, name: str) -> str:
    """The first lines of a decoder function."""
    line = f"def {function}(v: Sequence[int]) -> messages.{name}:"
    if len(line) <= _LONGEST_LINE:
        return line
    return f"def {function}(\n    v: Sequence[int],\n) -> messages.{name}:"


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


def _code_tables(stubs: list[tuple[Message, list[StubField]]]) -> list[tuple[str, str]]:
    """The look-up tables of the decoders: name and the expression that makes it."""
    tables: dict[str, str] = {}
    for _, fields in stubs:
        for field in fields:
            table = field.signal.value_table
            if table and field.kind in (Kind.LABELLED, Kind.CHARACTER):
                labelled = field.kind is Kind.LABELLED
                source = f"enums.{table.name if labelled else labels_name(table)}"
                if has_short_table(field.signal):
                    source = f"code_table({source}, {field.signal.length})"
                elif labelled:
                    source = f"{{member.value: member for member in {source}}}"
                tables[code_table_name(field.signal)] = source
    return sorted(tables.items())
