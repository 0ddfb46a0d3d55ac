"""The spec as typed rows, in the order and with the values of the printed document.

A row may lack what the print lacks; errata fill the gaps, `resolve` insists that none is left.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import ClassVar

from dbcspec.spec.behaviour_rows import Behaviour
from dbcspec.spec.database_rows import Database
from dbcspec.spec.errata_rows import Errata, ErratumRow
from dbcspec.spec.schema import (
    DECIMAL,
    INTEGER,
    NAME,
    RANGE,
    ROUTE,
    SIGNAL,
    TEXT,
    Kind,
    Record,
    expect_table,
    expect_text,
    key,
    list_of,
    map_of,
    nested,
    one_of,
    pattern,
    whole_number,
)
from dbcspec.spec.source import Node
from dbcspec.spec.standard_rows import Standard


@dataclass(frozen=True, slots=True)
class SameCodes:
    """A code cell that prints again what another row of the same table prints."""

    row: str


_CODES = map_of(INTEGER, TEXT)


def _read_codes(node: Node) -> Mapping[int, str] | SameCodes:
    entries = expect_table(node).entries
    if [name.text for name, _ in entries] == ["same_as"]:
        return SameCodes(expect_text(entries[0][1]))
    codes: Mapping[int, str] = _CODES.read(node)
    return codes


_MOST = 1785
"""Bytes of the longest transfer that J1939 knows; no frame has so many, which the linter tells."""

BYTES = whole_number(0, _MOST)
BITS = whole_number(1, 8 * _MOST)
START = whole_number(0, 8 * _MOST - 1)
CODES = Kind("codes and their labels", _read_codes, _CODES.schema)
LIST_OF_TEXT = list_of(TEXT)
EDITION_NAME = r"[A-Za-z0-9][A-Za-z0-9._-]{0,40}"
EDITION = pattern("a name (letters, digits, dot, dash)", EDITION_NAME, str)


@dataclass(frozen=True, slots=True, kw_only=True)
class FieldRow(Record):
    """A signal's place in its frame: a row of the annex."""

    name: str = key(NAME, "signal name", required=True)
    length: int | None = key(BITS, "bits")
    start: int | None = key(START, "start bit as printed, counted from bit 0")
    field: str = key(NAME, "name in generated code, where the derived one is poor", default="")
    byte_order: str = key(one_of("Intel", "Motorola"), "where it differs from its message's")
    type: str = key(one_of("unsigned", "signed", "float"), "raw value", default="unsigned")
    initial: int | None = key(INTEGER, "raw value at first, where not the invalid code or 0")
    selector: str = key(one_of("yes", "no"), "whether it selects other signals", default="no")
    multiplexer: str = key(NAME, "the signal that selects this one", default="")
    selectors: tuple[int, ...] = key(list_of(INTEGER), "its values that do", default=())


@dataclass(frozen=True, slots=True, kw_only=True)
class MessageRow(Record):
    """A message of the annex."""

    MAIN: ClassVar[str] = "signals"

    id: int = key(INTEGER, "29-bit or 11-bit identifier", required=True)
    name: str = key(NAME, "message name", required=True)
    english: str = key(TEXT, "what it carries, in English", default="")
    length: int | None = key(BYTES, "bytes")
    type: str = key(one_of("Cyclic", "IfActive", "Event"), "how it is sent")
    period: int | None = key(INTEGER, "ms; 0 where it is sent on an event only")
    byte_order: str = key(one_of("Intel", "Motorola"), "where it differs from the document's")
    extended: str = key(one_of("yes", "no"), "29-bit identifier, where frame_format says otherwise")
    by_pgn: str = key(one_of("yes", "no"), "found by its PGN, where frame_format says otherwise")
    fd: str = key(one_of("yes", "no"), "CAN FD frames, where frame_format says otherwise")
    bit_rate_switch: str = key(
        one_of("yes", "no"), "whether a CAN FD payload has the second bit rate", default="yes"
    )
    sender: str = key(NAME, "who sends it, where no signal table says so", default="")
    other_senders: tuple[str, ...] = key(list_of(NAME), "who else may send it", default=())
    prefixes: tuple[str, ...] = key(
        LIST_OF_TEXT, "what field names in generated code leave off", default=()
    )
    signals: tuple[FieldRow, ...] = key(list_of(nested(FieldRow)), "its fields", required=True)
    annex: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Messages(Record):
    """messages.yaml: the annex that lays out the frames."""

    MAIN: ClassVar[str] = "messages"

    annex: str = key(TEXT, "number of the annex", required=True)
    byte_order: str = key(one_of("Intel", "Motorola"), "byte order and bit count", required=True)
    messages: tuple[MessageRow, ...] = key(list_of(nested(MessageRow)), "in order", required=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class SignalRow(Record):
    """A row of a signal table: what a signal means."""

    IDENTITY: ClassVar[str] = "no"

    no: int = key(INTEGER, "printed row number", required=True)
    name: str = key(NAME, "signal name", default="")
    message: str = key(NAME, "its message, where several have the name, each its own", default="")
    title: str = key(TEXT, "printed title", default="")
    english: str = key(TEXT, "short English title", default="")
    length: int | None = key(BITS, "bits")
    codes: Mapping[int, str] | SameCodes = key(CODES, "printed codes: labels", default={})
    english_codes: Mapping[int, str] = key(_CODES, "English for labels that need it", default={})
    factor: Decimal | None = key(DECIMAL, "physical value of one raw step")
    offset: Decimal | None = key(DECIMAL, "physical value of raw 0")
    unit: str | None = key(TEXT, "printed unit")
    range: tuple[Decimal, Decimal] | None = key(RANGE, "printed physical range")
    route: tuple[str, tuple[str, ...]] | None = key(ROUTE, "sender>receiver,receiver")

    @property
    def signal(self) -> str:
        """The signal that it explains: ``name``, or ``message.name`` where a message is given."""
        return f"{self.message}.{self.name}" if self.message else self.name

    @property
    def labels(self) -> Mapping[int, str]:
        """The codes; a reference to another row is already replaced when a spec is read."""
        return {} if isinstance(self.codes, SameCodes) else self.codes


@dataclass(frozen=True, slots=True, kw_only=True)
class SignalTable(Record):
    """tables/NN-….yaml: one table of the standard."""

    IDENTITY: ClassVar[str] = "stem"
    MAIN: ClassVar[str] = "rows"

    stem: str = ""
    number: int = key(INTEGER, "printed table number", required=True)
    title: str = key(TEXT, "printed caption", default="")
    english: str = key(TEXT, "short English caption", default="")
    clause: str = key(TEXT, "number of the clause it stands in", required=True)
    clause_title: str = key(TEXT, "printed title of the clause", default="")
    clause_english: str = key(TEXT, "the clause's title in English", default="")
    rows: tuple[SignalRow, ...] = key(list_of(nested(SignalRow)), "in order", required=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class EditionHead(Record):
    """edition.yaml: what another edition is, and where it is known from."""

    title: str = key(TEXT, "its title", required=True)
    english: str = key(TEXT, "its title in English", required=True)
    source: str = key(TEXT, "where its deviations are known from, in English", required=True)
    date: str = key(TEXT, "its date or year, as far as known", required=True)
    over: str = key(EDITION, "the edition that it changes (default: the standard)", default="")
    readings: tuple[str, ...] = key(list_of(NAME), "the alternatives that it takes", default=())
    value_tables: Mapping[str, str] = key(
        map_of(NAME, SIGNAL),
        "further value tables: name, and a signal that has these codes",
        default={},
    )
    warnings: tuple[str, ...] = key(
        LIST_OF_TEXT, "what its users have to know, in English", default=()
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class EditionMessages(Record):
    """messages.yaml of an edition: messages that the standard does not have."""

    MAIN: ClassVar[str] = "messages"

    messages: tuple[MessageRow, ...] = key(list_of(nested(MessageRow)), "in order", required=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class Edition:
    """editions/NAME/: a patch in the form of errata over the standard or another edition."""

    name: str
    head: EditionHead
    errata: tuple[ErratumRow, ...] = ()
    messages: tuple[MessageRow, ...] = ()
    tables: tuple[SignalTable, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Spec:
    """A whole spec folder as rows."""

    standard: Standard
    messages: Messages
    tables: tuple[SignalTable, ...]
    behaviour: Behaviour
    errata: tuple[ErratumRow, ...]
    database: Database | None = None
    editions: tuple[Edition, ...] = ()

    def rows(self) -> Iterator[tuple[SignalTable, SignalRow]]:
        """Every signal row with its table, reserved fields left out, in printed order."""
        for table in self.tables:
            for row in table.rows:
                if row.name not in self.standard.reserved:
                    yield table, row

    def explanations(self) -> dict[tuple[str, str], list[tuple[SignalTable, SignalRow]]]:
        """The rows that explain each field, by message and field name; empty where none does.

        Rows for that very message go before rows for a signal of that name in any message.
        """
        rows: dict[str, list[tuple[SignalTable, SignalRow]]] = {}
        for table, row in self.rows():
            rows.setdefault(row.signal, []).append((table, row))
        return {
            (message.name, field.name): rows.get(f"{message.name}.{field.name}")
            or rows.get(field.name, [])
            for message, field in self.fields()
        }

    def fields(self) -> Iterator[tuple[MessageRow, FieldRow]]:
        """Every signal of the annex with its message, reserved fields left out."""
        for message in self.messages.messages:
            for signal in message.signals:
                if signal.name not in self.standard.reserved:
                    yield message, signal


DOCUMENTS: Mapping[str, type[Record]] = {
    "standard": Standard,
    "messages": Messages,
    "table": SignalTable,
    "behaviour": Behaviour,
    "errata": Errata,
    "database": Database,
    "edition": EditionHead,
    "edition-messages": EditionMessages,
}
