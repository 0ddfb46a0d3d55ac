"""What a lint rule is, what it looks at, and what it finds."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from dbcspec.errors import Fault, Location
from dbcspec.model import Protocol
from dbcspec.rows import Spec


@dataclass(frozen=True, slots=True, order=True)
class Finding:
    """One place where a rule is broken. ``subject`` is the name that a waiver matches."""

    where: Location
    rule: str
    subject: str
    text: str

    def __str__(self) -> str:
        return f"{self.where}: {self.rule}: {self.text}"


@dataclass(frozen=True, slots=True)
class Waiver:
    """A finding that is accepted, with the reason. ``subject`` may have shell wildcards."""

    rule: str
    subject: str
    reason: str
    where: Location


@dataclass(frozen=True, slots=True, kw_only=True)
class Subject:
    """What is linted: the model always, the corrected rows where a spec is the source.

    ``errata_faults`` are the changes that could not be made, ``unused_waivers`` those that
    matched no finding of the other rules.
    """

    protocol: Protocol
    spec: Spec | None = None
    errata_faults: tuple[Fault, ...] = ()
    unused_waivers: tuple[Waiver, ...] = ()


Found = tuple[Location, str, str]
"""Place, subject and text of a finding."""

Check = Callable[[Subject], Iterable[Found]]


@dataclass(frozen=True, slots=True)
class Rule:
    """A rule: its stable id, what it is for, and its check."""

    id: str
    purpose: str
    check: Check

    def findings(self, subject: Subject) -> list[Finding]:
        """All findings in a subject, in order of place."""
        return sorted(
            Finding(where, self.id, name, text) for where, name, text in self.check(subject)
        )
