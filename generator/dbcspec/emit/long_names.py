"""Names that no DBC can have: others in the file, and the long ones as attributes."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from dbcspec.emit.extras import renamed_extras, renamed_variable
from typedcan.model.naming import LONGEST_NAME, is_dbc_keyword, unused
from typedcan.model.protocol import Message, Protocol, Signal


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
    """The protocol with names of letters, digits and underscores, as DBC files and Python want."""
    return _renamed(protocol, _plain_names)[0]


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
