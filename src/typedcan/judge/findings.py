"""What was examined and what was found for one rule in one log."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.series import Series
from typedcan.judge.tolerance import Limits
from typedcan.report.language import Language, Text

KEPT = 1000
"""Occurrences of one rule that are kept one by one; more are counted only."""


class Subject(NamedTuple):
    """What an occurrence is about.

    ``node`` is the one that is judged for it; ``message`` and ``signal`` are names of the
    standard, ``detail`` tells apart what has the same names, such as a frame number. Each may be
    empty but the node.
    """

    node: str
    message: str = ""
    signal: str = ""
    detail: str = ""

    def __str__(self) -> str:
        return " ".join(part for part in (self.signal or self.message, self.detail) if part)


class LeftOpen(NamedTuple):
    """A part of a rule that rests on what the standard leaves open.

    Parameters
    ----------
    name
        The message or the signal that it is about, or a subject as `str` has it.
    errata
        The ids of the errata that say how it is read here, where there are some.
    """

    name: str
    errata: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Occurrence:
    """Something that breaks a rule, from its first frame to its last.

    Parameters
    ----------
    subject
        What it is about.
    start, end
        Seconds since the log's begin.
    order
        Number of the first frame in the log, from 0.
    frames
        How many frames in a row are wrong.
    measure
        How bad it is, for finding the worst of a rule; larger is worse.
    text, values
        What is wrong, and what to fill in; `says` puts them together.
    is_open
        Whether it is about a part of the rule that is left open: then nothing printed is broken.
    errata
        What that part rests on.
    """

    subject: Subject
    start: float
    end: float
    order: int
    frames: int = 1
    measure: float = 0.0
    text: Text
    values: Mapping[str, Any] = field(default_factory=dict[str, Any])
    is_open: bool = False
    errata: tuple[str, ...] = ()

    def says(self, language: Language = "en") -> str:
        """What is wrong, in words."""
        filled = {
            name: value.within(language) if isinstance(value, Text) else value
            for name, value in self.values.items()
        }
        return self.text.within(language).format(**filled)


Said = tuple[Text, Mapping[str, Any]]
"""A text, and what fills it in."""


class Findings(Limits):
    """Takes what a rule examines and finds in one log.

    Parameters
    ----------
    nodes
        Those that are judged, one at least, in the protocol's order; what concerns others is
        passed over.
    limits
        Tolerances by name, where they are not to have their own value.
    left_open
        The parts of the rule that are no demand.
    """

    def __init__(
        self,
        nodes: Sequence[str],
        limits: Mapping[str, float] | None = None,
        left_open: Sequence[LeftOpen] = (),
    ) -> None:
        super().__init__(limits)
        self.nodes = frozenset(nodes)
        self._judged = tuple(nodes)
        self._errata = dict(left_open)
        self.first_node = nodes[0]
        """Whom findings are noted for that are nobody's fault."""
        self.examined: Counter[str] = Counter()
        self.count = 0
        self.open_count = 0
        """How many of them rest on what is left open."""
        self.frames = 0
        self.worst: Occurrence | None = None
        self.kept: list[Occurrence] = []
        self._open: dict[Subject, int] = {}  # place among the kept; -1: not kept

    def examine(self, node: str, count: int = 1) -> None:
        """Say that so many things of a node were judged, right or wrong.

        A negative count takes back what `rows` counted, where it could not be judged after all.
        """
        if count and node in self.nodes:
            self.examined[node] += count

    def add(self, found: Occurrence) -> None:
        """Say that something is wrong."""
        if found.subject.node in self.nodes:
            self._add(found)

    def add_frames(self, message: str, count: int) -> None:
        """Count so many occurrences of a frame each, of one message, that are not kept."""
        self.count += count
        self.frames += count
        self.open_count += count if message in self._errata else 0

    def apart(self) -> Findings:
        """Others like these, for a reading that is yet to prove the right one."""
        return Findings(self._judged, self.given, tuple(map(LeftOpen._make, self._errata.items())))

    def take(self, other: Findings) -> None:
        """Take over what was found `apart`."""
        self.examined += other.examined
        self.kept += other.kept[: KEPT - len(self.kept)]
        self.count += other.count
        self.open_count += other.open_count
        self.frames += other.frames
        if other.worst is not None:
            self.worst = other.worst if self.worst is None else _worse(self.worst, other.worst)

    def rows(
        self,
        subject: Subject,
        series: Series,
        wrong: NDArray[np.bool_],
        describe: Callable[[int], Said],
        measure: NDArray[Any] | None = None,
    ) -> None:
        """Judge the new rows of a series; those in a row that are wrong are one occurrence.

        Parameters
        ----------
        subject
            What all of them are about.
        wrong
            For each row of the series, the one before the new ones included (which is passed
            over, as it was judged before).
        describe
            What is wrong with a row; of several in a row the worst is described, or the first.
        measure
            How bad each row is.
        """
        if subject.node not in self.nodes:
            return
        first = series.first
        fresh = wrong[first:]
        self.examine(subject.node, len(fresh))
        if not fresh.any():
            if len(fresh):
                self._open.pop(subject, None)
            return
        steps = np.diff(fresh.astype(np.int8), prepend=0, append=0)
        begins, ends = np.flatnonzero(steps == 1) + first, np.flatnonzero(steps == -1) + first
        for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
            found = self._run(subject, series, begin, end, describe, measure)
            if begin == first and subject in self._open:
                self._extend(self._open[subject], found)
            else:
                self._open[subject] = self._add(found)
        if not fresh[-1]:
            self._open.pop(subject, None)

    @staticmethod
    def _run(
        subject: Subject,
        series: Series,
        begin: int,
        end: int,
        describe: Callable[[int], Said],
        measure: NDArray[Any] | None,
    ) -> Occurrence:
        worst = begin if measure is None else begin + int(np.argmax(measure[begin:end]))
        text, values = describe(worst)
        return Occurrence(
            subject=subject,
            start=float(series.time[begin]),
            end=float(series.time[end - 1]),
            order=int(series.order[begin]),
            frames=end - begin,
            measure=0.0 if measure is None else float(measure[worst]),
            text=text,
            values=values,
        )

    def _add(self, found: Occurrence) -> int:
        """Count an occurrence; where it is kept, -1 for nowhere."""
        for name in (str(found.subject), found.subject.signal, found.subject.message):
            if name in self._errata and not found.is_open:
                found = replace(found, is_open=True, errata=self._errata[name])
        self.open_count += found.is_open
        self.count += 1
        self.frames += found.frames
        self.worst = found if self.worst is None else _worse(self.worst, found)
        if len(self.kept) >= KEPT:
            return -1
        self.kept.append(found)
        return len(self.kept) - 1

    def _extend(self, place: int, found: Occurrence) -> None:
        """Let an occurrence go on."""
        self.frames += found.frames
        if place < 0:
            return
        begun = self.kept[place]
        worse = found.measure > begun.measure
        joined = replace(
            begun,
            end=found.end,
            frames=begun.frames + found.frames,
            measure=found.measure if worse else begun.measure,
            text=found.text if worse else begun.text,
            values=found.values if worse else begun.values,
        )
        self.kept[place] = joined
        self.worst = joined if self.worst in (None, begun) else _worse(self.worst, joined)


def _worse(one: Occurrence, other: Occurrence) -> Occurrence:
    """The worse of two; of two alike the earlier, wherever a log is cut."""
    return max(one, other, key=lambda found: (found.measure, -found.order))
