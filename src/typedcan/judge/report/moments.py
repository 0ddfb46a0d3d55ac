"""What happened around what was found: a second look into a log."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.findings import Occurrence
from typedcan.judge.judgement import Judgement
from typedcan.judge.measure.channels import Channels, Formats, has_length
from typedcan.judge.report.facts import failed, other_worst
from typedcan.judge.report.sources import Source, sources_of
from typedcan.judge.report.thinned import Points
from typedcan.judge.rule import Severity
from typedcan.logs.checks import rows_where
from typedcan.logs.columns import Column, MessageColumns
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock
from typedcan.logs.plan import Mode
from typedcan.logs.protocol import known
from typedcan.logs.read import open_log
from typedcan.logs.read.blocks import rows_of
from typedcan.wire.message import Message

_LONGEST = 30.0
"""Seconds of an occurrence that are shown; what lasts longer is cut."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Track:
    """One signal, or the frames of one message, in the time of a moment.

    Parameters
    ----------
    name, unit
        Of the signal or the message; the unit is empty where there is none.
    time
        Seconds since the log's begin.
    value
        Physical values, or codes; NaN where the code says that there is none. None: only the
        times of the frames count.
    labels
        What codes mean.
    """

    name: str
    unit: str
    time: NDArray[np.float64]
    value: NDArray[np.float64] | None
    labels: Mapping[int, str] = field(default_factory=dict[int, str])


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """An occurrence and what was on the bus around it.

    Parameters
    ----------
    rule
        The id of the rule that is broken.
    occurrence
        Its first or its worst.
    begin, end
        Seconds since the log's begin.
    tracks
        What it is about.
    """

    rule: str
    occurrence: Occurrence
    begin: float
    end: float
    tracks: tuple[Track, ...]


def moments(
    path: Path | str,
    judgement: Judgement,
    *,
    most: int = 12,
    before: float = 1.0,
    after: float = 1.0,
) -> tuple[Moment, ...]:
    """Read a log again for the first and the worst occurrence of each rule that failed.

    Parameters
    ----------
    path
        The log that was judged.
    most
        How many at most; demands come before recommendations, the first before the worst.
    before, after
        Seconds that are shown beside an occurrence.

    Raises
    ------
    LogError
        The log cannot be opened.
    """
    opened = [
        _Opened(rule, found, max(found.start - before, 0.0), judgement, after)
        for rule, found in _chosen(judgement, most)
    ]
    if opened:
        _read(Path(path), judgement, opened)
    return tuple(each.closed() for each in opened)


def _chosen(judgement: Judgement, most: int) -> list[tuple[str, Occurrence]]:
    """Rules and occurrences in the order in which a report lists them."""
    found: list[tuple[int, int, int, str, Occurrence]] = []
    for group, severity in enumerate((Severity.MUST, Severity.SHOULD)):
        for place, result in enumerate(failed(judgement, severity)):
            both = (result.first, other_worst(result))
            found += [
                (group, turn, place, result.rule.id, each)
                for turn, each in enumerate(both)
                if each is not None
            ]
    kept = sorted(found, key=lambda each: each[:3])[:most]
    kept.sort(key=lambda each: (each[0], each[2], each[1]))
    return [(rule, occurrence) for *_, rule, occurrence in kept]


class _Opened:
    """A moment that is being filled."""

    def __init__(
        self, rule: str, found: Occurrence, begin: float, judgement: Judgement, after: float
    ) -> None:
        self.rule = rule
        self.found = found
        self.begin = begin
        last = min(found.end, found.start + _LONGEST)
        self.end = min(last + after, judgement.seconds)
        self.sources = sources_of(found.subject, judgement.protocol)
        self._points = [Points() for _ in self.sources]

    def feed(self, columns: MessageColumns, time: NDArray[np.float64]) -> None:
        """Take what belongs here of the frames of a message."""
        inside = (time >= self.begin) & (time <= self.end)
        if not inside.any():
            return
        for source, points in zip(self.sources, self._points, strict=True):
            if columns.name == source.message.NAME:
                rows = inside.copy()
                for name, value in source.only.items():
                    rows &= columns.columns[name].values == value
                column = columns.columns[source.signal] if source.signal else None
                points.add(time[rows], _values(column, rows))

    def closed(self) -> Moment:
        """The moment with what was found."""
        tracks = [
            Track(
                name=source.name,
                unit=source.unit,
                time=points.time,
                value=points.value if source.signal else None,
                labels=source.labels,
            )
            for source, points in zip(self.sources, self._points, strict=True)
        ]
        return Moment(
            rule=self.rule,
            occurrence=self.found,
            begin=self.begin,
            end=self.end,
            tracks=tuple(tracks),
        )


def _values(column: Column | None, rows: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Values as numbers, NaN where there is none."""
    if column is None:
        return np.zeros(int(np.count_nonzero(rows)))
    values = column.values[rows].astype(np.float64)
    if column.valid is not None:
        values[~column.valid[rows]] = np.nan
    return values


def _read(path: Path, judgement: Judgement, opened: Sequence[_Opened]) -> None:
    """Read the log once, and decode only what is shown."""
    sources = [source for each in opened for source in each.sources]
    protocol = known(judgement.protocol.model)
    decoder = Decoder(
        protocol.messages,
        mode=Mode.LABELS,
        reserved=protocol.reserved,
        wanted=_wanted(sources),
    )
    messages = {source.message.NAME: source.message for source in sources}
    channels, formats = Channels(), Formats(judgement.protocol)
    spans = _merged((each.begin, each.end) for each in opened)
    with open_log(path) as log:
        for block in log:
            time = block.timestamp - judgement.begin
            _look(channels, formats, messages.values(), block, time >= 0)
            shown = np.zeros(len(block), np.bool_)
            for begin, end in spans:
                shown |= (time >= begin) & (time <= end)
            if shown.any():
                part = rows_of(block, np.flatnonzero(shown))
                for columns in decoder.decode(part).messages.values():
                    message = messages[columns.name]
                    kept = _judged(formats, message, part, columns.rows)
                    kept &= channels.are_first(message, part, columns.rows)
                    own = rows_where(columns, kept)
                    for each in opened:
                        each.feed(own, own.timestamp - judgement.begin)
            elif (time > spans[-1][1]).all():
                break


def _look(
    channels: Channels,
    formats: Formats,
    messages: Iterable[type[Message]],
    block: FrameBlock,
    counts: NDArray[np.bool_],
) -> None:
    """Look for the channels that are not known yet; only frames that count were judged."""
    for message in messages:
        if message.NAME not in channels.first:
            named = counts & (block.frame_id == message.FRAME_ID)
            rows = np.flatnonzero(named & _judged(formats, message, block, slice(None)))
            channels.note(message, block, rows)


def _judged(
    formats: Formats,
    message: type[Message],
    block: FrameBlock,
    rows: NDArray[np.int64] | slice,
) -> NDArray[np.bool_]:
    return formats.fit(message, block, rows) & has_length(message, block, rows)


def _wanted(sources: Iterable[Source]) -> dict[str, list[str]]:
    """Messages and their signals, in no order that could change from run to run."""
    wanted: dict[str, list[str]] = {}
    for source in sources:
        signals = wanted.setdefault(source.message.NAME, [])
        signals += [name for name in source.needed if name not in signals]
    return wanted


def _merged(spans: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Spans of time, those that overlap as one, ascending."""
    merged: list[tuple[float, float]] = []
    for begin, end in sorted(spans):
        if merged and begin <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(end, merged[-1][1]))
        else:
            merged.append((begin, end))
    return merged
