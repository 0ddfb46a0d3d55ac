"""Rule name-is-identifier: every name can stand in a DBC file."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.model import NOWHERE
from dbcspec.naming import name_fault


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    protocol = subject.protocol
    named = [
        *((places.message(message, "name"), message.name) for message in protocol.messages),
        *((places.layout(signal, "name"), signal.name) for _, signal in protocol.signals()),
    ]
    known = {name for _, name in named}
    named += (
        (places.name(table), table.name)
        for table in protocol.value_tables
        if table.name not in known
    )
    named += (
        ((node.where_is("name"), node.name) for node in subject.spec.standard.nodes)
        if subject.spec
        else ((NOWHERE, node.name) for node in protocol.nodes)
    )
    for where, name in named:
        if fault := name_fault(name):
            yield where, name, f"{name} {fault}: rename it"


RULE = Rule("name-is-identifier", "every name can stand in a DBC file", _check)
