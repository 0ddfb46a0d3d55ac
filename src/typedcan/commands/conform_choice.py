"""Whom to judge, by which rules, and with which tolerances."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from typedcan.judge import Judge, Judgement, Rule, judge_log
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.tolerance import SHARED
from typedcan.logs.part import ALL, Window
from typedcan.model.checksums.registry import Given
from typedcan.shell.algorithms import algorithms_of
from typedcan.shell.console import CommandError
from typedcan.wire.protocol import Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class Choice:
    """What the options say.

    Parameters
    ----------
    protocol, rules
        What frames are decoded by, and all rules but those of scenarios.
    nodes, named
        Whom to judge, and those of them that were asked for by name.
    only, skip
        Ids of rules; no ``only`` means all.
    limits
        Tolerances by name.
    strict
        Whether a recommendation counts like a demand.
    algorithms
        What computes the checksums that the standard leaves open.
    """

    protocol: Protocol
    rules: tuple[Rule, ...]
    nodes: tuple[str, ...]
    named: tuple[str, ...]
    only: frozenset[str]
    skip: frozenset[str]
    limits: dict[str, float]
    strict: bool
    algorithms: Given

    @classmethod
    def of(
        cls,
        given: argparse.Namespace,
        protocol: Protocol,
        rules: tuple[Rule, ...],
        *,
        more: Sequence[Rule] = (),
        nodes: Sequence[str] = (),
    ) -> Self:
        """Read the options; raises `CommandError` for what there is not.

        Parameters
        ----------
        more
            Further rules that may be named.
        nodes
            Whom to judge where nobody is named; none: all.
        """
        every = (*rules, *more)
        limits = dict(given.tolerances)
        named = tuple(dict.fromkeys(_named(given.judge, protocol.nodes)))
        _check("rule", (*given.only, *given.skip), [rule.id for rule in every])
        own = (each for rule in every for each in rule.tolerances)
        _check("tolerance", limits, [each.name for each in (*own, *SHARED)])
        return cls(
            protocol=protocol,
            rules=rules,
            nodes=named or tuple(nodes) or nodes_of(protocol),
            named=named,
            only=frozenset(given.only),
            skip=frozenset(given.skip),
            limits=limits,
            strict=given.strict,
            algorithms=algorithms_of(given),
        )

    def check(self, more: Sequence[Rule] = ()) -> None:
        """See that there is something to judge by: before anything is read or sent.

        Raises `CommandError` where no rule is left, and as `Judge`.
        """
        self._judge(more)

    def chosen(self, more: Sequence[Rule] = ()) -> tuple[Rule, ...]:
        """The rules that are left; raises `CommandError` where there are none."""
        left = tuple(
            rule
            for rule in dict.fromkeys((*self.rules, *more))
            if rule.id not in self.skip and (not self.only or rule.id in self.only)
        )
        if not left:
            if not self.rules and not more:
                raise CommandError("the database has nothing that a log could be judged by")
            raise CommandError("--only and --skip leave no rule to judge by")
        return left

    def judge(
        self,
        log: Path,
        more: Sequence[Rule] = (),
        *,
        window: Window = ALL,
        watch: Callable[[int, int], None] | None = None,
    ) -> Judgement:
        """Judge a log, by more rules where there are; raises as `judge_log`."""
        return judge_log(self._judge(more), log, window=window, watch=watch)

    def _judge(self, more: Sequence[Rule]) -> Judge:
        return Judge(
            self.protocol,
            self.chosen(more),
            nodes=self.nodes,
            limits=self.limits,
            known=self.rules,
            algorithms=self.algorithms,
        )


def _named(given: Iterable[str], nodes: Sequence[str]) -> list[str]:
    """The nodes that were asked for, whatever the case of their letters."""
    known = {node.casefold(): node for node in nodes} | {node: node for node in nodes}
    named = [known.get(name, known.get(name.casefold(), name)) for name in given]
    _check("node", named, nodes)
    return named


_LISTED = 5
"""Names that a message lists; more are too long for a line."""


def _check(what: str, given: Iterable[str], known: Sequence[str]) -> None:
    for name in given:
        if name not in known:
            listed = what == "node" or len(known) <= _LISTED
            there = ", ".join(known) if listed else f"see --list-{what}s"
            raise CommandError(f"there is no {what} {name!r}; {there}")
