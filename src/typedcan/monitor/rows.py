"""Messages and signals as rows of a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from typedcan.model.signal_state import SignalState
from typedcan.monitor.glance import Seen
from typedcan.supervise.events import SignalKind, State
from typedcan.supervise.signal_watch import Judge, watched_fields
from typedcan.supervise.snapshot import MessageSnapshot
from typedcan.wire.fields import CharacterField, Field, LabelledField, Value
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

NEVER_SEEN = str(State.NEVER_SEEN)
LATE = str(State.LATE)
LOST = str(State.LOST)
ENDED = "ended"
SEEN = "seen"

_ENDED_PERIODS = 5


@dataclass(frozen=True, slots=True)
class MessageRow:
    """A message as the monitor knows it; times are in seconds.

    Parameters
    ----------
    name, frame_id, is_extended, sender, receivers
        What the protocol says of it; the identifier has 29 bits or 11, and of several senders
        there are all, with commas.
    state
        "alive", "late" or "lost" of what has to come always; "ended" of what comes while a
        condition holds, and no longer does; "seen" of what comes on events; or "never seen".
    frames, age
        How many frames were taken, and how long ago the last one was.
    period, mean, jitter, worst
        The protocol's period, and mean, standard deviation and longest of those measured.
    faults
        How many frames had a wrong length, checksum or counter.
    wrong
        How many of its signals say now that something is wrong.
    """

    name: str
    frame_id: int
    is_extended: bool
    sender: str
    receivers: tuple[str, ...]
    state: str
    frames: int
    age: float | None
    period: float | None
    mean: float | None
    jitter: float | None
    worst: float | None
    faults: Mapping[str, int]
    wrong: int

    @property
    def fault_count(self) -> int:
        """All faults together."""
        return sum(self.faults.values())

    @property
    def identifier(self) -> str:
        """The identifier, as people write it."""
        return identifier_text(self.frame_id, is_extended=self.is_extended)

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it."""
        return {**asdict(self), "receivers": list(self.receivers)}

    def matches(self, text: str) -> bool:
        """Whether name, identifier, a node or the state has this text, in whatever case."""
        words = (self.name, self.identifier, self.sender, *self.receivers, self.state)
        return any(text.lower() in word.lower() for word in words)


def identifier_text(frame_id: int, *, is_extended: bool) -> str:
    """An identifier of 29 bits or 11, told apart by the number of digits."""
    return f"0x{frame_id:08X}" if is_extended else f"0x{frame_id:03X}"


def message_row(kind: type[Message], known: MessageSnapshot, protocol: Protocol) -> MessageRow:
    """The row of a message of which supervision knows this."""
    return MessageRow(
        name=kind.NAME,
        frame_id=kind.FRAME_ID,
        is_extended=kind.EXTENDED,
        sender=", ".join(kind.MODEL.senders),
        receivers=kind.RECEIVERS,
        state=_state(kind, known, protocol),
        frames=known.frames,
        age=known.age,
        period=kind.PERIOD,
        mean=known.period.mean,
        jitter=known.period.jitter,
        worst=known.period.worst,
        faults=known.faults,
        wrong=len(known.signals),
    )


def _state(kind: type[Message], known: MessageSnapshot, protocol: Protocol) -> str:
    if known.state is State.ALIVE and not known.expected and known.age is not None:
        if kind.PERIOD is None:
            return SEEN
        if kind in protocol.conditional and known.age > _ENDED_PERIODS * kind.PERIOD:
            return ENDED
    return str(known.state)


@dataclass(frozen=True, slots=True)
class SignalRow:
    """A signal with what it held last.

    ``value`` goes with ``unit`` or ``label``, ``mark`` is what is wrong with it if anything, and
    ``age`` the seconds since it came, None where it never did.
    """

    name: str
    title: str
    value: str
    unit: str
    label: str
    mark: SignalKind | None
    age: float | None

    def matches(self, text: str) -> bool:
        """Whether name, title, label or mark has this text, in whatever case."""
        words = (self.name, self.title, self.label, self.mark or "")
        return any(text.lower() in word.lower() for word in words)


def signal_rows(
    protocol: Protocol,
    kind: type[Message],
    seen: Seen | None,
    branches: Mapping[str, Seen],
    now: float,
) -> tuple[SignalRow, ...]:
    """The rows of all signals of a message, empty of values where it never came.

    Those of branches, by their names, are what the last frame with their branch had.
    """
    rows: list[SignalRow] = []
    for field in kind.FIELDS.values():
        last = branches.get(field.name) if field.name in kind.SELECTED else seen
        value: Value = getattr(last.received.message, field.name) if last else None
        text, label = _value_and_label(field, value)
        rows.append(
            SignalRow(
                name=field.dbc_name,
                title=field.title,
                value=text,
                unit=field.unit,
                label=label,
                mark=mark_of(protocol, kind, field.name, value),
                age=now - last.at if last else None,
            )
        )
    return tuple(rows)


def mark_of(protocol: Protocol, kind: type[Message], field: str, value: Value) -> SignalKind | None:
    """What is wrong with the value of a signal, if anything; None is no value."""
    judge = None if value is None else _judges(protocol)[kind].get(field)
    return judge(value) if judge else None


@cache
def _judges(protocol: Protocol) -> Mapping[type[Message], Mapping[str, Judge]]:
    return {
        kind: {name: field.judge for name, field in watched_fields(protocol, kind).items()}
        for kind in protocol.messages
    }


def _value_and_label(field: Field, value: Value) -> tuple[str, str]:
    if value is None:
        return "", ""
    if isinstance(value, SignalState):
        return "", str(value)
    if isinstance(field, LabelledField) and isinstance(value, int):
        return str(int(value)), field.labels.get(value, "")
    if isinstance(field, CharacterField):
        return field.text(value), ""
    return (f"{value:.10g}" if isinstance(value, float) else str(value)), ""
