"""The summary of a comparison: its findings by what they mean, the gravest first."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass

from typedcan.report.item import LEVELS, Item, Report, RuleInfo
from typedcan.report.texts import grouped, shortened, told
from typedcan.shell.printing import printable

FEWEST = 6
"""Findings from which a report has a summary."""

WIDTH = 99
"""Characters of a line: the arrow may take two columns more in ASCII."""

_ONE_BY_ONE = 6
"""Findings of a rule that are shown each on a line; more come message by message."""
_MOST_LINES = 10
_LINES = 35
"""Lines in all, so that a screen of 40 has the title too."""


@dataclass(frozen=True, slots=True)
class Topic:
    """The findings of one rule, and what is to be done about them."""

    rule: RuleInfo
    level: str
    items: Sequence[Item]

    @property
    def name(self) -> str:
        """What its findings have in common."""
        return self.rule.heading or self.rule.id

    @property
    def count(self) -> int:
        """How many findings it has; each member of a sum is one."""
        return sum(len(item.members) or 1 for item in self.items)

    @property
    def is_sum(self) -> bool:
        """Whether any of its findings stands for several."""
        return any(item.members for item in self.items)

    @property
    def heading(self) -> str:
        """``scales differ (2): `` and what to do."""
        advice = f": {self.rule.advice}" if self.rule.advice else ""
        return f"{self.name} ({self.count}){advice}"


def topics(report: Report) -> list[Topic]:
    """A topic for each rule that has findings: by level, then in the order of the rules."""
    by_rule: dict[tuple[str, str], list[Item]] = {}
    for item in report.items:
        by_rule.setdefault((item.rule, item.level), []).append(item)
    rules = {rule.id: rule for rule in report.rules}
    order = {rule: index for index, rule in enumerate(rules)}
    keys = sorted(by_rule, key=lambda key: (LEVELS.index(key[1]), order.get(key[0], len(order))))
    return [
        Topic(rules.get(rule, RuleInfo(rule, "", level)), level, by_rule[rule, level])
        for rule, level in keys
    ]


def has_summary(report: Report) -> bool:
    """Whether a report is long enough to need one: of comparisons alone."""
    return len(report.items) >= FEWEST and any(rule.heading for rule in report.rules)


def summary_lines(report: Report) -> list[tuple[str, str]]:
    """The lines of a summary as level and text; what belongs to the line above has no level.

    Every topic is named. What is below it is shown as long as a screen lasts: of the first topic
    all, of the others a line each, then a second. Lesser levels, and what was summed up already,
    are named in a line for each level.
    """
    every = topics(report)
    gravest = every[0].level
    own = [topic for topic in every if topic.level == gravest and not topic.is_sum]
    also: dict[str, list[Topic]] = {}
    for topic in every:
        if topic not in own:
            also.setdefault(topic.level, []).append(topic)
    last = [(level, _together(of)) for level, of in also.items()]
    below = [_one_by_one(topic) or _run(topic) for topic in own]
    shares = _shares([len(lines) for lines in below], _LINES - len(own) - len(last))
    found: list[tuple[str, str]] = []
    for topic, lines, share in zip(own, below, shares, strict=True):
        found.append((topic.level, shortened(topic.heading, WIDTH - 10)))
        shown = lines if len(lines) <= share else _run(topic)
        found += (("", shortened(line, WIDTH - 4)) for line in shown[:share])
    return found + [(level, shortened(text, WIDTH - 10)) for level, text in last]


def _shares(wanted: Sequence[int], left: int) -> list[int]:
    """How many lines each topic gets: all that the first wants, then in turns."""
    shares = [0] * len(wanted)
    shares[:1] = [max(0, min(left, _MOST_LINES, *wanted[:1]))] if wanted else []
    left -= sum(shares)
    for line in range(_MOST_LINES):
        for index in range(1, len(wanted)):
            if left > 0 and line < wanted[index]:
                shares[index] += 1
                left -= 1
    return shares


def _together(every: Sequence[Topic]) -> str:
    return ", ".join(f"{topic.name} ({topic.count})" for topic in every)


def _one_by_one(topic: Topic) -> list[str]:
    """Each finding on a line, where they are few."""
    few = len(topic.items) <= _ONE_BY_ONE
    return [f"{printable(item.subject)}: {told(item)}" for item in topic.items] if few else []


def _run(topic: Topic) -> list[str]:
    """All findings in a run, message by message."""
    parts = []
    for group, items in grouped(topic.items).items():
        within = ", ".join(f"{printable(item.subject)}{_value(item)}" for item in items)
        parts.append(f"{printable(group)}: {within}" if _is_apart(group, items) else within)
    width = WIDTH - 4
    run = shortened("; ".join(parts), _MOST_LINES * width)
    return textwrap.wrap(run, width, break_on_hyphens=False)


def _is_apart(group: str, items: Sequence[Item]) -> bool:
    return bool(group) and [item.subject for item in items] != [group]


def _value(item: Item) -> str:
    """What became of it, short: a place, or the old value and the new one."""
    if item.old and item.new:
        return f" {printable(item.old)} → {printable(item.new)}"
    value = printable(item.old or item.new)
    return f" {value}" if value and value != item.subject else ""
