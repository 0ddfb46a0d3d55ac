"""Which signals can say that something is wrong, and what they say from frame to frame."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

from typedcan.model.signal_state import SignalState
from typedcan.supervise.bit_places import ByteOrder, Place, bit_places
from typedcan.supervise.events import SignalChanged, SignalKind
from typedcan.supervise.right_codes import MOST_BITS, right_codes
from typedcan.supervise.snapshot import SignalSnapshot
from typedcan.wire.fields import (
    CharacterField,
    Field,
    FilledField,
    LabelledField,
    NumberField,
    Value,
)
from typedcan.wire.link import Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer

Judge = Callable[[Value], SignalKind | None]
"""What is wrong with the value of a signal, if anything."""

_STATES: Mapping[Value, SignalKind] = MappingProxyType(
    {SignalState.INVALID: "invalid", SignalState.ABNORMAL: "abnormal"}
)
_INVALID_LABELS = frozenset({"signal invalid", "invalid"})
_ALL_WELL = frozenset({"normal", "ok", "inactive"})
"""How the tables label code 0 of what is otherwise a fault; "inactive" is table 20's."""


class _Active(NamedTuple):
    kind: SignalKind
    value: Value
    since: float


class WatchedField(NamedTuple):
    """A signal that can say something is wrong.

    ``mask`` are its bits in the payload, with those of what selects it; where they make a number
    from ``low`` to ``high``, surely nothing is wrong. ``judge`` tells in any case.
    """

    mask: int
    name: str
    judge: Judge
    low: int
    high: int


class Watch:
    """The watched signals of a message; ``mask`` has the bits of all of them.

    ``order`` is the order of bytes in which a payload is one number.
    """

    __slots__ = ("fields", "mask", "order")

    def __init__(self, fields: Iterable[WatchedField], order: ByteOrder) -> None:
        self.fields = tuple(fields)
        self.order: ByteOrder = order
        self.mask = 0
        for field in self.fields:
            self.mask |= field.mask


class Signals:
    """What the watched signals of a message, or of one of its frames, said last.

    Parameters
    ----------
    watch
        The signals.
    onsets
        Where to count how often something began to be wrong.
    part
        Frame number, or group and frame number, where a message takes several frames.
    """

    __slots__ = ("_active", "_bits", "_data", "_onsets", "_part", "_watch")

    def __init__(
        self, watch: Watch, onsets: dict[SignalKind, int], part: tuple[int, ...] = ()
    ) -> None:
        self._watch = watch
        self._onsets = onsets
        self._part = part
        self._data = b""
        self._bits: int | None = None
        self._active: dict[str, _Active] = {}

    def take(self, received: Received[Message], now: float) -> list[SignalChanged] | None:
        """What changed with this payload; None where nothing did."""
        if received.data == self._data:
            return None
        self._data = received.data
        watched = self._watch.mask
        bits = int.from_bytes(received.data, self._watch.order) & watched
        before, self._bits = self._bits, bits
        changed = watched if before is None else bits ^ before
        if not changed:
            return None
        events: list[SignalChanged] = []
        active = self._active
        for mask, name, judge, low, high in self._watch.fields:
            if changed & mask and (not low <= bits & mask <= high or name in active):
                value: Value = getattr(received.message, name)
                if value is None:  # a branch that is not in this frame says nothing
                    continue
                kind = judge(value)
                if kind is not None or name in active:
                    events += self._change(received.kind, name, kind, value, now)
        return events

    def snapshot(self, message: type[Message]) -> list[SignalSnapshot]:
        """The signals that say something is wrong now."""
        return [
            SignalSnapshot(
                field=name,
                part=self._part,
                kind=active.kind,
                value=active.value,
                text=message.FIELDS[name].text(active.value),
                since=active.since,
            )
            for name, active in self._active.items()
        ]

    def _change(
        self, message: type[Message], field: str, kind: SignalKind | None, value: Value, now: float
    ) -> list[SignalChanged]:
        before = self._active.pop(field, None)
        events: list[SignalChanged] = []
        begins = before is None or before.kind != kind
        if before and begins:
            events.append(self._event(message, field, before.kind, value, now, active=False))
        if kind is None:
            return events
        if begins:
            self._onsets[kind] = self._onsets.get(kind, 0) + 1
        if begins or (kind == "alarm" and before and before.value != value):
            events.append(self._event(message, field, kind, value, now, active=True))
        self._active[field] = _Active(kind, value, before.since if before and not begins else now)
        return events

    def _event(
        self,
        message: type[Message],
        field: str,
        kind: SignalKind,
        value: Value,
        now: float,
        *,
        active: bool,
    ) -> SignalChanged:
        return SignalChanged(message, field, kind, active, value, now, self._part)


def watched_fields(protocol: Protocol, message: type[Message]) -> dict[str, WatchedField]:
    """The signals of a message that can say something is wrong, by name."""
    places = bit_places(protocol)[message]
    found: dict[str, WatchedField] = {}
    for name, field in message.FIELDS.items():
        judge = judge_of(field, _named_by_transfer(protocol.transfers, message, field))
        if judge:
            mask, shift = places[name]
            right = right_codes(field, judge)
            low, high = 1, 0  # no value passes
            if name in message.SELECTED:
                mask |= _selectors(message, name, places)
            elif right and shift is not None:
                low, high = right[0] << shift, right[-1] << shift
            found[name] = WatchedField(mask, name, judge, low, high)
    return found


def _selectors(message: type[Message], name: str, places: Mapping[str, Place]) -> int:
    """The bits of all that selects a field of a branch."""
    mask = 0
    while name in message.SELECTED:
        name, _ = message.SELECTED[name]
        mask |= places[name].mask
    return mask


def _named_by_transfer(
    transfers: Iterable[Transfer], message: type[Message], field: Field
) -> Collection[int]:
    """The codes without a label that a transfer gives a meaning."""
    for transfer in transfers:
        if transfer.length_field == (message, field.name):
            return range(1 << field.length)
        if transfer.fill is not None and (message, field.name) in transfer.items:
            return (transfer.fill,)
    return ()


def judge_of(field: Field, named: Collection[int] = ()) -> Judge | None:
    """What tells whether a value is wrong; None where no value can be.

    ``named`` are codes that have a meaning without a label.
    """
    if isinstance(field, FilledField):
        return None
    if isinstance(field, LabelledField | CharacterField):
        return _judge_of_codes(field, named)
    return _judge_of_values(field)


class _Codes(dict[Value, SignalKind | None]):
    """The known codes of a signal; others are unknown. A lookup costs less than a call."""

    def __missing__(self, value: Value) -> SignalKind | None:
        return "unknown code" if isinstance(value, int) else None


def _judge_of_codes(field: Field, named: Collection[int]) -> Judge | None:
    codes = _Codes(dict.fromkeys(named))
    is_alarm = field.labels.get(0, "").lower() in _ALL_WELL
    for raw, label in field.labels.items():
        codes[raw] = None
        if label.lower() in _INVALID_LABELS:
            codes[raw] = "invalid"
        elif is_alarm and raw != 0 and label.lower() != "reserved":
            codes[raw] = "alarm"
    codes.update({raw: _STATES[state] for raw, state in field.states.items()})
    is_always_well = len(codes) == 1 << field.length and not any(codes.values())
    return None if is_always_well else codes.__getitem__


def _judge_of_values(field: Field) -> Judge | None:
    low, high = _range(field)
    if not field.signal.is_float and field.length <= MOST_BITS:
        ends = [field.offset + field.factor * end for end in field.signal.raw_limits]
        if low <= min(ends) and max(ends) <= high:
            return _STATES.get if field.states else None

    def judge(value: Value) -> SignalKind | None:
        if isinstance(value, SignalState):
            return _STATES[value]
        outside = isinstance(value, int | float) and not low <= value <= high
        return "out of range" if outside else None

    return judge


def _range(field: Field) -> tuple[float, float]:
    """The range, with half a step of room: raw value x factor is not always what is printed."""
    if isinstance(field, NumberField):
        return field.minimum, field.maximum
    room = abs(field.factor) / 2
    return field.minimum - room, field.maximum + room
