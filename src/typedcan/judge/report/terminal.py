"""A judgement as lines for a terminal: the verdict first, then what breaks it."""

from __future__ import annotations

import textwrap
import unicodedata
from collections.abc import Iterator, Sequence

from typedcan.judge.findings import Occurrence
from typedcan.judge.judgement import Judgement, RuleResult, Status, Verdict
from typedcan.judge.report import facts, figures, words
from typedcan.judge.rule import Severity
from typedcan.report.language import Language, Text
from typedcan.shell.printing import printable

_WIDTH = 100
"""Columns of a line."""

_RED, _YELLOW, _GREEN, _BLUE, _BOLD, _FAINT = "31", "33", "32", "36", "1", "2"
_VERDICT_COLOURS = {
    Verdict.CONFORMS: _GREEN,
    Verdict.VIOLATES: _RED,
    Verdict.NOT_JUDGED: _YELLOW,
}
_SEVERITY_COLOURS = {Severity.MUST: _RED, Severity.SHOULD: _YELLOW, Severity.INFO: _BLUE}


def summary(
    judgements: Sequence[Judgement],
    language: Language,
    *,
    colour: bool,
    verbose: bool = False,
    status: int | None = None,
) -> Iterator[str]:
    """The lines, each log's begun by its verdict; the last says what the exit status means.

    Parameters
    ----------
    colour
        Whether to use the escape sequences of terminals.
    verbose
        Also name the rules that passed and those that judged nothing, and what each asks for
        where it failed.
    status
        The exit status, 0, 1 or 2, where it is not the one of the gravest verdict: more may have
        been asked for than that.
    """
    writer = _Writer(language, colour=colour, verbose=verbose)
    for judgement in judgements:
        yield from writer.log(judgement)
        yield ""
    if status is None:
        status = words.STATUS_OF[facts.overall(judgements)]
    yield words.EXITS[status].within(language)


class _Writer:
    """Says it in one language, with colours or without."""

    def __init__(self, language: Language, *, colour: bool, verbose: bool) -> None:
        self._language: Language = language
        self._colour = colour
        self._verbose = verbose
        self._colon = self._in(words.COLON)

    def log(self, judgement: Judgement) -> Iterator[str]:
        """All about one log."""
        yield from self._head(judgement)
        for severity in (Severity.MUST, Severity.SHOULD, Severity.INFO):
            for result in facts.failed(judgement, severity):
                yield from self._result(result)
        yield from self._counts(judgement)
        for load in judgement.load:
            text = self._in(words.LOAD_LINE).format(
                channel=facts.channel(load, self._language),
                measured=figures.share(load.measured),
                expected=figures.share(load.expected),
                measured_stuffed=figures.share(load.measured_stuffed),
                expected_stuffed=figures.share(load.expected_stuffed),
            )
            yield from self._wrapped(text, "  ", "    ")

    def _head(self, judgement: Judgement) -> Iterator[str]:
        verdict = self._in(words.VERDICTS[judgement.verdict])
        painted = self._paint(verdict, _BOLD, _VERDICT_COLOURS[judgement.verdict])
        yield f"{painted}{self._colon}{printable(judgement.log)}"
        yield from self._wrapped(facts.why(judgement, self._language), "  ", "  ")
        comma = self._in(words.COMMA)
        frames = figures.count(sum(judgement.frames.values()))
        parts = (
            f"{self._in(words.LENGTH)}{self._colon}{figures.seconds(judgement.seconds)}",
            f"{self._in(words.FRAMES)}{self._colon}{frames}",
            f"{self._in(words.JUDGED)}{self._colon}{comma.join(judgement.nodes)}",
        )
        yield from self._wrapped(self._in(words.SEMICOLON).join(parts), "  ", "    ")
        if missing := facts.unseen(judgement):
            text = self._in(words.UNSEEN).format(nodes=comma.join(missing))
            yield from self._wrapped(text, "  ", "    ")
        for line in judgement.damage:
            damage = f"{self._in(words.DAMAGE)}{self._colon}{printable(line)}"
            yield from self._wrapped(damage, "  ", "    ")

    def _result(self, result: RuleResult) -> Iterator[str]:
        rule = result.rule
        severity = self._in(words.SEVERITIES[result.severity])
        painted = self._paint(severity, _BOLD, _SEVERITY_COLOURS[result.severity])
        title = printable(self._in(rule.title))
        yield f"  {painted}  {self._paint(rule.id, _BOLD)}{self._colon}{title}"
        found = printable(facts.cited(facts.found(result, self._language), rule, self._language))
        yield from self._wrapped(found, "    ", "      ")
        if self._verbose:
            yield from self._wrapped(printable(self._in(rule.purpose)), "    ", "    ")
        for label, occurrence in (
            (words.FIRST, result.first),
            (words.WORST, facts.other_worst(result)),
        ):
            if occurrence:
                yield from self._occurrence(label, occurrence)

    def _occurrence(self, label: Text, found: Occurrence) -> Iterator[str]:
        start = figures.seconds(found.start)
        subject = printable(f"{found.subject.node} {found.subject}".rstrip())
        said = facts.says(found, self._language)
        text = f"{self._in(label)} {start}  {subject}{self._colon}{said}"
        yield from self._wrapped(text, "    ", "      ")

    def _counts(self, judgement: Judgement) -> Iterator[str]:
        statuses = (Status.PASSED, Status.NOT_JUDGED)
        counts = [
            f"{self._in(words.STATUSES[status])}{self._colon}{len(judgement.of_status(status))}"
            for status in statuses
        ]
        text = f"{self._in(words.RULES)} {self._in(words.COMMA).join(counts)}"
        yield self._paint(f"  {text}", _FAINT)
        if self._verbose and (ids := facts.by_status(judgement, Status.PASSED)):
            label = self._in(words.STATUSES[Status.PASSED])
            yield from self._wrapped(f"{label}{self._colon}{ids}", "    ", "      ")
        reasons: dict[str, list[str]] = {}
        for result in judgement.of_status(Status.NOT_JUDGED):
            why = facts.reason(judgement, result, self._language)
            reasons.setdefault(why, []).append(result.rule.id)
        for why, rules in reasons.items():
            text = self._in(words.NOT_JUDGED_AS).format(count=len(rules), reason=why)
            if self._verbose:
                text += f"{self._colon}{', '.join(rules)}"
            yield from self._wrapped(text, "    ", "      ")

    def _wrapped(self, text: str, first: str, others: str) -> list[str]:
        return textwrap.wrap(
            text,
            # Chinese characters take two columns; so many of both fill a line on average.
            _WIDTH * len(text) // max(_columns(text), 1),
            initial_indent=first,
            subsequent_indent=others,
            break_on_hyphens=False,
        )

    def _in(self, text: Text) -> str:
        return text.within(self._language)

    def _paint(self, text: str, *codes: str) -> str:
        return f"\x1b[{';'.join(codes)}m{text}\x1b[0m" if self._colour else text


def _columns(text: str) -> int:
    return len(text) + sum(unicodedata.east_asian_width(each) in "WF" for each in text)
