"""What supervision reports: states of messages, and signals that say something is wrong."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Literal

from typedcan.wire.fields import Value
from typedcan.wire.message import Message

SignalKind = Literal["invalid", "abnormal", "out of range", "unknown code", "alarm"]
"""In which way a signal says that something is wrong."""


class State(Enum):
    """How regularly a message comes in."""

    NEVER_SEEN = "never seen"
    ALIVE = "alive"
    LATE = "late"
    LOST = "lost"

    def __str__(self) -> str:
        return self.value


@dataclass(frozen=True, slots=True)
class StateChanged:
    """A message went from one state to another.

    Parameters
    ----------
    message, old, new
        Which message, and its states.
    at
        When this was noticed, in seconds of the clock.
    silence
        Seconds since the frame before, infinite where there was none.
    """

    message: type[Message]
    old: State
    new: State
    at: float
    silence: float

    def __str__(self) -> str:
        change = f"{self.message.NAME}: {self.old} -> {self.new}"
        if self.old is State.NEVER_SEEN:
            return change
        return f"{change} after {self.silence:.3f} s of silence"


@dataclass(frozen=True, slots=True)
class NotSeen:
    """An expected message has not come within its timeout since supervision began."""

    message: type[Message]
    at: float

    def __str__(self) -> str:
        return f"{self.message.NAME}: not seen"


@dataclass(frozen=True, slots=True)
class SignalChanged:
    """A signal began or ceased to say that something is wrong.

    A signal that goes from one kind to another ceases with the first and begins with the second.
    An alarm that stays one with another code is reported as active again, with that code.

    Parameters
    ----------
    message, field
        Which signal.
    kind, active
        What is wrong, and whether it is so now.
    value
        What the signal holds now.
    at
        When the frame was taken, in seconds of the clock.
    part
        Which of its frames, where a message takes several: frame number, or group and frame
        number.
    """

    message: type[Message]
    field: str
    kind: SignalKind
    active: bool
    value: Value
    at: float
    part: tuple[int, ...] = ()

    def __str__(self) -> str:
        part = f"[{', '.join(map(str, self.part))}]" if self.part else ""
        text = self.message.FIELDS[self.field].text(self.value)
        state = self.kind if self.active else f"no longer {self.kind}"
        return f"{self.message.NAME}{part}.{self.field}: {state}: {text}"


SupervisionEvent = StateChanged | NotSeen | SignalChanged
