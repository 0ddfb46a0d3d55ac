"""What a project asks of the linter: which rules, which findings are accepted, which limits."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field

from dbcspec.lint.registry import ALL_RULES
from dbcspec.lint.rule import Rule, Settings, Waiver

ALL = "ALL"
"""In ``select`` and ``ignore``: every rule."""

DEFAULT = "DEFAULT"
"""In ``select`` and ``ignore``: the rules that run unasked."""

HOUSE, FOREIGN = "house", "foreign"
"""Profiles: what a project asks of its own files, and what is wrong in anybody's."""

_GROUPS = {
    ALL: frozenset(rule.id for rule in ALL_RULES),
    DEFAULT: frozenset(rule.id for rule in ALL_RULES if rule.default),
    FOREIGN.upper(): frozenset(rule.id for rule in ALL_RULES if rule.foreign),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """The configuration of one run; ``select`` and ``ignore`` have rule ids, ALL or DEFAULT."""

    select: tuple[str, ...] = (DEFAULT,)
    ignore: tuple[str, ...] = ()
    waivers: tuple[Waiver, ...] = ()
    settings: Settings = field(default_factory=Settings)

    def under(self, profile: str) -> Options:
        """The options with the rules and the measure of a profile."""
        house = profile == HOUSE
        return dataclasses.replace(
            self,
            select=(DEFAULT,) if house else (FOREIGN.upper(),),
            settings=dataclasses.replace(self.settings, house=house),
        )

    def of_spec(self, profile: str) -> Options:
        """The options under the profile that a spec gives, where nothing else is selected."""
        return self.under(profile) if profile != HOUSE and self.select == (DEFAULT,) else self

    def rules(self) -> tuple[Rule, ...]:
        """The rules that are selected and not ignored, in the order of the registry."""
        wanted = _ids(self.select) - _ids(self.ignore)
        return tuple(rule for rule in ALL_RULES if rule.id in wanted)


def is_rule(name: str) -> bool:
    """Whether a name is the id of a rule."""
    return name in _GROUPS[ALL]


def is_rule_or_group(name: str) -> bool:
    """Whether a name may stand in ``select`` and ``ignore``."""
    return name in _GROUPS or is_rule(name)


def _ids(names: tuple[str, ...]) -> frozenset[str]:
    return frozenset[str]().union(*(_GROUPS.get(name, frozenset({name})) for name in names))
