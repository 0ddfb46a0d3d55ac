"""What supervision knows at one moment, as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from typedcan.model.signal_state import SignalState
from typedcan.supervise.events import SignalKind, State
from typedcan.supervise.periods import PeriodStats
from typedcan.wire.fields import Value


@dataclass(frozen=True, slots=True)
class SignalSnapshot:
    """A signal that says something is wrong.

    Parameters
    ----------
    field, part
        Which signal; ``part`` as in `SignalChanged`.
    kind
        What is wrong.
    value, text
        What it holds, and the same for people.
    since
        Since when, in seconds of the clock.
    """

    field: str
    part: tuple[int, ...]
    kind: SignalKind
    value: Value
    text: str
    since: float

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it; a `SignalState` as its text, a code as its number."""
        value = self.value
        if isinstance(value, SignalState):
            value = str(value)
        elif isinstance(value, int):
            value = int(value)
        return {**asdict(self), "part": list(self.part), "value": value}


@dataclass(frozen=True, slots=True)
class MessageSnapshot:
    """A message as supervision knows it.

    Parameters
    ----------
    name, sender
        Of the message and the node that sends it.
    expected, expected_period
        Whether it has to come at all, and how often, in seconds; None where no period is known.
    state, age
        Its state, and the seconds since its last frame, None where there was none.
    frames
        How many frames were taken.
    unmeasured
        How many of them were left out of ``period`` and ``signals``: they have no usable frame
        number, or there were too many different ones.
    period
        The times between frames; where a message takes several, between those of one number.
    faults
        How many frames had a wrong length, checksum or counter.
    onsets
        How often a signal began to say that something is wrong, by what is wrong.
    signals
        The signals that say so now.
    """

    name: str
    sender: str
    expected: bool
    expected_period: float | None
    state: State
    age: float | None
    frames: int
    unmeasured: int
    period: PeriodStats
    faults: Mapping[str, int]
    onsets: Mapping[SignalKind, int]
    signals: tuple[SignalSnapshot, ...]

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it."""
        return {
            "name": self.name,
            "sender": self.sender,
            "expected": self.expected,
            "expected_period": self.expected_period,
            "state": self.state.value,
            "age": self.age,
            "frames": self.frames,
            "unmeasured": self.unmeasured,
            "period": asdict(self.period),
            "faults": dict(self.faults),
            "onsets": dict(self.onsets),
            "signals": [signal.as_dict() for signal in self.signals],
        }


@dataclass(frozen=True, slots=True)
class Snapshot:
    """All messages that a node supervises, at one moment.

    Parameters
    ----------
    node
        The node that receives them; empty where it is not one alone.
    time
        The moment, in seconds of the clock.
    messages
        Those meant for the node, those expected and those that came, in the protocol's order.
    """

    node: str
    time: float
    messages: tuple[MessageSnapshot, ...]

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it."""
        messages = [message.as_dict() for message in self.messages]
        return {"node": self.node, "time": self.time, "messages": messages}
