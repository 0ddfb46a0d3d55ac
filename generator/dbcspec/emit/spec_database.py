"""What a protocol carries beside messages as the database.yaml of a spec folder."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.emit.spec_yaml import Pairs, list_lines, scalar
from typedcan.model.extras import Attribute, EnvironmentVariable
from typedcan.model.protocol import Protocol


def database_lines(protocol: Protocol) -> list[str]:
    """The lines of the file, none where there is nothing to say."""
    lines = [f"version: {scalar(protocol.version)}"] if protocol.version else []
    lines += list_lines(
        "definitions",
        (
            [
                ("name", each.name),
                ("of", each.of or None),
                ("type", each.type),
                ("default", each.default),
            ]
            for each in protocol.definitions
        ),
    )
    lines += list_lines("attributes", _attributes(protocol))
    lines += list_lines(
        "groups",
        (
            [
                ("name", group.name),
                ("message", message.name),
                ("repetitions", group.repetitions),
                ("signals", group.signals),
            ]
            for message in protocol.messages
            for group in message.groups
        ),
    )
    lines += list_lines("variables", map(_variable, protocol.variables))
    head = "# What goes into DBC files for tools that know of it: attributes, groups, variables."
    return [head, *lines] if lines else []


def not_in_spec(protocol: Protocol) -> Iterator[str]:
    """What of a protocol no spec made of it says, a line each."""
    used = {signal.value_table for _, signal in protocol.signals()}
    if unused := [each.name for each in protocol.value_tables if each not in used]:
        yield f"not in the spec: value tables that no signal has: {', '.join(unused)}"
    if protocol.errata:
        yield f"not in the spec: {len(protocol.errata)} errata"


def _attributes(protocol: Protocol) -> Iterator[Pairs]:
    def rows(attributes: tuple[Attribute, ...], owner: Pairs) -> Iterator[Pairs]:
        for each in attributes:
            yield [("name", each.name), *owner, ("value", each.value)]

    yield from rows(protocol.attributes, [])
    for node in protocol.nodes:
        yield from rows(node.attributes, [("node", node.name)])
    for message in protocol.messages:
        yield from rows(message.attributes, [("message", message.name)])
        for signal in message.signals:
            yield from rows(signal.attributes, [("message", message.name), ("signal", signal.name)])
        for each in message.relations:
            yield [
                ("name", each.name),
                ("node", each.node),
                ("message", message.name),
                ("signal", each.signal or None),
                ("value", each.value),
            ]
    for variable in protocol.variables:
        yield from rows(variable.attributes, [("variable", variable.name)])


def _variable(variable: EnvironmentVariable) -> Pairs:
    return [
        ("name", variable.name),
        ("kind", variable.kind),
        ("minimum", variable.minimum),
        ("maximum", variable.maximum),
        ("unit", variable.unit or None),
        ("initial", variable.initial),
        ("id", variable.id),
        ("access", variable.access),
        ("nodes", variable.nodes),
        ("size", variable.size),
        ("comment", variable.comment or None),
        ("codes", dict(variable.codes) or None),
    ]
