"""What `swapcan conform` can show of itself: rules, tolerances, scenarios."""

from __future__ import annotations

from swapcan.commands.conform_choice import reactions
from swapcan.conform import RULES
from swapcan.scenarios.announcement import announcement
from swapcan.scenarios.scenarios import SCENARIOS
from typedcan.report.language import Language
from typedcan.shell.console import say
from typedcan.shell.printing import aligned


def list_rules(language: Language) -> None:
    """Print a table of the rules, those of scenarios behind the others."""
    rows = [
        (
            rule.id,
            rule.severity.name.lower(),
            ", ".join(rule.judges),
            rule.clause,
            rule.title.within(language),
        )
        for rule in (*RULES, *reactions())
    ]
    for line in aligned(("rule", "severity", "nodes", "clause", "title"), rows):
        say(line)


def list_tolerances(language: Language) -> None:
    """Print a table of what rules allow."""
    rows = [
        (each.name, f"{each.value:g}", each.unit, each.text.within(language))
        for rule in (*RULES, *reactions())
        for each in rule.tolerances
    ]
    for line in aligned(("tolerance", "value", "unit", "text"), rows):
        say(line)


def list_scenarios(language: Language) -> None:
    """Print each scenario, what it sends, and by which rules the pack is judged then."""
    for scenario in SCENARIOS.values():
        for line in announcement(scenario, scenario.plays):
            say(line)
        for rule in scenario.rules:
            say(f"  {rule.severity.name}  {rule.id}: {rule.title.within(language)}")
        say("")
