"""Puts readings together in whichever of several readings of the spec they are sent."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import Enum
from typing import Any

from typedcan.model.transfers.kind import Problem, ProblemKind, Rules, whole
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.recognition import (
    Candidate,
    Evidence,
    agreeing,
    both,
    candidates_of,
    slow_step,
    told_apart,
)
from typedcan.model.transfers.registry import KINDS

_MOST_HELD = 100
"""More problems are never held back while it is not known which reading is right."""

_RESTS_ON: Mapping[str, tuple[ProblemKind, ...]] = {
    "numbering": ("number", "totals"),
    "pace": ("timeout",),
}
"""What is a problem in one reading only."""


def rules_of(parts: Parts, timeout: float | None = None, rounds: int | None = None) -> Rules:
    """What puts a transfer together: in the reading that frames tell, where the spec has several.

    ``timeout`` in seconds and ``rounds`` in place of the spec's.
    """
    candidates = candidates_of(parts)
    if len(candidates) > 1 and parts.group and parts.number:
        return Recognising(candidates, timeout)
    return KINDS[parts.transfer.kind].rules(parts, timeout, rounds)


class Recognising(Rules):
    """Feeds all candidates until one of them is complete and is as the frames tell; then that one.

    Where something is wrong in that reading, the others are fed again. Problems in readings that
    turn out to be wrong are not told.

    Parameters
    ----------
    candidates
        The readings; the usual one first.
    timeout
        Seconds that a value may be old; None: as each reading has it.
    """

    def __init__(self, candidates: tuple[Candidate, ...], timeout: float | None) -> None:
        self._names = ("",) * len(candidates[0].about)
        self._candidates = candidates
        self._rules = [
            KINDS[each.parts.transfer.kind].rules(each.parts, timeout) for each in candidates
        ]
        self.wanted = self._rules[0].wanted
        self._own = candidates[0].parts.messages[0].name
        self._name = candidates[0].parts.transfer.name
        self._first = candidates[0].parts.transfer
        self._slow = slow_step(candidates[0].parts)
        self._differ = told_apart(candidates)
        self._best = 0
        self._held: list[Problem] = []
        self._is_sure = False
        self._last: tuple[int, int, float] | None = None
        self._evidence = Evidence(self._differ, self._slow)

    @property
    def readings(self) -> tuple[str, ...]:
        """The ids of the readings in which the last values came, as far as frames have told."""
        return tuple(filter(None, self._names))

    @property
    def duplicates(self) -> int:
        """Frames that came again before the set was complete."""
        return self._rules[self._best].duplicates

    @property
    def deadline(self) -> float:
        """When `expire` has something to do if no frame arrives; `math.inf` for never."""
        if self._is_sure or "pace" not in self._evidence.pending:
            return self._rules[self._best].deadline
        return self._patience

    def missing(self) -> str:
        """What still lacks for a result."""
        return self._rules[self._best].missing()

    def reset(self) -> None:
        """Forget all that was received, and in which reading."""
        for rules in self._rules:
            rules.reset()
        self._is_sure, self._last, self._held = False, None, []
        self._evidence = Evidence(self._differ, self._slow)

    def feed(self, message: str, values: tuple[Any, ...], at: float) -> tuple[Any, ...]:
        """What a frame brings about: a value, problems, or neither."""
        if self._is_sure:
            outcomes = self._rules[self._best].feed(message, values, at)
            if outcomes and message == self._own:
                self._look_again(outcomes)
            if message != self._own:
                self._feed_others(message, values, at)
            return outcomes
        overdue = self.expire(at)
        if message == self._own:
            self._learn(values[0], values[1], at)
        found = [rules.feed(message, values, at) for rules in self._rules]
        return overdue + self._told(found[self._best], at)

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time; said once until the next result."""
        if self._is_sure:
            problems = self._rules[self._best].expire(now)
            self._look_again(problems)
            return problems
        if now < self.deadline:
            return ()
        due = [rules.expire(now) for rules in self._rules]
        return (*self._released(), *due[self._best])

    @property
    def _patience(self) -> float:
        """When the most patient candidate has something to say."""
        deadlines = [each.deadline for each in self._rules if each.deadline < math.inf]
        return max(deadlines, default=math.inf)

    def _learn(self, group: Any, number: Any, at: float) -> None:
        """What a frame tells of the reading."""
        first = self._first
        group, number = whole(group), whole(number)
        if group is None or number is None:
            return
        group, number = group - first.first_group, number - first.first_number
        self._evidence.see(self._last, (group, number, at))
        self._last = group, number, at
        best = next(agreeing(self._candidates, self._evidence.facts), self._best)
        if best != self._best:  # what was wrong in another reading was none of this one
            self._best, self._held = best, []

    def _told(self, outcomes: tuple[Any, ...], at: float) -> tuple[Any, ...]:
        """What of the outcomes of the best candidate is told now."""
        problems = [each for each in outcomes if isinstance(each, Problem)]
        values = tuple(each for each in outcomes if not isinstance(each, Problem))
        if not values:
            unsure = {kind for key in self._evidence.pending for kind in _RESTS_ON[key]}
            if not unsure:
                return (*self._released(), *problems)
            held = [each for each in problems if each.kind in unsure]
            self._held = [*self._held, *held][:_MOST_HELD]
            return tuple(each for each in problems if each.kind not in unsure)
        facts = self._evidence.facts
        self._is_sure = self._differ <= facts.keys()
        if self._is_sure:
            for place, rules in enumerate(self._rules):
                if place != self._best:
                    rules.reset()
        return (*self._released(), *problems, *self._changed(facts, at), *values)

    def _released(self) -> tuple[Problem, ...]:
        """The problems of the best candidate that were held back; from now on none are."""
        held, self._held = self._held, []
        return tuple(held)

    def _changed(self, facts: Mapping[str, Enum], at: float) -> tuple[Problem, ...]:
        """Note the reading of a value; a problem where others came in another reading."""
        told = self._candidates[self._best].told(facts)
        text = both(self._names, told)
        self._names = tuple(new or old for new, old in zip(told, self._names, strict=True))
        return (Problem(self._name, "reading", text, at),) if text else ()

    def _look_again(self, outcomes: tuple[Any, ...]) -> None:
        """Where something is wrong, it may be another reading."""
        if any(isinstance(each, Problem) for each in outcomes):
            self._is_sure, self._last = False, None

    def _feed_others(self, message: str, values: tuple[Any, ...], at: float) -> None:
        """Let all know the totals."""
        for place, rules in enumerate(self._rules):
            if place != self._best:
                rules.feed(message, values, at)
