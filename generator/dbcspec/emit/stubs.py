"""The model to typed Python: enums, message classes, and the functions that decode them fast."""

from __future__ import annotations

import builtins
import keyword

from dbcspec.emit.stub_branches import Branches, called, declared
from dbcspec.emit.stub_docs import enum_doc, message_doc, quote
from dbcspec.emit.stub_fields import (
    StubField,
    code_table_name,
    code_type,
    fields_of,
    has_short_table,
    members,
)
from dbcspec.emit.templating import template
from typedcan.model.kinds import Kind, enums
from typedcan.model.protocol import Message, Protocol
from typedcan.model.serial import to_json

_LONGEST_LINE = 100
TAKEN = {
    *keyword.kwlist,
    *dir(builtins),
    *(
        "MESSAGES",
        "MODEL",
        "ENUMS",
        "DECODERS",
        "PROTOCOL",
        "NAME",
        "DIGEST",
        "INVALID",
        "ABNORMAL",
    ),
    *("Any", "Callable", "ClassVar", "Decoder", "IntEnum", "Mapping", "Sequence", "dataclass"),
    *("annotations", "bind", "code_table", "draft_of", "enums", "messages", "model", "read_model"),
    *("Message", "MessageModel", "SignalState", "Checksum", "Counter", "Field", "Selected"),
    *(f"Code{bits}" for bits in range(1, 9)),
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
        "selects": _selects,
        "class_of": class_name,
        "class_names": sorted(map(class_name, protocol.messages)),
        "function_of": _function_names(protocol).__getitem__,
        "doc": _doc,
        "quote": quote,
        "declared": declared,
        "called": called,
        "head": _head,
        "receivers": _receivers,
        "binding": _binding(protocol),
        **_enum_context(protocol),
    }
    modules = ("__init__", "model", "enums", "messages", "decoders", "protocol")
    rendered = {f"{name}.py": template(f"{name}.py.j2").render(context) for name in modules}
    return {**rendered, MODEL_FILE: to_json(protocol)}


MODEL_FILE = "protocol.json"
"""The whole model, beside the modules."""


def _enum_context(protocol: Protocol) -> dict[str, object]:
    tables = enums(protocol.messages)
    return {
        "enums": [(table, members(table), enum_doc(users)) for table, users in tables.items()],
        "used_enums": sorted((table.name for table in tables), key=str.lower),
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
    names = ["checksum_of"] if any(each.checksum for each in protocol.messages) else []
    names += ["counter_of"] if any(each.counter for each in protocol.messages) else []
    names += ["fields_of"] if protocol.messages else []
    return names + (["selected_of"] if any(map(_selects, protocol.messages)) else [])


def _selects(message: Message) -> bool:
    """Whether a signal of a message selects others."""
    names = {signal.name for signal in message.signals}
    return any(signal.multiplexer in names for signal in message.signals)


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
    for message, fields in stubs:
        for field in fields:
            if field.signal.value_table and field.kind in (Kind.LABELLED, Kind.CHARACTER):
                name = code_table_name(field.signal)
                tables.setdefault(name, _code_table(class_name(message), field))
    return sorted(tables.items())


def _code_table(message: str, field: StubField) -> str:
    table = field.signal.value_table
    if field.kind is Kind.LABELLED and table:
        source = f"enums.{table.name}"
        members_of = f"{{member.value: member for member in {source}}}"
    else:
        field_name = quote(field.signal.python_name)
        source = members_of = f"messages.{message}.FIELDS[{field_name}].labels"
    if has_short_table(field.signal):
        return f"code_table({source}, {field.signal.length})"
    return members_of
