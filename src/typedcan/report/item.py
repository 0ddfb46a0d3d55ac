"""What every report format prints: one finding, whoever found it, and the rules behind it."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

from typedcan.model.errors import Location

LEVELS = ("error", "warning", "note", "wire", "source", "additive", "cosmetic")
"""From the gravest; the first three are those of lint, the others classes of a comparison."""

LINT_LEVELS = LEVELS[:3]
"""Those of lint."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Item:
    """A finding.

    ``group`` is the message it belongs to, or "" for the protocol as a whole; ``subject`` what
    is spoken of; ``breaks`` names the side that a change breaks; ``old`` and ``new`` are empty
    where there is nothing to compare; ``members`` names each of several findings that are one here.
    """

    rule: str
    level: str
    group: str
    subject: str
    text: str
    where: Location
    breaks: str = ""
    old: str = ""
    new: str = ""
    members: tuple[str, ...] = ()

    @property
    def fingerprint(self) -> str:
        """Eight hexadecimal digits that stay while rule, subject, members, old and new stay."""
        change = self.old, self.new or self.text
        parts = (self.rule, self.group, self.subject, *change, *self.members)
        return hashlib.sha256("\0".join(parts).encode("utf-8", "surrogatepass")).hexdigest()[:8]


@dataclass(frozen=True, slots=True)
class RuleInfo:
    """A rule as reports describe it.

    ``heading`` is what summaries call its findings, ``advice`` what is to be done about them.
    """

    id: str
    purpose: str
    level: str
    heading: str = ""
    advice: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """All findings of one run, in the order in which they are shown.

    ``notes`` say how it was looked at, where that is not as usual.
    """

    title: str
    items: Sequence[Item]
    rules: Sequence[RuleInfo]
    notes: Sequence[str] = ()

    def counts(self) -> dict[str, int]:
        """How many items each level has, gravest first, empty levels left out."""
        every = {level: sum(item.level == level for item in self.items) for level in LEVELS}
        return {level: count for level, count in every.items() if count}
