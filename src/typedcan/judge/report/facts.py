"""What several reports need to know of a judgement."""

from __future__ import annotations

from collections.abc import Sequence

from typedcan.judge.findings import Occurrence
from typedcan.judge.judgement import Judgement, RuleResult, Status, Verdict
from typedcan.judge.measure.load import Load
from typedcan.judge.report import words
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import SHARED, Tolerance
from typedcan.report.language import Language
from typedcan.shell.printing import printable

_GRAVEST = (Verdict.VIOLATES, Verdict.NOT_JUDGED, Verdict.CONFORMS)

LEAST, MOST, EXTRA = "period-short.share", "period-gap.share", "period-gap.extra"
"""The tolerances: shares of the printed period, and seconds beside the longest step."""


def overall(judgements: Sequence[Judgement]) -> Verdict:
    """The gravest verdict: one log that does not conform is enough."""
    verdicts = {judgement.verdict for judgement in judgements}
    return next((each for each in _GRAVEST if each in verdicts), Verdict.NOT_JUDGED)


def failed(judgement: Judgement, severity: Severity) -> tuple[RuleResult, ...]:
    """The results of that severity that have findings, in their order."""
    return tuple(
        result for result in judgement.results if result.count and result.severity is severity
    )


def judged_of(judgement: Judgement, rule: Rule) -> tuple[str, ...]:
    """The nodes that a rule judged in a log."""
    return tuple(node for node in judgement.nodes if node in rule.judges)


def unseen(judgement: Judgement) -> tuple[str, ...]:
    """The judged nodes that sent nothing."""
    return tuple(node for node in judgement.nodes if node not in judgement.seen)


def tolerances(judgement: Judgement) -> tuple[Tolerance, ...]:
    """Those of the rules, in their order, and those that several go by."""
    own = (each for result in judgement.results for each in result.rule.tolerances)
    return tuple(dict.fromkeys((*own, *SHARED)))


def in_force(judgement: Judgement, tolerance: Tolerance) -> float:
    """The value of a tolerance in that run."""
    return judgement.limits.get(tolerance.name, tolerance.value)


def why(judgement: Judgement, language: Language) -> str:
    """One sentence beside the verdict."""
    broken = failed(judgement, Severity.MUST)
    blamed = {
        found.subject.node for result in broken for found in result.occurrences if not found.is_open
    }
    nodes = [node for node in judgement.nodes if node in blamed]
    comma = words.COMMA.within(language)
    text = words.REASONS[judgement.verdict].within(language)
    return text.format(rules=len(broken), nodes=comma.join(nodes))


def says(found: Occurrence, language: Language) -> str:
    """What is wrong, on one line, and what that rests on where the standard leaves it open."""
    said = found.says(language)
    if found.is_open:
        open_ = words.LEFT_OPEN.within(language)
        said = words.SEMICOLON.within(language).join(
            filter(None, (said, open_, _errata(found.errata, language)))
        )
    return printable(said)


def cited(text: str, rule: Rule, language: Language) -> str:
    """A text with the place that asks for what a rule does, and how it is read, if anything."""
    place = clause(rule, language)
    return f"{text} ({place})" if place else text


def clause(rule: Rule, language: Language) -> str:
    """The place that asks for what a rule does, and the errata that the rule rests on."""
    parts = (rule.clause, _errata(rule.errata, language))
    return words.SEMICOLON.within(language).join(filter(None, parts))


def _errata(ids: Sequence[str], language: Language) -> str:
    listed = words.COMMA.within(language).join(ids)
    return words.ERRATA.within(language).format(errata=listed) if ids else ""


def found(result: RuleResult, language: Language) -> str:
    """How often something was found."""
    text = words.FOUND.within(language)
    return text.format(count=f"{result.count:,}", frames=f"{result.frames:,}")


def other_worst(result: RuleResult) -> Occurrence | None:
    """The worst occurrence, where it is another than the first."""
    worst, first = result.worst, result.first
    if worst is None or first is None:
        return None
    same = (worst.subject, worst.start, worst.order) == (first.subject, first.start, first.order)
    return None if same else worst


def reason(judgement: Judgement, result: RuleResult, language: Language) -> str:
    """Why a rule was not judged; empty where it was."""
    if result.status is not Status.NOT_JUDGED:
        return ""
    own = judged_of(judgement, result.rule)
    there = [node for node in own if node in judgement.seen]
    text = words.NOTHING_TO_JUDGE if there else words.NOT_SEEN if own else words.NOT_ASKED_FOR
    nodes = words.COMMA.within(language).join(own or result.rule.judges)
    return printable(text.within(language).format(nodes=nodes))


def by_status(judgement: Judgement, status: Status) -> str:
    """The ids of the rules with that status, in their order."""
    return ", ".join(result.rule.id for result in judgement.of_status(status))


def channel(load: Load, language: Language) -> str:
    """The name of a bus."""
    return printable(load.channel) or words.NO_CHANNEL.within(language)


def allowed_step(judgement: Judgement, period: float) -> tuple[float, float] | None:
    """The shortest and the longest step at a printed period, in seconds.

    None where the rules that limit it are not among those that judged.
    """
    limits = {
        tolerance.name: in_force(judgement, tolerance)
        for result in judgement.results
        for tolerance in result.rule.tolerances
    }
    if not {LEAST, MOST, EXTRA} <= set(limits):
        return None
    return limits[LEAST] * period, limits[MOST] * period + limits[EXTRA]
