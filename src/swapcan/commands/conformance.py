"""What `swapcan conform` does; apart from its arguments, since it imports what is an extra."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from swapcan.commands.conform_bus import judged_on_bus
from swapcan.commands.conform_choice import Choice
from swapcan.commands.conform_lists import list_rules, list_scenarios, list_tolerances
from swapcan.commands.conform_reports import Judged, Reports
from swapcan.conform import Judgement, Severity, Status, Verdict
from typedcan.logs.progress import Progress
from typedcan.logs.window import moment
from typedcan.shell.console import CommandError, note

CONFORMS, VIOLATES, NOT_JUDGED = 0, 1, 2
"""Exit statuses."""

_STATUSES = {
    Verdict.CONFORMS: CONFORMS,
    Verdict.VIOLATES: VIOLATES,
    Verdict.NOT_JUDGED: NOT_JUDGED,
}


def run(given: argparse.Namespace) -> int:
    """List something, or judge, print the summary, write reports, and return the exit status."""
    for wanted, show in (
        (given.list_rules, list_rules),
        (given.list_tolerances, list_tolerances),
        (given.list_scenarios, list_scenarios),
    ):
        if wanted:
            show(given.language)
            return CONFORMS
    on_bus = _is_on_bus(given)
    choice = Choice.of(given)
    reports = Reports.of(given)
    reports.check(given.logs if not on_bus else [given.record] if given.record else [])
    with ExitStack() as stack:
        judged = judged_on_bus(given, choice, stack) if on_bus else _judged_logs(given, choice)
        if not judged:
            return NOT_JUDGED
        status = _status(judged, choice)
        reports.write(judged, status)
    return status


def _is_on_bus(given: argparse.Namespace) -> bool:
    """Whether a bus is to be judged; raises `CommandError` where that is not clear."""
    names = ("interface", "channel", "bitrate", "bus_kwargs")
    live = ("duration", "record", "active", "play", "yes_drive_the_bus")
    told = [name for name in (*names, *live) if getattr(given, name)]
    if given.logs:
        if told:
            option = f"--{told[0].replace('_', '-')}"
            raise CommandError(f"{option} is for a bus: judge logs, or a bus, not both")
        return False
    if not told:
        raise CommandError("what is to be judged? give logs, or a bus with -i and -c")
    if given.start or given.end:
        raise CommandError("--from and --to are for logs; --duration says how long to listen")
    if given.active and given.duration:
        raise CommandError("--duration is for listening; a scenario has its own")
    if not given.active and (given.play or given.yes_drive_the_bus):
        raise CommandError("nothing is sent without --active; see --list-scenarios")
    return True


def _judged_logs(given: argparse.Namespace, choice: Choice) -> list[Judged]:
    sizes = [_size(log) for log in given.logs]
    start = None if given.start is None else moment(given.start)
    end = None if given.end is None else moment(given.end)
    progress = Progress(sum(sizes))
    judged: list[Judged] = []
    read = frames = 0

    def watch(position: int, count: int) -> None:
        progress.update(read + position, frames + count)

    try:
        for log, size in zip(given.logs, sizes, strict=True):
            judgement = choice.judge(log, start=start, end=end, watch=watch)
            judged.append(Judged(judgement, log))
            read += size
            frames += sum(judgement.frames.values())
    finally:
        progress.clear()
    return judged


def _size(log: Path) -> int:
    try:
        return log.stat().st_size
    except OSError as error:
        raise CommandError(f"{log}: {error.strerror}") from None


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
    return any(result.rule.severity is severity for result in failed)
