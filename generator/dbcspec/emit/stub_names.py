"""What messages, fields and enums are called in generated Python: no two names collide."""

from __future__ import annotations

import builtins
import dataclasses
import keyword
import sys
from collections.abc import Iterator

from typedcan.model.kinds import enums
from typedcan.model.naming import field_names, snake_case, unused
from typedcan.model.protocol import Message, Protocol, Signal, ValueTable

TAKEN = frozenset(
    {
        *keyword.kwlist,
        *dir(builtins),
        *("MESSAGES", "MODEL", "ENUMS", "CODECS", "PROTOCOL", "NAME", "DIGEST"),
        *("INVALID", "ABNORMAL", "_MODELS"),
        *("Any", "ClassVar", "StraightLine", "IntEnum", "Mapping", "Sequence", "dataclass"),
        *("annotations", "bind", "code_table", "draft_of", "raw_of", "read_model"),
        *("codec", "enums", "messages", "model", "protocol"),
        *("_fields_of", "_selected_of"),
        *("Message", "MessageModel", "SignalState", "Checksum", "Counter", "Field", "Selected"),
        *(f"Code{bits}" for bits in range(1, 9)),
    }
)
"""What stands in the modules of the stubs already."""

_NO_PACKAGES = frozenset(
    name.lower()
    for name in (
        *sys.stdlib_module_names,
        *keyword.kwlist,
        "can",
        "cantools",
        "typedcan",
        "swapcan",
    )
)


def package_name(stem: str) -> str:
    """The name of a package, and of the files beside it, that are made of a file of that stem.

    A package on the path must not stand before a module that Python or the runtime imports.
    """
    name = "".join(each if each.isascii() and each.isalnum() else "_" for each in stem)
    name = f"_{name}" if not name or name[0].isdigit() else name
    return f"{name}_" if name.lower() in _NO_PACKAGES else name


class StubNames:
    """The names of a protocol, and the protocol with names that Python can have.

    The classes of messages are called as these are, if they can be; enums as their value tables in
    camel case. Both stand in one module, and no two of them differ in case only.
    """

    def __init__(self, protocol: Protocol) -> None:
        self.protocol = _with_unique_tables(_with_field_names(protocol))
        self._classes = _classes([message.name for message in protocol.messages])
        taken = {name.lower() for name in (*TAKEN, *self._classes.values())}
        fields = {signal.python_name for _, signal in self.protocol.signals()}
        self._enums: dict[str, str] = {}
        for table in enums(self.protocol.messages):
            candidates = (each for each in _enum_names(table.name) if each not in fields)
            name = next(each for each in candidates if each.lower() not in taken)
            taken.add(name.lower())
            self._enums[table.name] = name

    def class_of(self, message: Message) -> str:
        """The class of a message."""
        return self._classes[message.name]

    def enum_of(self, table: ValueTable) -> str:
        """The enum of a value table that has one."""
        return self._enums[table.name]

    def codes_of(self, signal: Signal) -> str:
        """What the decoder looks codes up in; raw values of other lengths have others."""
        table = signal.value_table.name if signal.value_table else ""
        return f"_codes_{table}_{signal.length}{'_signed' if signal.signed else ''}"


def _classes(names: list[str]) -> dict[str, str]:
    classes = {name: name for name in names if name not in TAKEN and not name.startswith("__")}
    for name in names:
        if name not in classes:
            plain = name.lstrip("_") if name.startswith("__") else name
            classes[name] = unused(f"{plain}_", {*TAKEN, *classes.values()})
    return classes


def _enum_names(name: str) -> Iterator[str]:
    """``door_state`` as ``DoorState``, ``DoorStateCodes``, ``DoorStateCodes2`` and so on."""
    camel = "".join(part[:1].upper() + part[1:] for part in name.split("_")) or "Codes"
    camel = f"_{camel}" if camel[0].isdigit() else camel
    yield camel
    yield f"{camel}Codes"
    count = 2
    while True:
        yield f"{camel}Codes{count}"
        count += 1


def _with_field_names(protocol: Protocol) -> Protocol:
    messages = tuple(map(_named, protocol.messages))
    same = messages == protocol.messages
    return protocol if same else dataclasses.replace(protocol, messages=messages)


def _named(message: Message) -> Message:
    wanted = [signal.python_name or snake_case(signal.name) for signal in message.signals]
    signals = tuple(
        dataclasses.replace(signal, python_name=name)
        for signal, name in zip(message.signals, field_names(wanted, TAKEN), strict=True)
    )
    return dataclasses.replace(message, signals=signals)


def _with_unique_tables(protocol: Protocol) -> Protocol:
    """Enums are found by the names of their tables: those that share one get numbers."""
    used = (*protocol.value_tables, *(each.value_table for _, each in protocol.signals()))
    tables = [table for table in dict.fromkeys(used) if table]
    renamed: dict[ValueTable, ValueTable] = {}
    taken: set[str] = set()
    for table in tables:
        name = unused(table.name, taken)
        taken.add(name)
        renamed[table] = dataclasses.replace(table, name=name)
    if len({table.name for table in tables}) == len(tables):
        return protocol
    return dataclasses.replace(
        protocol,
        messages=tuple(_with_tables(message, renamed) for message in protocol.messages),
        value_tables=tuple(renamed[table] for table in protocol.value_tables),
    )


def _with_tables(message: Message, renamed: dict[ValueTable, ValueTable]) -> Message:
    signals = (
        dataclasses.replace(each, value_table=renamed[each.value_table])
        if each.value_table
        else each
        for each in message.signals
    )
    return dataclasses.replace(message, signals=tuple(signals))
