"""Where the parts of a protocol stand in the spec that they come from, and what rules share."""

from __future__ import annotations

from dbcspec.lint.rule import Subject
from dbcspec.spec.rows import SignalRow, Spec
from typedcan.model.errors import Location
from typedcan.model.protocol import NOWHERE, Message, Protocol, Signal, ValueTable


class Places:
    """Finds the most precise place: a key of a spec row, else the place that the model carries."""

    def __init__(self, subject: Subject) -> None:
        spec = subject.spec
        explained = spec.explanations() if spec else {}
        self._rows: dict[Location, SignalRow] = {
            field.where: explained[message.name, field.name][0][1]
            for message, field in (spec.fields() if spec else ())
            if explained[message.name, field.name]
        }
        self._by_signal: dict[str, SignalRow] = {}
        for _, row in spec.rows() if spec else ():
            self._by_signal.setdefault(row.signal, row)
        self._fields = {field.where: field for _, field in spec.fields()} if spec else {}
        self._acts = {row.signal: row for row in spec.behaviour.acts} if spec else {}
        self._messages = {row.where: row for row in spec.messages.messages} if spec else {}
        self._naming = spec.standard.value_tables if spec else {}
        self._named_at = spec.standard.where_is("value_tables") if spec else NOWHERE
        self._users: dict[str, Signal] = {}
        for _, signal in subject.protocol.signals():
            if signal.value_table:
                self._users.setdefault(signal.value_table.name, signal)

    def meaning(self, signal: Signal, key: str) -> Location:
        """A key of the table row that explains a signal."""
        row = self._rows.get(signal.where)
        return row.where_is(key) if row else signal.where

    def layout(self, signal: Signal, key: str) -> Location:
        """A key of the annex row that places a signal in its message."""
        field = self._fields.get(signal.where)
        return field.where_is(key) if field else signal.where

    def acts(self, message: Message, signal: Signal, key: str) -> Location:
        """A key of the row that says which codes of a signal act."""
        row = self._acts.get(f"{message.name}.{signal.name}") or self._acts.get(signal.name)
        return row.where_is(key) if row else signal.where

    def message(self, message: Message, key: str) -> Location:
        """A key of a message in the annex."""
        row = self._messages.get(message.where)
        return row.where_is(key) if row else message.where

    def name(self, table: ValueTable) -> Location:
        """Where a value table gets its name."""
        return self._named_at if table.name in self._naming else self.codes(table)

    def codes(self, table: ValueTable, code: int | None = None) -> Location:
        """The code cell that makes a value table; with ``code`` the cell of its English label."""
        user = self._users.get(table.name)
        if table.name in self._naming:
            row = self._by_signal.get(self._naming[table.name])
        else:
            row = self._rows.get(user.where) if user else None
        if row:
            return row.where_is("english_codes" if code in row.english_codes else "codes")
        return user.where if user else NOWHERE


def node_names(spec: Spec) -> dict[str, str]:
    """Each printed name of a node, to its one name."""
    return {
        alias: node.name for node in spec.standard.nodes for alias in (node.name, *node.aliases)
    }


def value_tables(protocol: Protocol) -> tuple[ValueTable, ...]:
    """The value tables of a protocol and those that only its signals have."""
    used = (signal.value_table for _, signal in protocol.signals() if signal.value_table)
    return tuple(dict.fromkeys((*protocol.value_tables, *used)))
