"""database.yaml to the model: each value to what has it."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

from dbcspec.errors import Fault
from dbcspec.spec.database_rows import AttributeRow, Database, VariableRow
from dbcspec.spec.schema import Record
from typedcan.model.extras import (
    Attribute,
    AttributeDefinition,
    EnvironmentVariable,
    Relation,
    SignalGroup,
)
from typedcan.model.protocol import Message, Protocol

_Owner = tuple[str, str, str, str]
"""Node, message, signal and variable, "" where there is none."""


def with_database(protocol: Protocol, rows: Database | None, faults: list[Fault]) -> Protocol:
    """The protocol with what its database.yaml says; names that are unknown become faults."""
    if rows is None:
        return protocol
    return _WithDatabase(protocol, rows, faults).protocol()


class _WithDatabase:
    def __init__(self, protocol: Protocol, rows: Database, faults: list[Fault]) -> None:
        self._protocol = protocol
        self._rows = rows
        self._faults = faults
        self._values: defaultdict[_Owner, list[Attribute]] = defaultdict(list)
        self._relations: defaultdict[str, list[Relation]] = defaultdict(list)
        self._groups: defaultdict[str, list[SignalGroup]] = defaultdict(list)

    def protocol(self) -> Protocol:
        """The protocol with it all."""
        known = self._known()
        defined = {row.name for row in self._rows.definitions}
        for row in self._rows.attributes:
            self._sort(row, known, defined)
        for each in self._rows.groups:
            group = SignalGroup(each.name, each.repetitions, each.signals)
            self._groups[each.message].append(group)
            for signal in each.signals:
                self._expect(("", each.message, signal, ""), known, each)
        protocol = self._protocol
        return replace(
            protocol,
            version=self._rows.version,
            definitions=tuple(
                AttributeDefinition(row.name, row.of, row.type, row.default)
                for row in self._rows.definitions
            ),
            attributes=self._of("", "", "", ""),
            variables=tuple(map(self._variable, self._rows.variables)),
            nodes=tuple(
                replace(each, attributes=self._of(each.name, "", "", "")) for each in protocol.nodes
            ),
            messages=tuple(map(self._message, protocol.messages)),
        )

    def _known(self) -> set[_Owner]:
        return {
            ("", "", "", ""),
            *((node.name, "", "", "") for node in self._protocol.nodes),
            *(("", message.name, "", "") for message in self._protocol.messages),
            *(
                ("", message.name, each.name, "")
                for message in self._protocol.messages
                for each in message.signals
            ),
            *(("", "", "", row.name) for row in self._rows.variables),
        }

    def _sort(self, row: AttributeRow, known: set[_Owner], defined: set[str]) -> None:
        if row.name not in defined:
            text = f"{row.name} has no definition: add it to definitions"
            self._faults.append(Fault(row.where_is("name"), text))
        elif row.node and row.message:
            self._expect(("", row.message, row.signal, ""), known, row)
            relation = Relation(row.name, row.node, row.value, row.signal)
            self._relations[row.message].append(relation)
        else:
            owner = (row.node, row.message, row.signal, row.variable)
            self._expect(owner, known, row)
            self._values[owner].append(Attribute(row.name, row.value))

    def _expect(self, owner: _Owner, known: set[_Owner], row: Record) -> None:
        if owner not in known:
            name = ".".join(filter(None, owner))
            self._faults.append(Fault(row.where, f"{row.identity}: there is no {name}"))

    def _of(self, *owner: str) -> tuple[Attribute, ...]:
        node, message, signal, variable = owner
        return tuple(self._values.get((node, message, signal, variable), ()))

    def _message(self, message: Message) -> Message:
        name = message.name
        return replace(
            message,
            groups=tuple(self._groups.get(name, ())),
            attributes=self._of("", name, "", ""),
            relations=tuple(self._relations.get(name, ())),
            signals=tuple(
                replace(each, attributes=self._of("", name, each.name, ""))
                for each in message.signals
            ),
        )

    def _variable(self, row: VariableRow) -> EnvironmentVariable:
        return EnvironmentVariable(
            name=row.name,
            kind=row.kind,
            minimum=row.minimum,
            maximum=row.maximum,
            unit=row.unit,
            initial=row.initial,
            id=row.id,
            access=row.access,
            nodes=row.nodes,
            size=row.size,
            comment=row.comment,
            codes=tuple(row.codes.items()),
            attributes=self._of("", "", "", row.name),
        )
