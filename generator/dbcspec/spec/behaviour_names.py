"""Behaviour may only speak of messages and signals that there are."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from dbcspec.errors import Fault
from dbcspec.spec.rows import Spec
from typedcan.model.protocol import Message

_IN_TRANSFERS = (
    *("items", "details", "frame_number", "group"),
    *("count_signal", "groups_signal", "length_signal"),
)
"""The keys of transfers that name signals."""


def unknown_names(spec: Spec, messages: Iterable[Message]) -> Iterator[Fault]:
    """Yield a fault for each name in behaviour.yaml that no message or signal has."""
    names = {message.name for message in messages}
    signals = {field.name for _, field in spec.fields()}
    in_messages = {f"{message.name}.{field.name}" for message, field in spec.fields()}
    behaviour = spec.behaviour
    for rows, key, known in (
        (behaviour.checksums, "signal", signals | in_messages),
        (behaviour.counters, "signal", signals | in_messages),
        (behaviour.requests, "signal", signals),
        (behaviour.acts, "signal", signals | in_messages),
        (behaviour.requests, "answers", names),
        (behaviour.timing, "messages", names),
        (behaviour.transfers, "messages", names),
        *((behaviour.transfers, key, signals | in_messages) for key in _IN_TRANSFERS),
    ):
        for row in rows:
            value = getattr(row, key)
            for name in (value,) if isinstance(value, str) else value:
                if name and name not in known:
                    text = f"{key}: there is no {name!r}"
                    yield Fault(row.where_is(key), text)
