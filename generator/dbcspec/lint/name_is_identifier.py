"""Rule name-is-identifier: every name can stand in a DBC file."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.naming import name_fault
from typedcan.model.protocol import NOWHERE, Aspect


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    protocol = subject.protocol
    named = [
        *((places.message(each, "name"), each.name, each.name) for each in protocol.messages),
        *((places.layout(sig, "name"), sig.name, msg.name) for msg, sig in protocol.signals()),
    ]
    known = {name for _, name, _ in named}
    named += (
        (places.name(table), table.name, "")
        for table in protocol.value_tables
        # Names that the reader made up for codes without one are no names.
        if table.name not in known and Aspect.VALUE_TABLE_NAMES in protocol.carries
    )
    named += (
        ((node.where_is("name"), node.name, "") for node in subject.spec.standard.nodes)
        if subject.spec
        else ((NOWHERE, node.name, "") for node in protocol.nodes)
    )
    for where, name, message in named:
        if fault := name_fault(name):
            yield Found(where, name, f"{name} {fault}: rename it", message)


RULE = Rule("name-is-identifier", "every name can stand in a DBC file", _check)
