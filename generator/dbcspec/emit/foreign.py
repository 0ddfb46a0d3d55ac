"""Files from a protocol that was read from somebody else's: a tidy DBC, and stubs."""

from __future__ import annotations

import builtins
import dataclasses
import keyword
import re
from collections import Counter
from collections.abc import Iterable, Iterator

from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.stubs import TAKEN, class_name, emit_stubs
from typedcan.model.errors import ReadError
from typedcan.model.naming import snake_case
from typedcan.model.protocol import Message, Protocol, Signal, ValueTable

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_NO_FIELDS = {*keyword.kwlist, *dir(builtins), "to_raw", "enums", "messages"}


def foreign_artifacts(protocol: Protocol, out_name: str) -> dict[str, bytes]:
    """The DBC in the one shape that every reader takes, and a package of typed Python.

    ``out_name`` names both; they can lie anywhere. Text beyond ASCII is UTF-8. Raises `ReadError`
    for a protocol that neither can say, see `dbc_faults`.
    """
    if not _NAME.fullmatch(out_name) or keyword.iskeyword(out_name):
        raise ReadError(f"{out_name}: is no name for a Python package")
    if faults := dbc_faults(protocol):
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        raise ReadError(f"{faults[0]}{more}")
    stubs = emit_stubs(with_python_names(protocol))
    return {
        f"{out_name}.dbc": emit_dbc(protocol).encode("utf-8"),
        **{f"{out_name}/{name}": text.encode("utf-8") for name, text in stubs.items()},
    }


def dbc_faults(protocol: Protocol) -> list[str]:
    """What of a protocol no DBC can or may say, one line each that names the message or node."""
    return [
        *_name_faults(protocol),
        *_twice("message", (message.name for message in protocol.messages)),
        *_twice(
            "identifier",
            (
                f"0x{message.frame_id:X} ({29 if message.extended else 11} bits)"
                for message in protocol.messages
            ),
        ),
        *(fault for message in protocol.messages for fault in _message_faults(message)),
        *_text_faults(protocol),
    ]


def _name_faults(protocol: Protocol) -> Iterator[str]:
    names = [
        *(node.name for node in protocol.nodes),
        *(table.name for table in protocol.value_tables),
        *(message.name for message in protocol.messages),
        *(signal.name for _, signal in protocol.signals()),
    ]
    for name in dict.fromkeys(names):
        if not _NAME.fullmatch(name):
            yield f"{name!r} is no DBC name: letters, digits and underscores, no digit first"


def _twice(what: str, names: Iterable[str]) -> Iterator[str]:
    for name, count in Counter(names).items():
        if count > 1:
            yield f"{what} {name} is there {count} times"


def _message_faults(message: Message) -> Iterator[str]:
    yield from _twice(f"{message.name}: signal", (signal.name for signal in message.signals))
    by_name = {signal.name: signal for signal in message.signals}
    for signal in message.signals:
        if signal.acting and signal.start_value in signal.acting.codes:
            yield f"{message.name}: {signal.name} starts with {signal.start_value}, which acts"
    for signal in message.signals:
        above: list[Signal] = []
        while signal.multiplexer and signal not in above:
            above.append(signal)
            if signal.multiplexer not in by_name:
                yield f"{message.name}: {signal.name} is selected by no signal of the message"
                break
            signal = by_name[signal.multiplexer]  # noqa: PLW2901 - climbs to the outermost
        if signal in above and signal.multiplexer in by_name:
            yield f"{message.name}: {signal.name} selects itself"


def _text_faults(protocol: Protocol) -> Iterator[str]:
    """A backslash before the closing quote would quote the quote."""
    texts = [
        *((node.name, text) for node in protocol.nodes for text in (node.title, node.english)),
        *((each.name, text) for each in protocol.messages for text in (each.title, each.english)),
        *(
            (signal.name, text)
            for _, signal in protocol.signals()
            for text in (signal.title, signal.english, signal.unit)
        ),
        *((table.name, each.english) for table in protocol.value_tables for each in table.codes),
    ]
    for name, text in texts:
        if text.endswith("\\"):
            yield f"{name}: a text of it ends in a backslash"


def with_python_names(protocol: Protocol) -> Protocol:
    """The protocol with names of fields and enums that Python can have beside each other."""
    taken = {class_name(message).lower() for message in protocol.messages}
    taken |= {name.lower() for name in TAKEN}
    tables: dict[ValueTable, ValueTable] = {}
    for table in dict.fromkeys(
        (*protocol.value_tables, *(each.value_table for _, each in protocol.signals()))
    ):
        if table:
            name = next(each for each in _class_names(table.name) if each.lower() not in taken)
            taken.add(name.lower())
            tables[table] = dataclasses.replace(table, name=name)
    return dataclasses.replace(
        protocol,
        messages=tuple(_named(message, tables) for message in protocol.messages),
        value_tables=tuple(tables[table] for table in protocol.value_tables),
    )


def _class_names(name: str) -> Iterator[str]:
    """``door_state`` as ``DoorState``, ``DoorStateCodes``, ``DoorStateCodes2`` and so on."""
    camel = "".join(part[:1].upper() + part[1:] for part in name.split("_")) or "Codes"
    camel = f"_{camel}" if camel[0].isdigit() else camel
    if len(camel) > 1:  # one letter is what its table of labels would be called
        yield camel
    yield f"{camel}Codes"
    count = 2
    while True:
        yield f"{camel}Codes{count}"
        count += 1


def _named(message: Message, tables: dict[ValueTable, ValueTable]) -> Message:
    taken = set(_NO_FIELDS)
    signals: list[Signal] = []
    for signal in message.signals:
        name = plain = signal.python_name or snake_case(signal.name)
        count = 1
        while name in taken:
            name = f"{plain}_" if count == 1 else f"{plain}_{count}"
            count += 1
        taken.add(name)
        table = tables[signal.value_table] if signal.value_table else None
        signals.append(dataclasses.replace(signal, python_name=name, value_table=table))
    return dataclasses.replace(message, signals=tuple(signals))
