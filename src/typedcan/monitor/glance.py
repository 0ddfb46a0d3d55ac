"""What a monitor shows of one protocol beside its messages and signals: it may be handed in."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple
from typing import Protocol as Shape

from typedcan.wire.link import Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import FieldRef


class Seen(NamedTuple):
    """A message that came, and the second at which it did."""

    received: Received[Message]
    at: float


@dataclass(frozen=True, slots=True)
class Alarm:
    """A signal that says something is wrong.

    ``text`` is the label of its code, ``age`` the seconds for which it has said so.
    """

    message: str
    signal: str
    title: str
    text: str
    age: float


@dataclass(frozen=True, slots=True)
class Noticed:
    """Something that a glance noticed; ``text`` says in one line what."""

    text: str

    def __str__(self) -> str:
        return self.text


class Known(NamedTuple):
    """What a watch knows at ``time``, in seconds of its clock.

    ``last`` has the messages that came, ``states`` the states of all by their names, ``alarms``
    those that are active.
    """

    time: float
    last: Mapping[type[Message], Seen]
    states: Mapping[str, str]
    alarms: tuple[Alarm, ...]


class Look(Shape):
    """What a glance shows at one moment; it stays as it is while the bus goes on."""

    @property
    def name(self) -> str:
        """What its pane is called."""
        ...

    def as_dict(self) -> Mapping[str, Any]:
        """The same as JSON has it, with the alarms, under names that are this protocol's own."""
        ...

    def summary(self) -> Sequence[str]:
        """What the line that sums up says of it."""
        ...

    def text(self, width: int) -> Any:
        """A `rich.text.Text` in lines of so many characters at most; nobody but the view asks."""
        ...


class Glance(Shape):
    """Gathers what is to be known first of one protocol, from all its messages.

    One thread at a time; times are seconds of one clock that never goes back.
    """

    @property
    def summed_up(self) -> Collection[FieldRef]:
        """Alarms that only sum up what others say, so that they are no alarms of their own."""
        ...

    @property
    def next_check(self) -> float:
        """When `check` has something to do if nothing comes; infinite for never."""
        ...

    def take(self, message: Message, now: float) -> tuple[Noticed, ...]:
        """Take a message that came at ``now``, and tell what it brings about."""
        ...

    def check(self, now: float) -> tuple[Noticed, ...]:
        """What time alone has changed up to now."""
        ...

    def look(self, known: Known) -> Look:
        """What there is to be seen."""
        ...
