"""The texts of a protocol that stand in its DBC files, each with its place."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from dbcspec.lint.places import Places, value_tables
from dbcspec.lint.rule import Subject
from dbcspec.spec.rows import Spec
from typedcan.model.errors import Location
from typedcan.model.protocol import NOWHERE, Aspect, Protocol


class Use(Enum):
    """What a text is in a DBC file."""

    COMMENT = "comment"
    UNIT = "unit"
    LABEL = "label"


@dataclass(frozen=True, slots=True)
class Text:
    """A text, whose it is, and what; ``english`` where it stands in the ASCII files.

    There a title stands in for an English text that is missing.
    """

    where: Location
    subject: str
    what: str
    text: str
    english: bool = True
    use: Use = Use.COMMENT
    message: str = ""


def texts(subject: Subject) -> Iterator[Text]:
    """All texts that go into DBC files; a text that is the same in both languages once."""
    places = Places(subject)
    yield from _of_spec(subject.spec) if subject.spec else _of_model(subject.protocol)
    for message in subject.protocol.messages:
        where, name = places.message(message, "english"), message.name
        # Without an English text of its own, the title stands in the English files.
        text = message.english or (message.title if subject.spec else "")
        yield Text(where, name, f"{_comment(subject)} of {name}", text, message=name)
    yield from _of_signals(subject, places)
    yield from _labels(subject.protocol, places)


def _comment(subject: Subject) -> str:
    """What the English text of a message or signal is called where it comes from."""
    return "english" if subject.spec else "comment"


def _of_signals(subject: Subject, places: Places) -> Iterator[Text]:
    called = _comment(subject)
    for message, signal in subject.protocol.signals():
        name, owner = signal.name, message.name
        where = places.meaning(signal, "english")
        yield Text(where, name, f"{called} of {name}", signal.english, message=owner)
        if signal.title != signal.english:
            where, what = places.meaning(signal, "title"), f"title of {name}"
            alone = not signal.english
            yield Text(where, name, what, signal.title, english=alone, message=owner)
        where, what = places.meaning(signal, "unit"), f"unit {signal.unit!r} of {name}"
        yield Text(where, name, what, signal.unit, use=Use.UNIT, message=owner)


def _labels(protocol: Protocol, places: Places) -> Iterator[Text]:
    for table in value_tables(protocol):
        if Aspect.VALUE_TABLE_NAMES in protocol.carries:
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
    name = protocol.name
    yield Text(NOWHERE, name, "number of the protocol", protocol.number)
    yield Text(NOWHERE, name, "comment of the protocol", protocol.english)
    if protocol.title != protocol.english:
        yield Text(NOWHERE, name, "title of the protocol", protocol.title, english=False)
    for node in protocol.nodes:
        yield Text(NOWHERE, node.name, f"comment of {node.name}", node.english)
        if node.title != node.english:
            yield Text(NOWHERE, node.name, f"title of {node.name}", node.title, english=False)
    for message in protocol.messages:
        where, name = message.where, message.name
        if message.title != message.english:
            yield Text(where, name, f"title of {name}", message.title, english=False, message=name)
        yield Text(where, name, f"condition of {name}", message.condition, message=name)
        yield Text(where, name, f"reference of {name}", message.reference, message=name)
    for message, signal in protocol.signals():
        what = f"reference of {signal.name}"
        yield Text(signal.where, signal.name, what, signal.reference, message=message.name)
