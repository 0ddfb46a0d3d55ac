"""What comes out of judging one log, as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

from typedcan.judge.findings import Occurrence
from typedcan.judge.measure.load import Load
from typedcan.judge.measure.periods import Periods
from typedcan.judge.rule import Rule, Severity
from typedcan.wire.protocol import Protocol


class Verdict(Enum):
    """Whether the judged nodes keep to the standard."""

    CONFORMS = "conforms"
    VIOLATES = "does not conform"
    NOT_JUDGED = "could not be judged"


class Status(Enum):
    """What became of one rule."""

    PASSED = "passed"
    FAILED = "failed"
    NOTED = "noted"
    """Something was found for a rule that only informs."""

    NOT_JUDGED = "not judged"
    """Nothing in the log that the rule could examine."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RuleResult:
    """One rule in one log.

    Parameters
    ----------
    examined
        How many things were judged.
    count, frames
        Occurrences found, and frames in them.
    occurrences
        The first of them, by time; see `typedcan.judge.findings.KEPT`.
    worst
        The worst, whether among those or not.
    open_count
        Those of ``count`` that rest on what the standard leaves open.
    """

    rule: Rule
    examined: int
    count: int
    frames: int
    occurrences: tuple[Occurrence, ...]
    worst: Occurrence | None
    open_count: int = 0

    @property
    def severity(self) -> Severity:
        """How grave what was found is: the rule's own, but where all of it is left open."""
        is_open = self.count > 0 and self.count == self.open_count
        return min(self.rule.severity, Severity.SHOULD) if is_open else self.rule.severity

    @property
    def status(self) -> Status:
        """What became of it."""
        if self.count:
            return Status.NOTED if self.severity is Severity.INFO else Status.FAILED
        return Status.PASSED if self.examined else Status.NOT_JUDGED

    @property
    def first(self) -> Occurrence | None:
        """The earliest occurrence."""
        return self.occurrences[0] if self.occurrences else None


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgement:
    """What was found in one log.

    Parameters
    ----------
    protocol
        What the log was judged by.
    log
        Name of the log, as it was given.
    digest
        SHA-256 of the log file, empty where there is no file.
    begin, seconds
        Time stamp of the first frame, and from the first to the last.
    frames
        All frames, by name of the message; the empty name counts those of none.
    nodes
        The nodes that were judged.
    seen
        The nodes that sent at least one frame of the protocol.
    results
        One per rule, in their order.
    periods
        One per message that has a period and came.
    load
        How busy the bus was, beside what the standard asks for.
    limits
        Tolerances by name, where they were not the rules' own.
    damage
        What of the log could not be read, a line each.
    """

    protocol: Protocol
    log: str
    digest: str
    begin: float
    seconds: float
    frames: Mapping[str, int]
    nodes: tuple[str, ...]
    seen: tuple[str, ...]
    results: tuple[RuleResult, ...]
    periods: tuple[Periods, ...]
    load: tuple[Load, ...]
    limits: Mapping[str, float]
    damage: tuple[str, ...]

    @property
    def verdict(self) -> Verdict:
        """Not judged where a judged node was not seen, unless what is there is wrong already."""
        failed = any(
            result.status is Status.FAILED and result.severity is Severity.MUST
            for result in self.results
        )
        if failed:
            return Verdict.VIOLATES
        if not set(self.nodes) & set(self.seen):
            return Verdict.NOT_JUDGED
        return Verdict.CONFORMS

    def result(self, rule_id: str) -> RuleResult:
        """The result of a rule; raises `LookupError`."""
        for result in self.results:
            if result.rule.id == rule_id:
                return result
        raise LookupError(f"there is no rule {rule_id!r}")

    def of_status(self, status: Status) -> tuple[RuleResult, ...]:
        """The results of that status."""
        return tuple(result for result in self.results if result.status is status)
