"""The traffic that the demo has seen, as tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from typedcan.model.signal_state import SignalState
from typedcan.shell.printing import aligned
from typedcan.wire.fields import CharacterField, Field, LabelledField
from typedcan.wire.link import Received
from typedcan.wire.message import Message

_SERIES = ("csc_no", "frame_no")
"""Fields that tell the frames of one cycle apart."""


@dataclass
class _Seen:
    """What was received of one message: times are those of its first and last frame, by series."""

    last: Message
    frames: int = 0
    times: dict[tuple[object, ...], tuple[float, float, int]] = field(default_factory=dict)

    def period(self) -> float | None:
        """Mean seconds from one cycle to the next."""
        spans = [(last - first, count) for first, last, count in self.times.values() if count > 1]
        return sum(span / (count - 1) for span, count in spans) / len(spans) if spans else None


class Traffic:
    """Counts and keeps what was received; ``expected`` are the messages in their order."""

    def __init__(self, expected: Sequence[type[Message]]) -> None:
        self.expected = expected
        self.kinds: dict[type[Message], _Seen] = {}

    @property
    def frames(self) -> int:
        """How many there were."""
        return sum(seen.frames for seen in self.kinds.values())

    def add(self, received: Received[Message]) -> None:
        """Take one message into account."""
        message, time = received.message, received.frame.timestamp
        seen = self.kinds.setdefault(type(message), _Seen(message))
        seen.last = message
        seen.frames += 1
        series = tuple(getattr(message, name, None) for name in _SERIES)
        first, _, count = seen.times.get(series, (time, time, 0))
        seen.times[series] = (first, time, count + 1)

    def message_table(self) -> Iterator[str]:
        """Name, identifier, route, frames and mean period of each message."""
        headings = ("message", "identifier", "route", "frames", "period", "as received")
        return aligned(headings, [self._message_row(kind) for kind in self._in_order()])

    def signal_table(self) -> Iterator[str]:
        """Value, unit and label of each signal, as received last."""
        rows = [
            (kind.NAME, part.dbc_name, *_cells(part, getattr(self.kinds[kind].last, part.name)))
            for kind in self._in_order()
            for part in kind.FIELDS.values()
        ]
        return aligned(("message", "signal", "value", "unit", "label"), rows)

    def _in_order(self) -> list[type[Message]]:
        return [kind for kind in self.expected if kind in self.kinds]

    def _message_row(self, kind: type[Message]) -> tuple[str, ...]:
        seen = self.kinds[kind]
        mean = seen.period() if kind.PERIOD else None
        return (
            kind.NAME,
            f"0x{kind.FRAME_ID:08X}",
            f"{kind.SENDER} > {', '.join(kind.RECEIVERS)}",
            str(seen.frames),
            "on event" if kind.PERIOD is None else f"{1000 * kind.PERIOD:g} ms",
            "" if mean is None else f"{1000 * mean:.1f} ms",
        )


def _cells(part: Field, value: object) -> tuple[str, str, str]:
    """Value, unit, label."""
    if isinstance(value, SignalState):
        return ("", part.unit, str(value))
    if isinstance(part, LabelledField) and isinstance(value, int):
        return (str(int(value)), "", part.labels.get(value, ""))
    if isinstance(part, CharacterField):
        return (part.text(value) if isinstance(value, str | int) else "", "", "")
    return (f"{value:.10g}" if isinstance(value, float) else str(value), part.unit, "")
