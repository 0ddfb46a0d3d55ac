"""Rule name-unique: what shares a space of names in the spec, in DBC or in Python has its own.

Tables join annex rows by name, so in a spec the signals of all messages share one space; in a
DBC file those of one message do. Messages and value tables share a space as generated classes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from dbcspec.errors import Location
from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.model import NOWHERE, Message, Protocol

_Named = tuple[Location, str, str]
"""Place, name, and what has the name."""


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    protocol = subject.protocol
    yield from _repeated(_classes(protocol, places))
    yield from _repeated(_nodes(subject))
    yield from _repeated(_buses(subject))
    signals = [
        [(places.layout(sig, "name"), sig.name, f"a signal of {msg.name}") for sig in msg.signals]
        for msg in protocol.messages
    ]
    if subject.spec:
        signals = [[named for group in signals for named in group]]
    for group in signals:
        yield from _repeated(group)
    for message in protocol.messages:
        yield from _fields(message, places)


def _repeated(space: Iterable[_Named]) -> Iterator[Found]:
    first: dict[str, str] = {}
    for where, name, what in space:
        if name in first:
            yield where, name, f"{name}, {what}, is the name of {first[name]} already: rename one"
        first.setdefault(name, what)


def _classes(protocol: Protocol, places: Places) -> Iterator[_Named]:
    for message in protocol.messages:
        yield places.message(message, "name"), message.name, "a message"
    for table in protocol.value_tables:
        yield places.name(table), table.name, "a value table"


def _nodes(subject: Subject) -> Iterator[_Named]:
    if subject.spec is None:
        yield from ((NOWHERE, node.name, "a node") for node in subject.protocol.nodes)
        return
    for node in subject.spec.standard.nodes:
        yield node.where_is("name"), node.name, "a node"
        for alias in node.aliases:
            yield node.where_is("aliases"), alias, f"an alias of {node.name}"


def _buses(subject: Subject) -> Iterator[_Named]:
    if subject.spec is None:
        yield from ((NOWHERE, bus.name, "a bus") for bus in subject.protocol.buses)
        return
    for bus in subject.spec.standard.buses:
        yield bus.where_is("name"), bus.name, "a bus"


def _fields(message: Message, places: Places) -> Iterator[Found]:
    """Two signals of one message that would be one field in generated code."""
    first: dict[str, str] = {}
    for signal in message.signals:
        name = signal.python_name
        other = first.setdefault(name, signal.name)
        if name and other != signal.name:
            text = f"{signal.name} and {other} both become the field {name}: give one a field name"
            yield places.layout(signal, "field"), signal.name, text


RULE = Rule("name-unique", "no two things that share a space of names have one name", _check)
