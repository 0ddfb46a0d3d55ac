"""What a supplier's file says otherwise than a spec, taken down to be written as errata."""

from __future__ import annotations

from dataclasses import dataclass, field

from typedcan.model.protocol import Message, Signal


@dataclass(frozen=True, slots=True)
class Step:
    """One change of an erratum: the path, and what is done there as YAML."""

    path: str
    text: str


@dataclass(slots=True)
class Deviation:
    """One thing that the file has otherwise, with its changes."""

    place: str
    printed: list[str] = field(default_factory=list[str])
    reading: list[str] = field(default_factory=list[str])
    steps: list[Step] = field(default_factory=list[Step])

    def add(self, printed: str, reading: str, *steps: Step) -> None:
        """One more fact: as the spec has it, as the file has it."""
        self.printed.append(printed)
        self.reading.append(reading)
        self.steps += steps


@dataclass(slots=True)
class Findings:
    """What all messages gave.

    ``rows`` are signals that need a row of a table, with their message as the spec has it;
    ``notes`` what a person has to settle.
    """

    deviations: list[Deviation] = field(default_factory=list[Deviation])
    rows: list[tuple[Message, tuple[Signal, ...]]] = field(
        default_factory=list[tuple[Message, tuple[Signal, ...]]]
    )
    warnings: list[str] = field(default_factory=list[str])
    notes: list[str] = field(default_factory=list[str])
