"""What one sender sent last of the messages that can make something move."""

from __future__ import annotations

from typedcan.wire.acting import acting_fields, acts
from typedcan.wire.message import Message


class SentCommands:
    """What one sender sent last of each message that can act; any thread may tell it."""

    def __init__(self) -> None:
        self._last: dict[type[Message], Message] = {}
        self._acting: set[type[Message]] = set()

    def begin(self, message: Message) -> None:
        """A message is about to be sent.

        If it acts it counts from now on: a frame can go out although sending it raises.
        """
        kind = type(message)
        if acting_fields(kind):
            self._last[kind] = message
            if acts(message):
                self._acting.add(kind)

    def end(self, message: Message) -> None:
        """The bus has accepted a message: what it does not command is commanded no more.

        One that acts counts again: safe codes may have overtaken it.
        """
        kind = type(message)
        if acting_fields(kind):
            if acts(message):
                self._acting.add(kind)
            else:
                self._acting.discard(kind)

    def made_safe(self, message: Message) -> None:
        """The bus has accepted a message with its safe codes."""
        self._acting.discard(type(message))

    def last(self, kind: type[Message]) -> Message | None:
        """The last one of a message that can act."""
        return self._last.get(kind)

    @property
    def acting(self) -> tuple[Message, ...]:
        """Those of which the last one acts, as far as is known."""
        last = tuple(self._last.items())  # another thread may send a first one meanwhile
        return tuple(message for kind, message in last if kind in self._acting)

    @property
    def all(self) -> tuple[Message, ...]:
        """The last of each message that can act."""
        return tuple(self._last.values())
