"""Values whose frames say the same each time: when a set is complete, broken, or in conflict."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Generic, TypeVar

from typedcan.model.transfer import Counted
from typedcan.model.transfers.kind import MOST_ITEMS, Problem, ProblemKind, Rules, whole
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.set_frames import Content, reader_of, slots_of, wanted_of

ValueT = TypeVar("ValueT")

Wrong = tuple[ProblemKind, str]
"""Why what came is no value."""

Make = Callable[[Sequence[Any], Mapping[str, Any], float], ValueT | Wrong]
"""Makes the value of its items, its details by field name, and the time."""

_TIMEOUT = 2.0
"""Periods in which a set has to be complete where the spec says nothing; of numbered frames so many
for each, as there may be one in a period."""

_SILENCE = 3
"""Timeouts without a frame after which all is forgotten."""

_ROUNDS_IN_DOUBT = 2


class SetRules(Rules, Generic[ValueT]):
    """What texts and numbered blocks have in common; the package says what it guarantees.

    Parameters
    ----------
    parts
        The transfer.
    make
        Makes the value.
    nouns
        What the value is, and what its items are, for people.
    timeout
        Seconds in which a set of frames must be complete; None: as the spec has it.
    rounds
        How many complete sets in a row must be identical before a value is reported; None: as the
        spec has it.
    """

    def __init__(
        self,
        parts: Parts,
        make: Make[ValueT],
        nouns: tuple[str, str],
        timeout: float | None,
        rounds: int | None,
    ) -> None:
        transfer = parts.transfer
        self._fixed_timeout = timeout
        self._timeout = parts.seconds(_TIMEOUT) if timeout is None else timeout
        self._rounds = (transfer.rounds or usual_rounds(parts)) if rounds is None else rounds
        if self._timeout <= 0 or self._rounds < 1:
            settings = f"timeout {self._timeout:g} s and {self._rounds} rounds"
            raise ValueError(f"{transfer.name}: {settings} make none")
        self._duplicates = 0
        self._parts = parts
        self._make = make
        self._noun, self._items = nouns
        self.wanted = {message.name: wanted_of(parts, message.name) for message in parts.messages}
        self._totals = parts.totals
        if self._totals and parts.count:
            self.wanted[self._totals] = (parts.count,)
        self._is_count_own = parts.count is not None and not self._totals
        self._numbers = {message.name: n for n, message in enumerate(parts.messages, 1)}
        self._count: int | None = None
        fixed = transfer.count or (0 if parts.count else len(parts.items))
        self._lay_out(fixed)
        self.reset()

    def reset(self) -> None:
        """Forget all that was received; how much there is stays."""
        self._known: dict[int, Content] = {}  # what each frame said last, kept beyond its set
        self._collected: dict[int, float] = {}  # when each frame of the set under way came last
        self._since = math.inf
        self._last = math.inf
        self._overdue = False
        self._sets = 0  # complete sets in a row without a conflict
        self._in_doubt = False
        self._lacked = ""

    @property
    def duplicates(self) -> int:
        """Frames that came again before their set was complete."""
        return self._duplicates

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
        if self._totals and not self.slots:
            return f"{self._totals} with the number of {self._items} is missing"
        return self._lacked or "no frame has arrived"

    def feed(
        self, message: str, values: tuple[Any, ...], at: float
    ) -> tuple[ValueT | Problem, ...]:
        """What a frame brings about: a value, problems, or neither."""
        if message == self._totals:
            return self._set_count(whole(values[0]))
        outcomes: list[ValueT | Problem] = []
        if at >= self._since + self._timeout or at >= self._last + _SILENCE * self._timeout:
            outcomes += self.expire(at)
        if self._is_count_own:
            outcomes += self._set_own_count(whole(values[1]), at)
        number = values[0] if self._parts.number else self._numbers[message]
        reader = self._readers.get(number)
        if reader is None:
            return (*outcomes, *self._no_slot(number, at))
        content = reader.content(values)
        if self._known.get(number, content) != content:
            text = f"frame {number} differs from before: the value changed, or two nodes send it"
            outcomes.append(self._conflict(text, at))
        self._known[number] = content
        self._last = at
        if reader.length is not None and (refusal := self._refusal(content[reader.length])):
            self._drop()
            return (*outcomes, self._problem("length", refusal, at))
        self._collect(number, at)
        if len(self._collected) == len(self.slots):
            outcomes += self._complete(at)
        return tuple(outcomes)

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time; it is dropped, and said once until a set is complete."""
        problems: list[Problem] = []
        if now >= self._since + self._timeout:
            if not self._overdue:
                self._lacked = self._lacking()
                text = f"not complete within {self._timeout:g} s: {self._lacked}"
                problems.append(self._problem("timeout", text, now))
            recent = {n: at for n, at in self._collected.items() if now < at + self._timeout}
            self._begin(recent)
            self._overdue = bool(recent)
        if now >= self._last + _SILENCE * self._timeout:
            lacked = self._lacked
            if 0 < self._sets < self._needed:
                lacked = self.missing()
                problems.append(self._problem("timeout", lacked, now))
            self.reset()
            self._lacked = lacked
        return tuple(problems)

    @property
    def _needed(self) -> int:
        return max(self._rounds, _ROUNDS_IN_DOUBT) if self._in_doubt else self._rounds

    def _lay_out(self, count: int) -> None:
        """Take over how many items, or frames, there are; 0 for not known."""
        parts = self._parts
        self.slots = {slot.number: slot for slot in slots_of(parts, count)}
        if self._fixed_timeout is None:
            frames = max(1, len(self.slots)) if parts.number else 1
            self._timeout = parts.seconds(_TIMEOUT * frames)
        self._readers = {
            number: reader_of(parts, self.wanted[slot.message], slot)
            for number, slot in self.slots.items()
        }

    def _set_count(self, count: int | None) -> tuple[()]:
        if count != self._count:
            self._count = count
            self._lay_out(self._possible(count))
            self.reset()
        return ()

    def _set_own_count(self, count: int | None, at: float) -> list[Problem]:
        """How much there is, as one of its own frames says."""
        if count == self._count and self.slots:
            return []
        before, self._count = self._count, count
        begun = bool(self._known) and before is not None
        self._drop()
        self._known.clear()
        self._lay_out(self._possible(count))
        if not self.slots:
            name = self._parts.count.signal.name if self._parts.count else ""
            return [self._problem("length", f"{name} is {count}: that cannot be", at)]
        if not begun:
            return []
        return [self._conflict(f"{count} {self._items} in place of {before}", at)]

    def _possible(self, count: int | None) -> int:
        """The number of items, or frames; 0 where it cannot be."""
        room = min(self._parts.capacity, MOST_ITEMS)
        if self._parts.transfer.counted is Counted.FRAMES:
            room = -(room // -max(1, self._parts.width))
        return count if count and 0 < count <= room else 0

    def _no_slot(self, number: Any, at: float) -> tuple[Problem, ...]:
        if not self.slots:
            return ()
        text = f"frame number {number}; there are {min(self.slots)} to {max(self.slots)}"
        return (self._problem("number", text, at),)

    def _collect(self, number: int, at: float) -> None:
        if not self._collected:
            self._since = at
        elif number in self._collected:
            self._duplicates += 1
        self._collected[number] = at

    def _conflict(self, text: str, at: float) -> Problem:
        self._drop()
        self._known.clear()
        self._in_doubt = True
        return self._problem("conflict", text, at)

    def _drop(self) -> None:
        self._begin({})
        self._sets = 0

    def _begin(self, collected: dict[int, float]) -> None:
        """Go on with a set that has these frames."""
        self._collected = collected
        self._since = min(collected.values(), default=math.inf)
        self._overdue = False

    def _complete(self, at: float) -> tuple[ValueT | Problem, ...]:
        self._begin({})
        self._lacked = ""
        self._sets += 1
        if self._sets < self._needed:
            return ()
        self._in_doubt = False
        items: list[Any] = []
        details: dict[str, Any] = {}
        length: int | None = None
        for number, reader in self._readers.items():
            content = self._known[number]
            items += content[reader.items :]
            details.update(zip(reader.details, content, strict=False))
            length = length if reader.length is None else whole(content[reader.length])
        # A character may come as such, or as its code.
        codes = [ord(item) if isinstance(item, str) else item for item in items[:length]]
        made = self._make(codes, details, at)
        if isinstance(made, tuple):
            kind, text = made
            return (self._problem(kind, text, at),)
        return (made,)

    def _refusal(self, length: Any) -> str | None:
        """Why no set can be complete with a frame that tells this length."""
        room = sum(len(slot.used) for slot in self.slots.values())
        count = whole(length)
        if not count or count < 0:
            return f"length {length}: the sender does not transmit the {self._noun}"
        if count > room:
            return f"length {length}; the frames carry {room} {self._items}"
        return None

    def _lacking(self) -> str:
        numbers = [str(number) for number in self.slots if number not in self._collected]
        frames = "frame" if len(numbers) == 1 else "frames"
        verb = "is" if len(numbers) == 1 else "are"
        return f"{frames} {', '.join(numbers)} of {len(self.slots)} {verb} missing"

    def _problem(self, kind: ProblemKind, text: str, at: float) -> Problem:
        return Problem(self._parts.transfer.name, kind, text, at)


def usual_rounds(parts: Parts) -> int:
    """One where it is sent once, on request; two where it is sent again and again."""
    return 1 if parts.period is None else 2
