"""Rule name-unique: what shares a space of names in the spec, in DBC or in Python has its own."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.name_spaces import name_spaces
from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import Message


def _check(subject: Subject) -> Iterator[Found]:
    for space in name_spaces(subject):
        first: dict[str, str] = {}
        for where, name, what, message, _ in space:
            if name in first:
                text = f"{name}, {what}, is the name of {first[name]} already: rename one"
                yield Found(where, name, text, message)
            first.setdefault(name, what)
    places = Places(subject)
    for each in subject.protocol.messages:
        yield from _fields(each, places)


def _fields(message: Message, places: Places) -> Iterator[Found]:
    """Two signals of one message that would be one field in generated code."""
    first: dict[str, str] = {}
    for signal in message.signals:
        name = signal.python_name
        other = first.setdefault(name, signal.name)
        if name and other != signal.name:
            text = f"{signal.name} and {other} both become the field {name}: give one a field name"
            yield Found(places.layout(signal, "field"), signal.name, text, message.name)


RULE = Rule(
    "name-unique", "no two things that share a space of names have one name", _check, foreign=True
)
