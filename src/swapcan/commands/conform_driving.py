"""What `swapcan conform` does: judging logs and buses, and driving a pack through scenarios."""

from __future__ import annotations

import argparse
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path

from swapcan._generated.protocol import PROTOCOL
from swapcan.rules import RULES
from swapcan.scenarios.announcement import announcement
from swapcan.scenarios.scenario import Scenario
from swapcan.scenarios.scenarios import SCENARIOS, scenarios_of
from swapcan.scenarios.stage import LEAVING, Left, Stage
from typedcan.commands import conformance
from typedcan.commands.bus_options import open_bus
from typedcan.commands.conform_bus import (
    draw,
    folder,
    judged_by_hearing,
    noting,
    record_name,
    recorded,
)
from typedcan.commands.conform_choice import Choice
from typedcan.commands.conform_reports import Judged
from typedcan.commands.conformance import CONFORMS, Judging
from typedcan.drive.watchdog import HUNG
from typedcan.node.errors import LIVE
from typedcan.report.language import Language
from typedcan.shell.console import CommandError, note, say, warn
from typedcan.shell.process_signals import Interrupts
from typedcan.shell.progress import StatusLine
from typedcan.shell.recording import Recording

PACK = "BMU"
"""Whom scenarios judge."""

_LEFT = {
    Left.SAFE: "the pack has reported that it is off",
    Left.UNKNOWN: "the pack has not reported that it is off",
}


def run(given: argparse.Namespace) -> int:
    """Judge logs or a bus by the rules of this standard, or list something; the exit status."""
    if given.list_scenarios and not (given.list_rules or given.list_tolerances):
        _list_scenarios(given.language)
        return CONFORMS
    lists = given.list_rules or given.list_tolerances
    if not given.logs and not lists:
        _check(given)
    active = scenarios_of(SCENARIOS if lists else given.active)
    more = dict.fromkeys(rule for scenario in active for rule in scenario.rules)
    judging = Judging(
        program="swapcan",
        protocol=PROTOCOL,
        rules=RULES,
        more=tuple(rule for rule in more if rule not in RULES),
        nodes=(PACK,) if given.active else (),
        on_bus=("active", "play", "yes_drive_the_bus"),
        judge_bus=_judged_on_bus,
    )
    return conformance.run(judging, given)


def _check(given: argparse.Namespace) -> None:
    """Raise `CommandError` where options of driving do not go together."""
    if given.active and given.duration:
        raise CommandError("--duration is for listening; a scenario has its own")
    if not given.active and (given.play or given.yes_drive_the_bus):
        raise CommandError("nothing is sent without --active; see --list-scenarios")


def _list_scenarios(language: Language) -> None:
    """Print each scenario, what it sends, and by which rules the pack is judged then."""
    for scenario in SCENARIOS.values():
        for line in announcement(scenario, scenario.plays):
            say(line)
        for rule in scenario.rules:
            say(f"  {rule.severity.name}  {rule.id}: {rule.title.within(language)}")
        say("")


def _judged_on_bus(given: argparse.Namespace, choice: Choice, stack: ExitStack) -> list[Judged]:
    """Record a bus and judge the record; nothing where scenarios were announced only."""
    if not given.active:
        return judged_by_hearing(given, choice, stack)
    scenarios = [(each, each.played(given.play)) for each in scenarios_of(given.active)]
    for scenario, nodes in scenarios:
        choice.check(scenario.rules)
        for node in set(nodes) & set(choice.nodes):
            raise CommandError(f"{scenario.name} plays {node}: it cannot be judged beside that")
    for scenario, nodes in scenarios:
        for line in announcement(scenario, nodes):
            note(line)
    if not given.yes_drive_the_bus:
        note("nothing was sent; --yes-drive-the-bus sends it")
        return []
    return _driven(given, choice, scenarios, stack)


def _driven(
    given: argparse.Namespace,
    choice: Choice,
    scenarios: list[tuple[Scenario, tuple[str, ...]]],
    stack: ExitStack,
) -> list[Judged]:
    paths = [_record_of(given, scenario, len(scenarios), stack) for scenario, _ in scenarios]
    for path in paths:
        if path.exists():  # better now than after the first of them
            raise CommandError(f"{path}: is there already, choose another name")
    played = 0
    left = Left.UNTOUCHED
    with open_bus(given) as bus, Interrupts() as interrupts:
        name = record_name(given, bus)
        stage = Stage(
            bus,
            is_over=lambda: interrupts.is_over,
            warn=lambda: warn(HUNG),
            algorithms=choice.algorithms,
        )
        interrupts.at_once, interrupts.hangs = stage.send_safe_codes, lambda: stage.hangs
        for (scenario, nodes), path in zip(scenarios, paths, strict=True):
            if interrupts.is_over or left is Left.UNKNOWN:
                break
            note(f"playing {scenario.name} on {name}, Ctrl-C switches off and ends")
            with recorded(path) as recording:
                left = _play(stage, scenario, nodes, recording, given.channel)
            interrupts.stop_if_asked()  # nothing acts any more
            played += 1
    interrupts.go_on()
    judged = [
        _judged(given, choice, path, name, scenario)
        for (scenario, _), path in zip(scenarios[:played], paths, strict=False)
    ]
    cut = _LEFT[left] if left is Left.UNKNOWN else ""
    cut = "it was ended early" if interrupts.is_over else cut
    if cut and judged:
        rest = ", ".join(scenario.name for scenario, _ in scenarios[played:])
        judged[-1] = replace(judged[-1], cut=f"{cut}; not played: {rest}" if rest else cut)
    return judged


def _play(
    stage: Stage,
    scenario: Scenario,
    nodes: tuple[str, ...],
    recording: Recording,
    channel: str | None,
) -> Left:
    progress = StatusLine()
    stage.watch = partial(draw, progress, recording)
    try:
        stage.play(scenario, nodes, noting(recording, channel))
    finally:
        progress.clear()
        if stage.left is Left.UNKNOWN:
            note(f"{scenario.name}: {_LEFT[stage.left]} within {LEAVING:g} s: {LIVE}")
        elif stage.left is Left.SAFE:
            note(f"{scenario.name}: {_LEFT[stage.left]}")
    return stage.left


def _judged(
    given: argparse.Namespace,
    choice: Choice,
    path: Path,
    name: str,
    scenario: Scenario,
) -> Judged:
    judgement = choice.judge(path, scenario.rules)
    if given.record is None:
        judgement = replace(judgement, log=f"{name}: {scenario.name}")
    return Judged(judgement, path, tuple(rule.id for rule in scenario.rules))


def _record_of(given: argparse.Namespace, scenario: Scenario, count: int, stack: ExitStack) -> Path:
    record: Path | None = given.record
    if record is None:
        return folder(stack) / f"{scenario.name}.log"
    return record if count == 1 else record.with_stem(f"{record.stem}-{scenario.name}")
