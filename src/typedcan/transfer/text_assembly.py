"""Texts put together from their frames, in whatever order and state they arrive."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from operator import attrgetter
from typing import Any, Generic, TypeVar

from typedcan.transfer.layout import characters, frame_number, text_slots
from typedcan.transfer.problem import Kind, Problem
from typedcan.wire.message import Message
from typedcan.wire.protocol import Transfer

ResultT = TypeVar("ResultT")

Content = tuple[Any, ...]
"""What a frame says: all that can be conflicted with."""

_SILENCE = 3
"""Timeouts without a frame after which all is forgotten."""

_ROUNDS_IN_DOUBT = 2


class TextAssembler(ABC, Generic[ResultT]):
    """What text transfers have in common; the package's docstring says what it guarantees.

    Parameters
    ----------
    transfer
        What the protocol says of it.
    timeout
        Seconds in which a set of frames must be complete.
    rounds
        How many complete sets in a row must be identical before a result is reported.
    """

    def __init__(self, transfer: Transfer, *, timeout: float, rounds: int) -> None:
        if timeout <= 0 or rounds < 1:
            raise ValueError(
                f"{transfer.name}: timeout {timeout:g} s and {rounds} rounds make none"
            )
        self.duplicates = 0
        """Frames that came again before their set was complete."""
        self._transfer = transfer
        self._timeout = timeout
        self._rounds = rounds
        self.slots = {slot.number: slot for slot in text_slots(transfer)}
        self._used = {number: attrgetter(*slot.used) for number, slot in self.slots.items()}
        self._characters = characters(transfer)
        self.reset()

    def reset(self) -> None:
        """Forget all that was received."""
        self._known: dict[int, Content] = {}  # what each frame said last, kept beyond its set
        self._collected: dict[int, float] = {}  # when each frame of the set under way came last
        self._since = math.inf
        self._last = math.inf
        self._overdue = False
        self._sets = 0  # complete sets in a row without a conflict
        self._in_doubt = False
        self._lacked = ""

    @property
    def deadline(self) -> float:
        """When `expire` has something to do if no frame arrives; `math.inf` for never."""
        return min(self._since + self._timeout, self._last + _SILENCE * self._timeout)

    def missing(self) -> str:
        """What still lacks for a result."""
        if self._collected:
            return self._lacking()
        if 0 < self._sets < self._needed:
            return f"{self._sets} of {self._needed} identical sets of frames have come"
        return self._lacked or "no frame has arrived"

    def take(self, message: Message, at: float) -> tuple[ResultT | Problem, ...]:
        """What a message brings about: a result, problems, or neither.

        Messages of other transfers bring nothing about. ``at`` is the time in seconds.
        """
        if type(message) not in self._transfer.messages:
            return ()
        outcomes: list[ResultT | Problem] = list(self.expire(at))
        number = frame_number(self._transfer, message)
        if number not in self.slots:
            text = f"frame number {number}; there are 1 to {len(self.slots)}"
            return (*outcomes, self.problem("number", text, at))
        content = self.content(message, number)
        if self._known.get(number, content) != content:
            outcomes.append(self._conflict(number, at))
        self._known[number] = content
        self._last = at
        if refusal := self._refusal(message):
            self._drop()
            return (*outcomes, self.problem("length", refusal, at))
        self._collect(number, at)
        if len(self._collected) == len(self.slots):
            outcomes.extend(self._complete(at))
        return tuple(outcomes)

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time; it is dropped, and said once until a set is complete."""
        problems: list[Problem] = []
        if now >= self._since + self._timeout:
            if not self._overdue:
                self._lacked = self._lacking()
                text = f"not complete within {self._timeout:g} s: {self._lacked}"
                problems.append(self.problem("timeout", text, now))
            recent = {n: at for n, at in self._collected.items() if now < at + self._timeout}
            self._begin(recent)
            self._overdue = bool(recent)
        if now >= self._last + _SILENCE * self._timeout:
            lacked = self._lacked
            if 0 < self._sets < self._needed:
                lacked = self.missing()
                problems.append(self.problem("timeout", lacked, now))
            self.reset()
            self._lacked = lacked
        return tuple(problems)

    @property
    def _needed(self) -> int:
        return max(self._rounds, _ROUNDS_IN_DOUBT) if self._in_doubt else self._rounds

    def _collect(self, number: int, at: float) -> None:
        if not self._collected:
            self._since = at
        elif number in self._collected:
            self.duplicates += 1
        self._collected[number] = at

    def _conflict(self, number: int, at: float) -> Problem:
        self._drop()
        self._known.clear()
        self._in_doubt = True
        text = f"frame {number} differs from before: the value changed, or two nodes send it"
        return self.problem("conflict", text, at)

    def _drop(self) -> None:
        self._begin({})
        self._sets = 0

    def _begin(self, collected: dict[int, float]) -> None:
        """Go on with a set that has these frames."""
        self._collected = collected
        self._since = min(collected.values(), default=math.inf)
        self._overdue = False

    def _complete(self, at: float) -> tuple[ResultT | Problem, ...]:
        self._begin({})
        self._lacked = ""
        self._sets += 1
        if self._sets < self._needed:
            return ()
        self._in_doubt = False
        return (self.result(self._known, at),)

    def _lacking(self) -> str:
        numbers = [str(number) for number in self.slots if number not in self._collected]
        frames = "frame" if len(numbers) == 1 else "frames"
        verb = "is" if len(numbers) == 1 else "are"
        return f"{frames} {', '.join(numbers)} of {len(self.slots)} {verb} missing"

    def problem(self, kind: Kind, text: str, at: float) -> Problem:
        """Something wrong with this transfer."""
        return Problem(self._transfer.name, kind, text, at)

    def content(self, message: Message, number: int) -> Content:
        """What a frame says."""
        used = self._used[number](message)
        return used if len(self.slots[number].used) > 1 else (used,)

    def character_problem(self, parts: Content, at: float) -> Problem | None:
        """What is wrong with the first part that is no character of the transfer, if one is."""
        for position, part in enumerate(parts, 1):
            if part not in self._characters:
                code = f"0x{part:02X}" if isinstance(part, int) else repr(part)
                text = f"character {position} is {code}, which is no digit or capital letter"
                return self.problem("character", text, at)
        return None

    def length(self, message: Message) -> int | None:
        """The length of the text where the message has it."""
        ref = self._transfer.length_field
        return int(getattr(message, ref.field)) if ref and type(message) is ref.message else None

    def _refusal(self, message: Message) -> str | None:
        """Why no set can be complete with this message."""
        length = self.length(message)
        if length == 0:
            return "length 0: the sender does not transmit the text"
        if length and length > len(self._transfer.items):
            return f"length {length}; the frames carry {len(self._transfer.items)} characters"
        return None

    @abstractmethod
    def result(self, contents: Mapping[int, Content], at: float) -> ResultT | Problem:
        """The result of a complete set of frames."""
