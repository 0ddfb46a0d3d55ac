"""Where in a log the signals and frames are that an occurrence is about."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from typedcan.judge.findings import Subject
from typedcan.judge.measure.steps import keyed
from typedcan.wire.fields import Field, LabelledField
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_MOST = 6
"""Messages that are shown of a node."""

_FRAME_OF_CYCLE = re.compile(r"CSC (\d+) frame (\d+)")
"""What `typedcan.judge.measure.steps.frame_of_cycle` writes."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """A signal of a message; or its frames, where the name of the signal is empty.

    Parameters
    ----------
    message, signal
        The message, and the signal's name in the DBC.
    unit, labels
        The signal's; labels only where its values are codes.
    name
        What it is called.
    only
        Values that signals of the message have in the frames that count, by their names.
    """

    message: type[Message]
    signal: str = ""
    unit: str = ""
    labels: Mapping[int, str] = field(default_factory=dict[int, str])
    name: str
    only: Mapping[str, int] = field(default_factory=dict[str, int])

    @property
    def needed(self) -> tuple[str, ...]:
        """The signals that have to be decoded."""
        return (*((self.signal,) if self.signal else ()), *self.only)


def sources_of(subject: Subject, protocol: Protocol) -> tuple[Source, ...]:
    """What to show for a subject: its signals; its message and the counter; or what a node sends.

    Of a message of several frames a cycle only those frames that the subject names. Names that
    are none of the protocol's are passed over.
    """
    messages = [each for each in protocol.messages if subject.message in ("", each.NAME)]
    signals = [source for message in messages for source in _signals(message, subject.signal)]
    if signals:
        beside = [each for other in protocol.messages for each in _signals(other, subject.detail)]
        return (*signals[:1], *beside[:1])
    if subject.message:
        shown = (source for message in messages for source in _frames(message))
        return tuple(_narrowed(source, subject.detail, protocol) for source in shown)
    sent = [
        message
        for message in messages
        if subject.node == message.SENDER and message.PERIOD and message not in protocol.conditional
    ]
    return tuple(Source(message=message, name=message.NAME) for message in sent[:_MOST])


def _signals(message: type[Message], name: str) -> Iterator[Source]:
    """The signal of that name, if the message has it."""
    for part in message.FIELDS.values():
        if name in (part.dbc_name, part.name):
            yield _signal(message, part)


def _frames(message: type[Message]) -> Iterator[Source]:
    yield Source(message=message, name=message.NAME)
    if message.COUNTER is not None:
        yield _signal(message, message.field_of(message.COUNTER.signal))


def _signal(message: type[Message], part: Field) -> Source:
    labels = part.labels if isinstance(part, LabelledField) else {}
    return Source(
        message=message, signal=part.dbc_name, unit=part.unit, labels=labels, name=part.dbc_name
    )


def _narrowed(source: Source, detail: str, protocol: Protocol) -> Source:
    found = _FRAME_OF_CYCLE.fullmatch(detail)
    fields = keyed(protocol).get(source.message)
    if found is None or fields is None:
        return source
    names = [source.message.FIELDS[each].dbc_name for each in fields]
    numbers = map(int, found.groups())
    only = dict(zip(names, numbers, strict=True))
    return replace(source, name=f"{source.name} {detail}", only=only)
