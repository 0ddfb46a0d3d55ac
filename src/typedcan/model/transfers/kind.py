"""What a kind of transfer is: its parameters, what does not fit, its rules, how it is split."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, ClassVar, Literal, NamedTuple, Protocol

from typedcan.model.transfer import Counted, Transfer
from typedcan.model.transfers.parts import Part, Parts, field_of

MOST_ITEMS = 1 << 16
"""No value has more, whatever a frame says."""

_EVERY_KIND = frozenset(
    {"name", "english", "kind", "messages", "items", "period", "pace", "timeout", "table"}
)
_MOST = {"timeout": 1000, "period": 86_400_000, "rounds": 100}

ProblemKind = Literal[
    "conflict", "timeout", "number", "length", "character", "check", "totals", "reading"
]
"""What is wrong.

conflict
    A frame came with other content than before: the value changed, or two nodes send it.
timeout
    A set of frames was begun and not completed in time, or not confirmed by a second one.
number
    A frame number or group number that there cannot be.
length
    The value is not transmitted, or is longer than its frames.
character
    The text has a code that has no character.
check
    The text has no right check digit.
totals
    More readings arrive than the sender says there are, or they cannot be told apart.
reading
    Values came in another reading of the spec before: two nodes that read it differently, or one
    that changed.
"""


@dataclass(frozen=True, slots=True)
class Problem:
    """Something wrong with a transfer.

    ``transfer`` is its name in the protocol, ``text`` says in one line what is wrong, ``at`` is
    the time in seconds.
    """

    transfer: str
    kind: ProblemKind
    text: str
    at: float

    def __str__(self) -> str:
        return f"{self.transfer}: {self.text}"


class Unfit(NamedTuple):
    """What does not fit a transfer: the parameter, and what is wrong with it in words."""

    key: str
    text: str


class Frame(NamedTuple):
    """A frame of a value that was split.

    ``values`` is what the signals of its message hold, by name, and ``called`` what some of them
    are in the value, for people.
    """

    message: str
    values: dict[str, Any]
    called: Mapping[str, str] = MappingProxyType({})


class SplitError(ValueError):
    """A value that the frames of its transfer cannot carry; the text says why."""


class Rules(Protocol):
    """Puts one transfer together from the frames of one sender, in their order.

    Values are what signals hold: numbers, characters or their codes, `SignalState` where there is
    no value, None where the frame has not the signal. Times are seconds that never go back.
    """

    wanted: Mapping[str, tuple[Part, ...]]
    """By message, the signals whose values `feed` is given."""

    @property
    def duplicates(self) -> int:
        """Frames that came again before the set was complete."""
        ...

    @property
    def deadline(self) -> float:
        """When `expire` has something to do if no frame arrives; `math.inf` for never."""
        ...

    def feed(self, message: str, values: tuple[Any, ...], at: float) -> tuple[Any, ...]:
        """What a frame brings about: a value, problems, or neither."""
        ...

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time."""
        ...

    def missing(self) -> str:
        """What still lacks for a result."""
        ...

    def reset(self) -> None:
        """Forget all that was received."""
        ...


class Kind(ABC):
    """A kind of transfer."""

    name: ClassVar[str]
    """What a spec calls it."""

    purpose: ClassVar[str]
    """What it is for, in a few words."""

    value: ClassVar[type]
    """What a value of it is."""

    takes: ClassVar[frozenset[str]]
    """The parameters that mean something to it, beside those of every kind."""

    needs: ClassVar[tuple[str, ...]] = ()
    """The parameters without which it means nothing."""

    def problems(self, parts: Parts) -> Iterator[Unfit]:
        """What does not fit: unknown names, parameters of other kinds, what cannot be."""
        transfer = parts.transfer
        yield from (Unfit(key, f"there is no {name!r}") for key, name in parts.unknown)
        for key in transfer.given():
            if key not in self.takes | _EVERY_KIND:
                yield Unfit(key, f"says nothing to the kind {self.name}: leave it out")
        for key in self.needs:
            if not getattr(transfer, key):
                yield Unfit(key, f"missing, the kind {self.name} needs it")
        yield from _outsiders(parts)
        yield from _twice(parts)
        if transfer.timeout is not None and parts.period is None:
            yield Unfit("timeout", "counts periods, but no message has one: give `period` too")
        for key, most in _MOST.items():
            value = getattr(transfer, key)
            if value is not None and not 0 < value <= most:
                yield Unfit(key, f"{value} is not above 0 and at most {most}")
        if not parts.unknown:
            yield from self.own_problems(parts)

    @abstractmethod
    def own_problems(self, parts: Parts) -> Iterator[Unfit]:
        """What does not fit this kind; every name is known, but anything may be missing."""

    @abstractmethod
    def rules(self, parts: Parts, timeout: float | None = None, rounds: int | None = None) -> Rules:
        """What puts it together; ``timeout`` in seconds and ``rounds`` in place of the spec's."""

    @abstractmethod
    def split(self, parts: Parts, value: Any) -> list[Frame]:
        """The frames that carry a value; raises `SplitError`."""

    def columns(self, parts: Parts) -> Mapping[str, type]:
        """The columns of a table of values: text, bytes, or a list of numbers.

        None where values have no table of this form.
        """
        del parts
        return {}

    def cells(self, parts: Parts, value: Any) -> tuple[Any, ...]:
        """What those columns hold for a value."""
        del parts, value
        return ()


def whole(value: Any) -> int | None:
    """A number of a signal as an int; None for a state, a fraction, and what is not there."""
    if isinstance(value, int | float) and value == value // 1:
        return int(value)
    return None


def whole_numbers(parts: Parts, *keys: str) -> Iterator[Unfit]:
    """Signals that number or count, but hold something else than whole numbers from 0."""
    own = {
        "frame_number": parts.number,
        "group": parts.group,
        "groups_signal": parts.groups,
        "count_signal": parts.count,
        "length_signal": parts.length,
    }
    for key in keys:
        part = own[key]
        if part and not part.is_whole_number:
            yield Unfit(key, f"{part.signal.name} does not hold whole numbers from 0")


def one_message(parts: Parts) -> Iterator[Unfit]:
    """What is wrong where numbered frames are not those of one message."""
    if len(parts.messages) != 1:
        yield Unfit("messages", "frames that are numbered are those of one message")
    elif parts.number and parts.number.message.name not in parts.is_own:
        yield Unfit(
            "frame_number", f"{parts.number.signal.name} is not in {parts.messages[0].name}"
        )
    if parts.transfer.first_number not in (0, 1):
        yield Unfit("first_number", "frames are numbered from 0 or from 1")


def one_count(transfer: Transfer, *keys: str) -> Iterator[Unfit]:
    """What is wrong where not exactly one of some parameters tells how much there is."""
    given = [key for key in keys if getattr(transfer, key)]
    named = ", ".join(f"`{key}`" for key in keys)
    if not given:
        yield Unfit(keys[0], f"missing, one of {named} has to tell how much there is")
    elif len(given) > 1:
        yield Unfit(given[1], f"one of {named} tells how much there is, not two of them")
    for key in given:
        value = getattr(transfer, key)
        if isinstance(value, int) and not 0 < value <= MOST_ITEMS:
            yield Unfit(key, f"{value} is not from 1 to {MOST_ITEMS}")


def in_frames(parts: Parts, count: int) -> Iterator[Unfit]:
    """What is wrong where so many items, or frames, have no room in numbered frames."""
    room = parts.capacity
    if parts.transfer.counted is Counted.FRAMES:
        count, room = count * parts.width, max(room, parts.width)
    if count > room:
        yield Unfit("count", f"{count} items have no room: the frames carry {room}")


def _outsiders(parts: Parts) -> Iterable[Unfit]:
    """Signals of messages that are not the transfer's."""
    for key, found in (
        ("items", parts.items),
        ("details", parts.details),
        ("group", (parts.group,)),
        ("length_signal", (parts.length,)),
    ):
        for part in found:
            if part and part.message.name not in parts.is_own:
                yield Unfit(key, f"{part.signal.name} is in none of the transfer's messages")
    names = [field_of(part) for part in parts.details]
    for name in {name for name in names if names.count(name) > 1}:
        yield Unfit("details", f"two of them are called {name} in code")
    tellers = {part.message.name for part in (parts.count, parts.groups) if part} - parts.is_own
    if len(tellers) > 1:
        yield Unfit("groups_signal", "another message than `count_signal`: one has to tell both")


def _twice(parts: Parts) -> Iterable[Unfit]:
    """What an earlier transfer of the protocol is called already."""
    for other in parts.protocol.transfers:
        if other is parts.transfer:
            return
        if other.name == parts.transfer.name:
            yield Unfit("name", "another transfer has it too")
        elif (other.table or other.name) == (parts.transfer.table or parts.transfer.name):
            yield Unfit("table", f"tables of {other.name} are called so too")
