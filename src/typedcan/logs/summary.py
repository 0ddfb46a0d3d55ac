"""What came of a conversion: frames, faults, gaps, damage; in lines for people and as JSON."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from typedcan.logs.checks import Faults
from typedcan.logs.columns import Counts
from typedcan.logs.read import Damage
from typedcan.model.transfers.kind import ProblemKind

_TRANSFERS: Mapping[ProblemKind, str] = {
    "conflict": "transfers with two contents",
    "timeout": "transfers not complete in time",
    "number": "transfers with a wrong number",
    "length": "transfers with a wrong length",
    "character": "transfers with a code that is no character",
    "check": "transfers with a wrong check digit",
    "totals": "transfers with other totals than readings",
    "reading": "transfers in several readings",
}
_MOST = 10
"""Unknown identifiers that are listed for people."""


@dataclass(slots=True)
class Summary:
    """What was found in one log, or in several.

    Parameters
    ----------
    logs
        How many.
    counts
        What became of the frames, as the decoder has it. Frames that were refused for their
        length or checksum are not in ``decoded``.
    faults
        What was wrong with frames of known messages.
    damage
        The logs that are damaged, and where.
    begin
        Time stamp of the first frame of the first log that has any.
    seconds
        From the first to the last frame, of all logs together.
    rows
        By name of the table.
    hidden
        Messages that no frame is, each with the one that has the same identifier.
    in_several_frames
        Messages that no single frame carries.
    renamed
        Signals whose column has another name, ``message.signal``, and that name.
    problems
        What was wrong with transfers, by their names, and how often.
    recognised
        By table, how many values of several frames came in which reading of the spec.
    taken_together
        The source addresses of messages, found by their PGN, in one column of a raster.
    spans
        Each log, with the times of its first and its last frame; NaN where there is none.
    begun
        When the logs say that they began, a line each.
    outside
        Where no frame is in the part that is wanted: from when to when the log goes.
    passed
        What in the files is no frame on the bus, and was passed over.
    """

    logs: int = 0
    counts: Counts = field(default_factory=Counts)
    faults: Faults = field(default_factory=Faults)
    damage: list[Damage] = field(default_factory=list[Damage])
    begin: float | None = None
    seconds: float = 0.0
    rows: Counter[str] = field(default_factory=Counter[str])
    hidden: dict[str, str] = field(default_factory=dict[str, str])
    in_several_frames: tuple[str, ...] = ()
    renamed: dict[str, str] = field(default_factory=dict[str, str])
    problems: dict[str, Counter[ProblemKind]] = field(
        default_factory=dict[str, Counter[ProblemKind]]
    )
    recognised: dict[str, Counter[str]] = field(default_factory=dict[str, Counter[str]])
    taken_together: dict[str, frozenset[int]] = field(default_factory=dict[str, frozenset[int]])
    spans: list[tuple[Path, float, float]] = field(default_factory=list[tuple[Path, float, float]])
    begun: list[str] = field(default_factory=list[str])
    outside: str = ""
    passed: Counter[str] = field(default_factory=Counter[str])

    def add(self, other: Summary) -> None:
        """Add what was found in the logs that follow."""
        self.logs += other.logs
        self.counts.add(other.counts)
        self.faults.add(other.faults)
        self.damage += other.damage
        self.begin = other.begin if self.begin is None else self.begin
        self.seconds += other.seconds
        self.rows.update(other.rows)
        self.hidden |= other.hidden
        self.in_several_frames = other.in_several_frames
        self.renamed |= other.renamed
        self.add_problems(other.problems)
        self.add_recognised(other.recognised)
        self.add_sources(other.taken_together)
        self.spans += other.spans
        self.begun += other.begun
        self.outside = self.outside or other.outside
        self.passed.update(other.passed)

    def add_recognised(self, found: Mapping[str, Counter[str]]) -> None:
        """Add the readings in which values came."""
        for name, used in found.items():
            self.recognised.setdefault(name, Counter()).update(used)

    def add_sources(self, found: Mapping[str, frozenset[int]]) -> None:
        """Add the sources that are in one column."""
        for name, sources in found.items():
            self.taken_together[name] = self.taken_together.get(name, sources) | sources

    def add_problems(self, found: Mapping[str, Counter[ProblemKind]]) -> None:
        """Add what was wrong with transfers."""
        for name, kinds in found.items():
            self.problems.setdefault(name, Counter()).update(kinds)

    def lines(self) -> Iterator[str]:
        """For people."""
        counts, faults = self.counts, self.faults
        decoded = counts.decoded.total()
        yield f"{counts.frames:,} frames in {self.seconds:,.1f} s, {decoded:,} decoded"
        others = {"not asked for": counts.unwanted, "remote": counts.remote, "error": counts.error}
        if any(others.values()):
            yield ", ".join(f"{many:,} {what}" for what, many in others.items() if many)
        for title, found in self._troubles():
            if found:
                yield f"{title}: {_listed(found)}"
        yield from self._remarks()
        for name, gaps in sorted(faults.gaps.items()):
            yield f"gaps: {name} {gaps.count:,}, the longest {gaps.longest:,.3g} s"
        for damage in self.damage:
            yield str(damage)

    def _remarks(self) -> Iterator[str]:
        """What is not as one might think."""
        for name, other in self.hidden.items():
            yield f"{name} has the identifier of {other}: its frames count as those of {other}"
        if self.in_several_frames:
            yield f"in several frames, not decoded: {_names(self.in_several_frames)}"
        for name, column in self.renamed.items():
            yield f"{name} is in the column {column}"
        for name, used in self.recognised.items():
            yield f"{name} read as {_listed(used)}"
        for name, sources in self._mixed().items():
            yield f"{name} is sampled from several sources: {_names(sources)}"
        yield from self.begun[:_MOST]

    def _mixed(self) -> dict[str, list[str]]:
        """The sources of what comes from several, and is in one column."""
        return {
            name: [f"0x{source:02X}" for source in sorted(sources)]
            for name, sources in self.taken_together.items()
            if len(sources) > 1
        }

    def _troubles(self) -> Iterator[tuple[str, Counter[str]]]:
        """What was wrong, and how often with each message or transfer."""
        yield "no frames on the bus", self.passed
        yield "unknown identifiers", _identifiers(self.counts)
        yield "wrong length", self.faults.length
        yield "wrong checksum", self.faults.checksum
        yield "wrong counter", self.faults.counter
        yield "in frames of another format", self.faults.format
        yield "selector without a branch", self.counts.without_branch
        for kind, title in _TRANSFERS.items():
            yield title, +Counter({name: each[kind] for name, each in self.problems.items()})

    def as_json(self) -> dict[str, Any]:
        """For programs."""
        counts, faults = self.counts, self.faults
        return {
            "logs": self.logs,
            "begin": self.begin,
            "seconds": self.seconds,
            "frames": counts.frames,
            "decoded": dict(counts.decoded),
            "unknown": dict(_identifiers(counts)),
            "unwanted": counts.unwanted,
            "remote": counts.remote,
            "error": counts.error,
            "without_branch": dict(counts.without_branch),
            "wrong_length": dict(faults.length),
            "wrong_checksum": dict(faults.checksum),
            "wrong_counter": dict(faults.counter),
            "wrong_format": dict(faults.format),
            "gaps": {
                name: {"count": gaps.count, "longest": gaps.longest}
                for name, gaps in faults.gaps.items()
            },
            "damage": [
                {
                    "path": str(damage.path),
                    "where": damage.where,
                    "problem": damage.problem,
                    "lost": damage.lost,
                }
                for damage in self.damage
            ],
            "rows": dict(self.rows),
            "hidden": self.hidden,
            "in_several_frames": list(self.in_several_frames),
            "renamed": self.renamed,
            "recognised": {name: dict(used) for name, used in self.recognised.items()},
            "several_sources": self._mixed(),
            "begun": self.begun,
            "passed_over": dict(self.passed),
            "transfers": {name: dict(kinds) for name, kinds in self.problems.items()},
        }


def _identifiers(counts: Counts) -> Counter[str]:
    return Counter(
        {
            f"0x{number:08X}" if extended else f"0x{number:03X}": frames
            for (number, extended), frames in counts.unknown.items()
        }
    )


def _listed(found: Counter[str]) -> str:
    """The most frequent, and how many there are beside."""
    return _names([f"{name} {many:,}" for name, many in found.most_common()])


def _names(names: Sequence[str]) -> str:
    """The first ones, and how many there are beside."""
    left = len(names) - _MOST
    text = ", ".join(names[:_MOST])
    return f"{text} and {left:,} more" if left > 0 else text
