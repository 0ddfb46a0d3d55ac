"""The words of a program, and what an edition has for them: messages, and what a node tells.

The classes of the program are the vocabulary. Signals are matched by name, codes by their meaning,
values by what they measure.
"""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable, Iterable, Mapping
from contextlib import aclosing
from dataclasses import MISSING, fields, replace
from typing import Any

from typedcan.model.signal_state import SignalState
from typedcan.spoken.meaning import Convert, member, to_edition, to_own
from typedcan.wire.errors import EncodeError, UnknownMessageError
from typedcan.wire.fields import Field, FilledField, LabelledField
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol
from typedcan.wire.receiver import Received


class Same:
    """Words where one speaks as the program does: nothing is turned into anything else."""

    def kind(self, kind: type[Message]) -> type[Message]:
        """The class as it is spoken."""
        return kind

    def own(self, kind: type[Message]) -> type[Message]:
        """The class of the program for one that is spoken; that one where there is none."""
        return kind

    def has(self, kind: type[Message]) -> bool:  # noqa: ARG002 - here all is had
        """Whether there is such a message in what is spoken."""
        return True

    def said(self, message: Message) -> Message:
        """The message as it is spoken."""
        return message

    def gist(self, message: Message) -> Message:
        """The message as far as it can be spoken."""
        return message

    def heard(self, message: Message) -> Message:
        """The message as the program has it."""
        return message

    def received(self, received: Received[Any]) -> Received[Any]:
        """What was received as the program has it."""
        return received

    def event(self, event: Any) -> Any:
        """What a node tells as the program has it."""
        return event

    def making(self, make: Callable[[], Iterable[Message]]) -> Callable[[], Iterable[Message]]:
        """What makes messages, as they are spoken."""
        return make

    def listening(
        self, kind: type[Any], callback: Callable[[Any], object]
    ) -> tuple[type[Any], Callable[[Any], object]]:
        """What to call back with, and what is called."""
        return kind, callback

    def wanted(self, kind: Any) -> Any:
        """The class of what is wanted, be it a message, as it is spoken, or an event."""
        return kind

    def stream(self, events: AsyncGenerator[Any, None]) -> AsyncGenerator[Any, None]:
        """Events as the program has them."""
        return events


class Words(Same):
    """Turns messages of one vocabulary into those of another edition, and back.

    What is said: a value is that value in the scale of the edition, a code the one with the same
    English label, invalid the edition's invalid code. Signals that only the edition has get their
    start value. Raises `EncodeError` for a meaning that the edition has no code for.

    What is heard: the same the other way round. Signals that only the edition has are left out,
    those that it has not are invalid. A code without a word in the vocabulary is its invalid code,
    or ``~code`` where it has none: a negative number, which is no code of anything.
    """

    def __init__(self, own: Protocol, edition: Protocol) -> None:
        self._name = edition.model.chosen or edition.name
        by_name = {kind.NAME: kind for kind in edition.messages}
        by_number = {(kind.FRAME_ID, kind.EXTENDED): kind for kind in edition.messages}
        self._spoken: dict[type[Message], type[Message]] = {}
        for kind in own.messages:
            found = by_name.get(kind.NAME) or by_number.get((kind.FRAME_ID, kind.EXTENDED))
            if found:
                self._spoken[kind] = found
        self._own = {spoken: own for own, spoken in self._spoken.items()}
        self._edition = frozenset(edition.messages)
        self._say: dict[tuple[type[Message], bool], Callable[[Message], Message]] = {}
        self._hear: dict[type[Message], Callable[[Message], Message]] = {}

    def kind(self, kind: type[Message]) -> type[Message]:
        """The class that the edition has for an own one; raises `UnknownMessageError`."""
        if kind in self._edition:
            return kind
        if kind not in self._spoken:
            raise UnknownMessageError(f"{self._name} has no message {kind.NAME}")
        return self._spoken[kind]

    def own(self, kind: type[Message]) -> type[Message]:
        """The own class for one of the edition; that one where there is none."""
        return self._own.get(kind, kind)

    def has(self, kind: type[Message]) -> bool:
        """Whether the edition has such a message."""
        return kind in self._spoken or kind in self._edition

    def said(self, message: Message) -> Message:
        """The message as the edition has it."""
        return self._said(message, strict=True)

    def gist(self, message: Message) -> Message:
        """The message as far as the edition has it.

        What there is no signal for is left out, what there is no code for is invalid, if it can be.
        """
        return self._said(message, strict=False)

    def _said(self, message: Message, *, strict: bool) -> Message:
        kind = type(message)
        if kind in self._edition:
            return message
        if (kind, strict) not in self._say:
            made = _saying(kind, self.kind(kind), self._name, strict=strict)
            self._say[kind, strict] = made
        return self._say[kind, strict](message)

    def heard(self, message: Message) -> Message:
        """The message of the edition in the own class, if there is one."""
        kind = type(message)
        if kind not in self._own:
            return message
        if kind not in self._hear:
            self._hear[kind] = _hearing(kind, self._own[kind])
        return self._hear[kind](message)

    def received(self, received: Received[Any]) -> Received[Any]:
        """What was received, in the own class."""
        return Received(self.heard(received.message), received.frame, received.faults)

    def event(self, event: Any) -> Any:
        """What a node tells, with the own classes in it."""
        if isinstance(event, Received):
            return self.received(event)
        kind = getattr(event, "message", None)
        if not isinstance(kind, type) or kind not in self._own:
            return event
        own = self._own[kind]
        if not hasattr(event, "field"):
            return replace(event, message=own)
        old = kind.FIELDS[event.field]
        new = next((each for each in own.FIELDS.values() if each.dbc_name == old.dbc_name), None)
        if new is None:
            return event
        return replace(event, message=own, field=new.name, value=to_own(old, new)(event.value))

    def making(self, make: Callable[[], Iterable[Message]]) -> Callable[[], Iterable[Message]]:
        """What makes messages, as the edition has them."""
        return lambda: tuple(map(self.said, make()))

    def listening(
        self, kind: type[Any], callback: Callable[[Any], object]
    ) -> tuple[type[Any], Callable[[Any], object]]:
        """What to call back with, and what is called."""
        return self.wanted(kind), lambda event: callback(self.event(event))

    def wanted(self, kind: Any) -> Any:
        """The class of what is wanted, be it a message, as it is spoken, or an event."""
        return self._spoken.get(kind, kind)

    async def _events(self, events: AsyncGenerator[Any, None]) -> AsyncGenerator[Any, None]:
        async with aclosing(events):
            async for event in events:
                yield self.event(event)

    def stream(self, events: AsyncGenerator[Any, None]) -> AsyncGenerator[Any, None]:
        """Events with the own classes in them."""
        return self._events(events)


def _by_signal(kind: type[Message]) -> dict[str, Field]:
    return {field.dbc_name: field for field in kind.FIELDS.values()}


def _saying(
    own: type[Message], edition: type[Message], name: str, *, strict: bool
) -> Callable[[Message], Message]:
    """What says a message of the own class in the class of the edition."""
    theirs, parts = _by_signal(edition), list[tuple[str, str, Convert]]()
    for signal, field in _by_signal(own).items():
        other = theirs.pop(signal, None)
        if other:
            convert = to_edition(field, other, own.NAME, name, strict=strict)
            parts.append((field.name, other.name, convert))
        elif strict:
            parts.append((field.name, "", _nothing(field, own, name)))
    needed = [field for field in theirs.values() if _defaults(edition)[field.name] is MISSING]
    # What stands for no value would act.
    given = {field.name: field.acting.safe for field in needed if field.acting}
    # What is filled in for the program may be a signal like others in the edition.
    may_lack = {*edition.SELECTED} | {
        field.name for field in edition.FIELDS.values() if isinstance(field, FilledField)
    }
    make: Any = edition

    def say(message: Message) -> Message:
        values: dict[str, Any] = dict(given)
        for mine, their, convert in parts:
            value = getattr(message, mine)
            said = None if value is None else convert(value)
            if their and (said is not None or their in may_lack):
                values[their] = said
        made: Message = make(**values)
        return made

    return say


def _defaults(kind: Any) -> Mapping[str, Any]:
    """What the fields of a message class hold where nothing is given, or `MISSING`."""
    return {each.name: each.default for each in fields(kind)}


def _nothing(field: Field, own: type[Message], name: str) -> Convert:
    """What passes over a signal that the edition has not, unless it says something."""
    empty = (field.signal.start_value, field.acting.safe if field.acting else None)

    def check(value: Any) -> None:
        raw = field.to_raw(own.NAME, value)
        if raw not in empty and not isinstance(field, FilledField):
            problem = f"{name} has no such signal: {field.text(value)} cannot be said"
            raise EncodeError(own.NAME, field.name, value, problem)

    return check


def _hearing(edition: type[Message], own: type[Message]) -> Callable[[Message], Message]:
    """What hears a message of the edition in the own class."""
    theirs, parts = _by_signal(edition), list[tuple[str, str, Convert]]()
    missing: dict[str, Any] = {}
    for signal, field in _by_signal(own).items():
        if signal in theirs:
            parts.append((theirs[signal].name, field.name, to_own(theirs[signal], field)))
        else:
            missing[field.name] = _no_value(own, field)
    make: Any = own

    def hear(message: Message) -> Message:
        values: dict[str, Any] = dict(missing)
        for their, mine, convert in parts:
            value = getattr(message, their)
            values[mine] = None if value is None else convert(value)
        made: Message = make(**values)
        return made

    return hear


def _no_value(own: type[Message], field: Field) -> Any:
    """What an own field holds where the edition has no such signal."""
    if field.name in own.SELECTED or isinstance(field, FilledField):
        return None
    if isinstance(field, LabelledField):
        code = field.signal.invalid_code
        return member(field, field.signal.start_value if code is None else code)
    default = _defaults(own)[field.name]
    return SignalState.INVALID if default is MISSING else default
