"""Messages that make something move: which they are, what was sent of them, their safe codes."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.wire.message import Field, Message

_KNOWN: dict[type[Message], tuple[Field, ...]] = {}  # looked up for every frame that is sent


def acting_fields(kind: type[Message]) -> tuple[Field, ...]:
    """The fields of a message with codes at which its receiver acts.

    Fields that only report that something is on are not among them.
    """
    if kind not in _KNOWN:
        fields = kind.FIELDS.values()
        _KNOWN[kind] = tuple(each for each in fields if each.acting and not each.acting.reports)
    return _KNOWN[kind]


def safe_codes(kind: type[Message]) -> Mapping[str, int]:
    """The safe raw value of each signal of a message that can act, by its DBC name."""
    return {field.dbc_name: field.acting.safe for field in acting_fields(kind) if field.acting}


def what_acts(message: Message) -> tuple[str, ...]:
    """The fields of a message that act with their labels, such as "hv_on_off = HV On"; often none.

    Raises `EncodeError` where such a field has a value that cannot be sent.
    """
    return tuple(
        f"{field.name} = {field.text(getattr(message, field.name))}"
        for field in acting_fields(type(message))
        if _acts(field, message)
    )


def acts(message: Message) -> bool:
    """Whether a message has a code at which its receiver acts; raises as `what_acts`."""
    return any(_acts(field, message) for field in acting_fields(type(message)))


def _acts(field: Field, message: Message) -> bool:
    value = getattr(message, field.name)
    if value is None or field.acting is None:  # of a branch that is not there
        return False
    return field.to_raw(message.NAME, value) in field.acting.codes


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
