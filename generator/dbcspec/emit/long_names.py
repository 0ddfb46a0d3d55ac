"""Names longer than a DBC name may be: a short one in the file, the long one as an attribute."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from dataclasses import dataclass

from typedcan.model.naming import LONGEST_NAME
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
    nodes = _short_names(node.name for node in protocol.nodes)
    messages = _short_names(message.name for message in protocol.messages)
    tables = _short_names(table.name for table in protocol.value_tables)
    names = [LongName(short, long) for long, short in nodes.items()]
    short_messages: list[Message] = []
    for message in protocol.messages:
        signals = _short_names(signal.name for signal in message.signals)
        short = dataclasses.replace(
            message,
            name=messages[message.name],
            sender=nodes.get(message.sender, message.sender),
            signals=tuple(_short_signal(each, signals, nodes) for each in message.signals),
        )
        short_messages.append(short)
        names.append(LongName(short.name, message.name, short))
        names += [LongName(name, long, short, is_signal=True) for long, name in signals.items()]
    long_names = [name for name in names if name.short != name.long]
    if not long_names and all(short == long for long, short in tables.items()):
        return protocol, []
    return (
        dataclasses.replace(
            protocol,
            nodes=tuple(
                dataclasses.replace(node, name=nodes[node.name]) for node in protocol.nodes
            ),
            messages=tuple(short_messages),
            value_tables=tuple(
                dataclasses.replace(table, name=tables[table.name])
                for table in protocol.value_tables
            ),
        ),
        long_names,
    )


def _short_signal(signal: Signal, signals: dict[str, str], nodes: dict[str, str]) -> Signal:
    return dataclasses.replace(
        signal,
        name=signals[signal.name],
        multiplexer=signals.get(signal.multiplexer, signal.multiplexer),
        receivers=tuple(nodes.get(name, name) for name in signal.receivers),
    )


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
