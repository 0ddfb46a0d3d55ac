"""What `conform` does; apart from its arguments, since it imports what is an extra."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

from typedcan.commands.conform_bus import judged_by_hearing
from typedcan.commands.conform_choice import Choice
from typedcan.commands.conform_reports import Judged, Reports
from typedcan.commands.log_options import size_of
from typedcan.judge import Judgement, Rule, Severity, Status, Verdict, rules_for
from typedcan.judge.tolerance import SHARED
from typedcan.logs.part import window_of
from typedcan.logs.progress import Progress
from typedcan.report.language import Language
from typedcan.shell.console import CommandError, note, say
from typedcan.shell.printing import aligned
from typedcan.wire.protocol import Protocol

CONFORMS, VIOLATES, NOT_JUDGED = 0, 1, 2
"""Exit statuses."""

_STATUSES = {
    Verdict.CONFORMS: CONFORMS,
    Verdict.VIOLATES: VIOLATES,
    Verdict.NOT_JUDGED: NOT_JUDGED,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Judging:
    """What a command line hands in.

    Parameters
    ----------
    program
        Its name.
    protocol, rules
        What frames are decoded by, and what to judge by.
    more
        Further rules that options may name, such as those of scenarios.
    nodes
        Whom to judge where nobody is named; none: all.
    on_bus
        The names of further options that ask for a bus.
    judge_bus
        Records a bus and judges the record.
    """

    program: str
    protocol: Protocol
    rules: tuple[Rule, ...]
    more: tuple[Rule, ...] = ()
    nodes: tuple[str, ...] = ()
    on_bus: tuple[str, ...] = ()
    judge_bus: Callable[[argparse.Namespace, Choice, ExitStack], list[Judged]] = judged_by_hearing


def judging_of(program: str, protocol: Protocol) -> Judging:
    """Judging by the rules that a protocol gives."""
    return Judging(program=program, protocol=protocol, rules=rules_for(protocol))


def run(judging: Judging, given: argparse.Namespace) -> int:
    """List something, or judge, print the summary, write reports, and return the exit status."""
    every = (*judging.rules, *judging.more)
    if given.list_rules:
        list_rules(every, given.language)
        return CONFORMS
    if given.list_tolerances:
        list_tolerances(every, given.language)
        return CONFORMS
    on_bus = _is_on_bus(given, judging.on_bus)
    choice = Choice.of(
        given, judging.protocol, judging.rules, more=judging.more, nodes=judging.nodes
    )
    reports = Reports.of(given)
    reports.check(given.logs if not on_bus else [given.record] if given.record else [])
    with ExitStack() as stack:
        judged = judging.judge_bus(given, choice, stack) if on_bus else _judged_logs(given, choice)
        if not judged:
            return NOT_JUDGED
        status = _status(judged, choice)
        reports.write(judged, status)
    return status


def list_rules(rules: Iterable[Rule], language: Language) -> None:
    """Print a table of rules."""
    rows = [
        (
            rule.id,
            rule.severity.name.lower(),
            ", ".join(rule.judges),
            rule.clause,
            rule.title.within(language),
        )
        for rule in rules
    ]
    for line in aligned(("rule", "severity", "nodes", "clause", "title"), rows):
        say(line)


def list_tolerances(rules: Iterable[Rule], language: Language) -> None:
    """Print a table of what rules allow, and what several of them go by."""
    rows = [
        (each.name, f"{each.value:g}", each.unit, each.text.within(language))
        for each in dict.fromkeys((*(each for rule in rules for each in rule.tolerances), *SHARED))
    ]
    for line in aligned(("tolerance", "value", "unit", "text"), rows):
        say(line)


def _is_on_bus(given: argparse.Namespace, more: Sequence[str]) -> bool:
    """Whether a bus is to be judged; raises `CommandError` where that is not clear."""
    names = ("interface", "channel", "bitrate", "bus_kwargs", "duration", "record", *more)
    told = [name for name in names if getattr(given, name)]
    if given.logs:
        if told:
            option = f"--{told[0].replace('_', '-')}"
            raise CommandError(f"{option} is for a bus: judge logs, or a bus, not both")
        return False
    if not told:
        raise CommandError("what is to be judged? give logs, or a bus with -i and -c")
    if given.start or given.end:
        raise CommandError("--from and --to are for logs; --duration says how long to listen")
    return True


def _judged_logs(given: argparse.Namespace, choice: Choice) -> list[Judged]:
    sizes = [size_of(log) for log in given.logs]
    window = window_of(given.start, given.end, given.recorded_in)
    progress = Progress(sum(sizes))
    judged: list[Judged] = []
    read = frames = 0

    def watch(position: int, count: int) -> None:
        progress.update(read + position, frames + count)

    try:
        for log, size in zip(given.logs, sizes, strict=True):
            judgement = choice.judge(log, window=window, watch=watch)
            judged.append(Judged(judgement, log))
            read += size
            frames += sum(judgement.frames.values())
    finally:
        progress.clear()
    return judged


def _status(judged: Sequence[Judged], choice: Choice) -> int:
    """The exit status; what of it does not follow from the rules is said."""
    statuses = {_STATUSES[each.judgement.verdict] for each in judged}
    for each in judged:
        judgement = each.judgement
        idle = [
            result.rule.id
            for result in judgement.of_status(Status.NOT_JUDGED)
            if result.rule.id in each.expected
        ]
        if idle:
            statuses.add(NOT_JUDGED)
            note(f"{judgement.log}: nothing to judge for {', '.join(idle)}")
        if choice.strict and _is_broken(judgement, Severity.SHOULD):
            statuses.add(VIOLATES)
            note(f"{judgement.log}: --strict: a recommendation that is not heeded counts")
        if each.cut:
            statuses.add(NOT_JUDGED)
            note(f"{judgement.log}: {each.cut}")
        if judgement.damage:
            statuses.add(NOT_JUDGED)
            note(f"{judgement.log}: damaged: not all of it could be judged")
        missing = [node for node in choice.named if node not in judgement.seen]
        if missing:
            statuses.add(NOT_JUDGED)
            note(f"{judgement.log}: no frame of {', '.join(missing)}")
    return next(each for each in (VIOLATES, NOT_JUDGED, CONFORMS) if each in statuses)


def _is_broken(judgement: Judgement, severity: Severity) -> bool:
    failed = judgement.of_status(Status.FAILED)
    return any(result.severity is severity for result in failed)
