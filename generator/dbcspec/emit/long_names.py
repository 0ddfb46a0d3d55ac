"""Names that no DBC can have: others in the file, and the long ones as attributes."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeVar

from dbcspec.emit.extras import renamed_extras, renamed_variable
from typedcan.model.extras import Attribute, AttributeDefinition
from typedcan.model.naming import LONGEST_NAME, is_dbc_keyword, unused
from typedcan.model.protocol import Message, Node, Protocol, Signal


@dataclass(frozen=True, slots=True)
class LongName:
    """The long name of a node, of ``message``, or of a signal of it."""

    short: str
    long: str
    message: Message | None = None
    is_signal: bool = False


def shortened(protocol: Protocol) -> tuple[Protocol, list[LongName]]:
    """The protocol with names that fit, and the names that did not."""
    new, names = _renamed(protocol, _short_names)
    long_names = [name for name in names if name.short != name.long]
    return new, long_names


def with_dbc_names(protocol: Protocol) -> Protocol:
    """The protocol with names of letters, digits and underscores, as DBC files and Python want.

    What had another name has it as an attribute of `ORIGINAL_NAMES`.
    """
    new, names = _renamed(protocol, _plain_names)
    return _with_original_names(new, names) if other_names(names) else new


def other_names(names: Iterable[LongName]) -> dict[str, str]:
    """Names to those that are written in their place, where that is another one."""
    return {name.long: name.short for name in names if name.short != name.long}


def dbc_names(protocol: Protocol) -> dict[str, str]:
    """The names that `with_dbc_names` changes, to what it makes of them."""
    return other_names(_renamed(protocol, _plain_names)[1])


ORIGINAL_NAMES = {
    "BU_": "OriginalNodeName",
    "BO_": "OriginalMessageName",
    "SG_": "OriginalSignalName",
}
"""The attributes of nodes, messages and signals whose name no DBC can have."""


def _with_original_names(protocol: Protocol, names: Iterable[LongName]) -> Protocol:
    changed = [name for name in names if name.short != name.long]
    nodes = {each.short: each.long for each in changed if not each.message}
    messages = {
        id(each.message): each.long for each in changed if each.message and not each.is_signal
    }
    signals = {
        (id(each.message), each.short): each.long
        for each in changed
        if each.message and each.is_signal
    }
    used = [("BU_", nodes), ("BO_", messages), ("SG_", signals)]
    known = {(each.of, each.name) for each in protocol.definitions}
    definitions = (
        AttributeDefinition(ORIGINAL_NAMES[of], of, "STRING", "")
        for of, found in used
        if found and (of, ORIGINAL_NAMES[of]) not in known
    )
    return dataclasses.replace(
        protocol,
        definitions=(*protocol.definitions, *definitions),
        nodes=tuple(_named(each, "BU_", nodes.get(each.name)) for each in protocol.nodes),
        messages=tuple(
            dataclasses.replace(
                _named(message, "BO_", messages.get(id(message))),
                signals=tuple(
                    _named(each, "SG_", signals.get((id(message), each.name)))
                    for each in message.signals
                ),
            )
            for message in protocol.messages
        ),
    )


_Named = TypeVar("_Named", Node, Message, Signal)


def _named(item: _Named, of: str, original: str | None) -> _Named:
    name = ORIGINAL_NAMES[of]
    if original is None or any(each.name == name for each in item.attributes):
        return item
    attributes = (*item.attributes, Attribute(name, original))
    return dataclasses.replace(item, attributes=attributes)


def _renamed(
    protocol: Protocol, rename: Callable[[Iterable[str]], dict[str, str]]
) -> tuple[Protocol, list[LongName]]:
    """The protocol with other names, if any; ``rename`` gives those of things of one kind."""
    nodes = rename(node.name for node in protocol.nodes)
    messages = rename(message.name for message in protocol.messages)
    used = (*protocol.value_tables, *(each.value_table for _, each in protocol.signals()))
    tables = rename(table.name for table in used if table)
    names = [LongName(new, old) for old, new in nodes.items()]
    changed: list[Message] = []
    for message in protocol.messages:
        signals = rename(signal.name for signal in message.signals)
        new = dataclasses.replace(
            renamed_extras(message, signals, nodes),
            name=messages[message.name],
            sender=nodes.get(message.sender, message.sender),
            other_senders=tuple(nodes.get(name, name) for name in message.other_senders),
            signals=tuple(_signal(each, signals, nodes, tables) for each in message.signals),
        )
        changed.append(new)
        names.append(LongName(new.name, message.name, new))
        names += [LongName(name, old, new, is_signal=True) for old, name in signals.items()]
    if all(each.short == each.long for each in names) and all(a == b for a, b in tables.items()):
        return protocol, names
    renamed = dataclasses.replace(
        protocol,
        nodes=tuple(dataclasses.replace(node, name=nodes[node.name]) for node in protocol.nodes),
        messages=tuple(changed),
        buses=tuple(
            dataclasses.replace(bus, nodes=tuple(nodes.get(name, name) for name in bus.nodes))
            for bus in protocol.buses
        ),
        variables=tuple(renamed_variable(each, nodes) for each in protocol.variables),
        value_tables=tuple(
            dataclasses.replace(table, name=tables[table.name]) for table in protocol.value_tables
        ),
    )
    return renamed, names


def _signal(
    signal: Signal, signals: dict[str, str], nodes: dict[str, str], tables: dict[str, str]
) -> Signal:
    table = signal.value_table
    return dataclasses.replace(
        signal,
        name=signals[signal.name],
        multiplexer=signals.get(signal.multiplexer, signal.multiplexer),
        receivers=tuple(nodes.get(name, name) for name in signal.receivers),
        value_table=table and dataclasses.replace(table, name=tables[table.name]),
    )


def _plain_names(names: Iterable[str]) -> dict[str, str]:
    every = dict.fromkeys(names)
    plain = {name: name for name in every if _PLAIN.fullmatch(name) and not is_dbc_keyword(name)}
    for name in every:
        if name not in plain:
            other = re.sub(r"\W", "_", name, flags=re.ASCII) or "_"
            other = f"_{other}" if other[0].isdigit() or is_dbc_keyword(other) else other
            plain[name] = unused(other, plain.values())
    return plain


_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def _short_names(names: Iterable[str]) -> dict[str, str]:
    """Each name with one that fits; no two get the same."""
    every = dict.fromkeys(names)
    taken = {name for name in every if len(name) <= LONGEST_NAME}
    short: dict[str, str] = {}
    for name in every:
        ends = ("", *(f"_{count}" for count in range(1, len(every) + 1)))
        candidates = (name[: LONGEST_NAME - len(end)] + end for end in ends)
        fits = len(name) <= LONGEST_NAME
        short[name] = name if fits else next(each for each in candidates if each not in taken)
        taken.add(short[name])
    return short
