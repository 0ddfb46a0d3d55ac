"""The list of rules and promises, for people and programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict

from typedcan.model.errors import ReadError
from typedcan.report.as_markdown import escaped
from typedcan.report.item import RuleInfo
from typedcan.report.texts import dump
from typedcan.shell.printing import printable


def print_rules(rules: Sequence[RuleInfo], format: str) -> str:
    """The rules in the order given, in one of `RULE_FORMATS`; raises `ReadError` for another."""
    if format not in RULE_FORMATS:
        raise ReadError(f"rules have no format {format!r}: take one of {', '.join(RULE_FORMATS)}")
    return RULE_FORMATS[format](rules)


def _text(rules: Sequence[RuleInfo]) -> str:
    names = max((len(rule.id) for rule in rules), default=0)
    levels = max((len(rule.level) for rule in rules), default=0)
    return "".join(
        f"{rule.id:<{names}}  {rule.level:<{levels}}  {printable(rule.purpose)}\n" for rule in rules
    )


def _json(rules: Sequence[RuleInfo]) -> str:
    return dump([asdict(rule) for rule in rules])


def _markdown(rules: Sequence[RuleInfo]) -> str:
    rows = "".join(
        f"| {escaped(rule.id)} | {rule.level} | {escaped(rule.purpose)} |\n" for rule in rules
    )
    return f"| rule | level | what it promises |\n| --- | --- | --- |\n{rows}"


RULE_FORMATS: Mapping[str, Callable[[Sequence[RuleInfo]], str]] = {
    "text": _text,
    "json": _json,
    "markdown": _markdown,
}
