"""Puts readings together in whichever of several readings of the spec they are sent."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import Enum
from typing import Any

from typedcan.model.transfers.kind import Problem, Rules, whole
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.recognition import (
    SLOW,
    Candidate,
    Evidence,
    agreeing,
    both,
    candidates_of,
    told_apart,
)
from typedcan.model.transfers.registry import KINDS

_MOST_HELD = 100
"""More problems are never held back while it is not known which reading is right."""


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
        self._told = ("",) * len(candidates[0].about)
        self._candidates = candidates
        self._rules = [
            KINDS[each.parts.transfer.kind].rules(each.parts, timeout) for each in candidates
        ]
        self.wanted = self._rules[0].wanted
        self._own = candidates[0].parts.messages[0].name
        self._name = candidates[0].parts.transfer.name
        self._first = candidates[0].parts.transfer
        periods = [message.period for message in candidates[0].parts.messages]
        self._period = (max(filter(None, periods), default=0)) / 1000
        self._differ = told_apart(candidates)
        self._best = 0
        self._held: list[list[Problem]] = []
        self._is_sure = False
        self._last: tuple[int, int, float] | None = None
        self._begin()

    @property
    def readings(self) -> tuple[str, ...]:
        """The ids of the readings in which the last values came, as far as frames have told."""
        return tuple(filter(None, self._told))

    @property
    def duplicates(self) -> int:
        """Frames that came again before the set was complete."""
        return self._rules[self._best].duplicates

    @property
    def deadline(self) -> float:
        """When `expire` has something to do if no frame arrives; `math.inf` for never."""
        if self._is_sure or self._is_told or not self._evidence.slow:
            return self._rules[self._best].deadline
        return self._patience

    def missing(self) -> str:
        """What still lacks for a result."""
        return self._rules[self._best].missing()

    def reset(self) -> None:
        """Forget all that was received, and in which reading."""
        for rules in self._rules:
            rules.reset()
        self._is_sure = False
        self._begin()

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
        return overdue + self._sorted_out(found, at)

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
    def _is_told(self) -> bool:
        """Whether the frames have told all that they can."""
        return self._differ <= self._evidence.facts.keys()

    @property
    def _patience(self) -> float:
        """When the most patient candidate has something to say."""
        deadlines = [each.deadline for each in self._rules if each.deadline < math.inf]
        return max(deadlines, default=math.inf)

    def _begin(self, evidence: Evidence | None = None) -> None:
        self._evidence = evidence or Evidence()
        self._last = None
        self._released()

    def _learn(self, group: Any, number: Any, at: float) -> None:
        """What a frame tells of the reading."""
        first = self._first
        group, number = whole(group), whole(number)
        if group is None or number is None:
            return
        group, number = group - first.first_group, number - first.first_number
        self._evidence.see(self._last, (group, number, at), SLOW * self._period)
        self._last = group, number, at
        self._best = next(agreeing(self._candidates, self._evidence.facts), self._best)

    def _sorted_out(self, found: list[tuple[Any, ...]], at: float) -> tuple[Any, ...]:
        """What of the outcomes of all candidates is told."""
        values = {
            place: each
            for place, outcomes in enumerate(found)
            for each in outcomes
            if not isinstance(each, Problem)
        }
        for place, outcomes in enumerate(found):
            problems = [each for each in outcomes if isinstance(each, Problem)]
            self._held[place] = (self._held[place] + problems)[:_MOST_HELD]
        facts = self._evidence.facts
        possible = tuple(agreeing(self._candidates, facts))
        if not (possible and all(place in values for place in possible)):
            return self._told_problems(found)
        self._best = right = possible[0]
        told: tuple[Any, ...] = (*self._released(), *self._changed(facts, at), values[right])
        self._is_sure = self._is_told
        if self._is_sure:
            for place, rules in enumerate(self._rules):
                if place != right:
                    rules.reset()
        return told

    def _told_problems(self, found: list[tuple[Any, ...]]) -> tuple[Problem, ...]:
        """The problems of the right candidate, once it is known, or those that all have."""
        if not (self._is_told or all(found)):
            return ()
        return self._released()

    def _released(self) -> tuple[Problem, ...]:
        """The problems of the best candidate that were held back; from now on none are."""
        held = self._held[self._best] if self._held else []
        self._held = [[] for _ in self._rules]
        return tuple(held)

    def _changed(self, facts: Mapping[str, Enum], at: float) -> tuple[Problem, ...]:
        """Note the reading of a value; a problem where others came in another reading."""
        told = self._candidates[self._best].told(facts)
        text = both(self._told, told)
        self._told = tuple(new or old for new, old in zip(told, self._told, strict=True))
        return (Problem(self._name, "reading", text, at),) if text else ()

    def _look_again(self, outcomes: tuple[Any, ...]) -> None:
        """Where something is wrong, it may be another reading."""
        if any(isinstance(each, Problem) for each in outcomes):
            self._is_sure = False
            self._begin(Evidence.of(self._candidates[self._best].parts.transfer))

    def _feed_others(self, message: str, values: tuple[Any, ...], at: float) -> None:
        """Let all know the totals."""
        for place, rules in enumerate(self._rules):
            if place != self._best:
                rules.feed(message, values, at)
