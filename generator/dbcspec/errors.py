"""What can go wrong, where it stands, and the exceptions that say so."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from typedcan.model.errors import Location, TypedcanError


@dataclass(frozen=True, slots=True, order=True)
class Fault:
    """One thing wrong in a file that a person wrote: where, and what to do."""

    where: Location
    text: str

    def __str__(self) -> str:
        return f"{self.where}: {self.text}"


class DbcspecError(TypedcanError):
    """Base of the errors of the toolchain alone; ``lines`` are what it says."""

    def __init__(self, *lines: str) -> None:
        self._lines = lines
        super().__init__("\n".join(lines))

    @property
    def lines(self) -> tuple[str, ...]:
        """What it says, a fault a line."""
        return self._lines


class SpecError(DbcspecError):
    """The spec cannot be read as it stands; ``faults`` has every reason, in file order."""

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = tuple(sorted(set(faults)))
        self.location = self.faults[0].where
        super().__init__(*map(str, self.faults))

    @classmethod
    def at(cls, where: Location, text: str) -> SpecError:
        """The error for a single fault."""
        return cls([Fault(where, text)])


class FindingsError(DbcspecError):
    """The spec was read, but the linter has findings that forbid going on."""

    def __init__(self, findings: Iterable[object]) -> None:
        self.findings = tuple(findings)
        super().__init__(*map(str, self.findings))


class StaleArtifactError(DbcspecError):
    """Generated files on disk are not what the spec makes: a line for each, and how it differs."""
