"""Which names share a space in the spec, in DBC files or in generated Python.

Tables join annex rows by name, so in a spec the signals of all messages share one space; in a
DBC file those of one message do. Messages and value tables share a space as generated classes,
where the source is one that Python is generated from.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Subject
from typedcan.model.errors import Location
from typedcan.model.protocol import NOWHERE, Aspect, Message


class Named(NamedTuple):
    """A name, its place, what has it, and the message that this belongs to, if any.

    An ``alias`` is a name that only the print uses.
    """

    where: Location
    name: str
    what: str
    message: str = ""
    alias: bool = False


def name_spaces(subject: Subject) -> Iterator[list[Named]]:
    """The spaces, each with its names in order."""
    places = Places(subject)
    protocol = subject.protocol
    messages = [
        Named(places.message(each, "name"), each.name, "a message", each.name)
        for each in protocol.messages
    ]
    tables = [
        Named(places.name(table), table.name, "a value table") for table in protocol.value_tables
    ]
    if Aspect.PYTHON_NAMES in protocol.carries and subject.settings.house:
        yield messages + tables
    else:
        yield messages  # generated classes of foreign files get out of each other's way
        # Names that the reader made up for codes without one are no names.
        yield tables if Aspect.VALUE_TABLE_NAMES in protocol.carries else []
    yield _nodes(subject)
    yield _buses(subject)
    yield from _signal_spaces(subject, places)


def _signal_spaces(subject: Subject, places: Places) -> Iterator[list[Named]]:
    """One space for signals that tables explain by their name alone, else one for each message."""
    rows = subject.spec.explanations() if subject.spec else {}
    shared: list[Named] = []
    for message in subject.protocol.messages:
        signals = _signals(message, places)
        by_name = {
            each.name
            for each in message.signals
            if any(not row.message for _, row in rows.get((message.name, each.name), ()))
        }
        shared += [each for each in signals if each.name in by_name]
        yield [each for each in signals if each.name not in by_name]
    yield shared


def _signals(message: Message, places: Places) -> list[Named]:
    return [
        Named(places.layout(each, "name"), each.name, f"a signal of {message.name}", message.name)
        for each in message.signals
    ]


def _nodes(subject: Subject) -> list[Named]:
    if subject.spec is None:
        return [Named(NOWHERE, node.name, "a node") for node in subject.protocol.nodes]
    return [
        named
        for node in subject.spec.standard.nodes
        for named in (
            Named(node.where_is("name"), node.name, "a node"),
            *(
                Named(node.where_is("aliases"), each, f"an alias of {node.name}", alias=True)
                for each in node.aliases
            ),
        )
    ]


def _buses(subject: Subject) -> list[Named]:
    if subject.spec is None:
        return [Named(NOWHERE, bus.name, "a bus") for bus in subject.protocol.buses]
    return [Named(bus.where_is("name"), bus.name, "a bus") for bus in subject.spec.standard.buses]
