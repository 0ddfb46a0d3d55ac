"""Rule table-annex-agree: the tables and the annex have the same lengths, a message one sender."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from dbcspec.lint.places import node_names
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.spec.rows import FieldRow, MessageRow, SignalRow, Spec


def _check(subject: Subject) -> Iterator[Found]:
    if subject.spec:
        yield from _lengths(subject.spec)
        yield from _senders(subject.spec)
        yield from _reserved(subject.spec)


def _lengths(spec: Spec) -> Iterator[Found]:
    explained = spec.explanations()
    for message, field in spec.fields():
        for _, row in explained[message.name, field.name]:
            if row.length != field.length:
                yield _differ(row, field, row.name)


def _differ(row: SignalRow, field: FieldRow, subject: str) -> Found:
    printed = "no length" if row.length is None else f"{row.length} bits"
    text = (
        f"{row.name} has {printed} here, but {field.length} in the annex at "
        f"{field.where_is('length')}: correct one by an erratum"
    )
    return Found(row.where_is("length"), subject, text)


def _senders(spec: Spec) -> Iterator[Found]:
    nodes = node_names(spec)
    explained = spec.explanations()
    for message in spec.messages.messages:
        sent = [
            (row, nodes.get(row.route[0], row.route[0]))
            for field in message.signals
            for _, row in explained.get((message.name, field.name), ())
            if row.route
        ]
        if not sent:
            continue
        (usual, _), *_ = Counter(sender for _, sender in sent).most_common(1)
        for row, sender in sent:
            if sender != usual:
                text = (
                    f"{row.name} is sent by {sender}, but the rest of {message.name} by {usual}: "
                    f"correct one by an erratum"
                )
                yield Found(row.where_is("route"), row.name, text)


def _reserved(spec: Spec) -> Iterator[Found]:
    """A table of one message that prints all reserved fields prints their lengths right."""
    for table in spec.tables:
        names = {row.name for row in table.rows}
        messages = [
            message
            for message in spec.messages.messages
            if names & {field.name for field in message.signals} - {*spec.standard.reserved}
        ]
        if len(messages) != 1:
            continue
        rows = [row for row in table.rows if row.name in spec.standard.reserved]
        fields = _reserved_fields(spec, messages[0])
        if len(rows) == len(fields):
            for row, field in zip(rows, fields, strict=True):
                if row.length != field.length:
                    yield _differ(row, field, f"{table.stem}/{row.no}")


def _reserved_fields(spec: Spec, message: MessageRow) -> list[FieldRow]:
    return [field for field in message.signals if field.name in spec.standard.reserved]


RULE = Rule(
    "table-annex-agree", "tables and annex have the same lengths, and a message one sender", _check
)
