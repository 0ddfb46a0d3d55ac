"""The texts of a protocol that stand in its DBC files, each with its place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from dbcspec.errors import Location
from dbcspec.lint.places import Places
from dbcspec.lint.rule import Subject
from dbcspec.model import NOWHERE, Protocol
from dbcspec.rows import Spec


class Use(Enum):
    """What a text is in a DBC file."""

    COMMENT = "comment"
    UNIT = "unit"
    LABEL = "label"


@dataclass(frozen=True, slots=True)
class Text:
    """A text, whose it is, and what; ``english`` where it stands in the ASCII files."""

    where: Location
    subject: str
    what: str
    text: str
    english: bool = True
    use: Use = Use.COMMENT


def texts(subject: Subject) -> Iterator[Text]:
    """All texts that go into DBC files."""
    places = Places(subject)
    yield from _of_spec(subject.spec) if subject.spec else _of_model(subject.protocol)
    for message in subject.protocol.messages:
        where = places.message(message, "english")
        yield Text(where, message.name, f"english of {message.name}", message.english)
    for _, signal in subject.protocol.signals():
        name = signal.name
        english, title = places.meaning(signal, "english"), places.meaning(signal, "title")
        yield Text(english, name, f"english of {name}", signal.english)
        yield Text(title, name, f"title of {name}", signal.title, english=False)
        unit = places.meaning(signal, "unit")
        yield Text(unit, name, f"unit {signal.unit!r} of {name}", signal.unit, use=Use.UNIT)
    yield from _labels(subject.protocol, places)


def _labels(protocol: Protocol, places: Places) -> Iterator[Text]:
    for table in protocol.value_tables:
        yield Text(places.name(table), table.name, f"name of {table.name}", table.name)
        for code in table.codes:
            what = f"{code.english!r}, label {code.value} of {table.name},"
            where = places.codes(table, code.value)
            yield Text(where, table.name, what, code.english, use=Use.LABEL)
            if code.label != code.english:
                what = f"{code.label!r}, label {code.value} of {table.name},"
                where = places.codes(table)
                yield Text(where, table.name, what, code.label, english=False, use=Use.LABEL)


def _of_spec(spec: Spec) -> Iterator[Text]:
    """What the model joins or copies from rows, at the rows."""
    standard = spec.standard
    for key in ("number", "english", "part_english"):
        yield Text(standard.where_is(key), key, key, getattr(standard, key))
    for key in ("title", "part_title"):
        yield Text(standard.where_is(key), key, key, getattr(standard, key), english=False)
    for node in standard.nodes:
        what = f"english of {node.name}"
        yield Text(node.where_is("english"), node.name, what, node.english)
        what = f"title of {node.name}"
        yield Text(node.where_is("title"), node.name, what, node.title, english=False)
    yield Text(spec.messages.where_is("annex"), "annex", "annex", spec.messages.annex)
    for table in spec.tables:
        what = f"clause of table {table.number}"
        yield Text(table.where_is("clause"), table.stem, what, table.clause)
        what = f"title of table {table.number}"
        yield Text(table.where_is("title"), table.stem, what, table.title, english=False)
    for timing in spec.behaviour.timing:
        what = f"condition of {timing.name}"
        yield Text(timing.where_is("condition"), timing.name, what, timing.condition)


def _of_model(protocol: Protocol) -> Iterator[Text]:
    yield Text(NOWHERE, protocol.name, "number of the protocol", protocol.number)
    yield Text(NOWHERE, protocol.name, "english of the protocol", protocol.english)
    yield Text(NOWHERE, protocol.name, "title of the protocol", protocol.title, english=False)
    for node in protocol.nodes:
        yield Text(NOWHERE, node.name, f"english of {node.name}", node.english)
        yield Text(NOWHERE, node.name, f"title of {node.name}", node.title, english=False)
    for message in protocol.messages:
        where, name = message.where, message.name
        yield Text(where, name, f"title of {name}", message.title, english=False)
        yield Text(where, name, f"condition of {name}", message.condition)
        yield Text(where, name, f"reference of {name}", message.reference)
    for _, signal in protocol.signals():
        what = f"reference of {signal.name}"
        yield Text(signal.where, signal.name, what, signal.reference)
