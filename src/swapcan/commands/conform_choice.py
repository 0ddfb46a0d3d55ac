"""Whom to judge, by which rules, and with which tolerances."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import RULES, Judge, Judgement, Rule, judge_log
from swapcan.scenarios.scenarios import SCENARIOS, scenarios_of
from typedcan.logs.window import Moment
from typedcan.shell.console import CommandError

PACK = "BMU"
"""Whom scenarios judge."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """What the options say.

    Parameters
    ----------
    nodes, named
        Whom to judge, and those of them that were asked for by name.
    only, skip
        Ids of rules; no ``only`` means all.
    limits
        Tolerances by name.
    strict
        Whether a recommendation counts like a demand.
    """

    nodes: tuple[str, ...]
    named: tuple[str, ...]
    only: frozenset[str]
    skip: frozenset[str]
    limits: dict[str, float]
    strict: bool

    @classmethod
    def of(cls, given: argparse.Namespace) -> Self:
        """Read the options; raises `CommandError` for what there is not."""
        rules = (*RULES, *reactions(given.active))
        known = [rule.id for rule in rules]
        names = [tolerance.name for rule in rules for tolerance in rule.tolerances]
        limits = dict(given.tolerances)
        _check("node", given.judge, PROTOCOL.nodes)
        _check("rule", (*given.only, *given.skip), known)
        _check("tolerance", limits, names)
        named = tuple(dict.fromkeys(given.judge))
        return cls(
            nodes=named or ((PACK,) if given.active else PROTOCOL.nodes),
            named=named,
            only=frozenset(given.only),
            skip=frozenset(given.skip),
            limits=limits,
            strict=given.strict,
        )

    def check(self, more: Sequence[Rule] = ()) -> None:
        """See that there is something to judge by: before anything is read or sent.

        Raises `CommandError` where no rule is left, and as `Judge`.
        """
        Judge(self.nodes, self.rules(more), self.limits)

    def rules(self, more: Sequence[Rule] = ()) -> tuple[Rule, ...]:
        """The rules that are left; raises `CommandError` where there are none."""
        left = tuple(
            rule
            for rule in dict.fromkeys((*RULES, *more))
            if rule.id not in self.skip and (not self.only or rule.id in self.only)
        )
        if not left:
            raise CommandError("--only and --skip leave no rule to judge by")
        return left

    def judge(
        self,
        log: Path,
        more: Sequence[Rule] = (),
        *,
        start: Moment | None = None,
        end: Moment | None = None,
        watch: Callable[[int, int], None] | None = None,
    ) -> Judgement:
        """Judge a log, by more rules where there are; raises as `judge_log`."""
        rules = self.rules(more)
        return judge_log(
            log, self.nodes, rules=rules, limits=self.limits, start=start, end=end, watch=watch
        )


def reactions(names: Iterable[str] = SCENARIOS) -> tuple[Rule, ...]:
    """What those scenarios alone judge by, each rule once; raises `ScenarioError`."""
    rules = dict.fromkeys(rule for each in scenarios_of(names) for rule in each.rules)
    return tuple(rule for rule in rules if rule not in RULES)


def _check(what: str, given: Iterable[str], known: Sequence[str]) -> None:
    for name in given:
        if name not in known:
            there = ", ".join(known) if len(known) <= len(PROTOCOL.nodes) else f"see --list-{what}s"
            raise CommandError(f"there is no {what} {name!r}; {there}")
