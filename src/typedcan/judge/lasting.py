"""What is so for longer than it may be, and the base of the rules that look for that."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import LogEnd
from typedcan.judge.findings import Findings, Occurrence, Said, Subject
from typedcan.judge.measure.last_known import fresh_for
from typedcan.judge.rule import Watcher
from typedcan.judge.series import Series
from typedcan.report.language import Text
from typedcan.wire.message import Message

_ROUNDING = 1e-6  # s, of time stamps and what is made of them


@dataclass(slots=True)
class _Run:
    """Frames in a row at which it is so; it may go on in the next chunk."""

    start: float
    order: int
    end: float
    frames: int
    measure: float
    text: Text
    values: Mapping[str, Any]


class Lasting:
    """Goes over the frames of one message, and finds what is wrong for too long.

    An occurrence begins where it becomes wrong; its values hold ``seconds``, how long it was.

    Parameters
    ----------
    findings, subject
        Where to say what was found, and of what.
    longest
        Seconds for which it may be wrong; None: not for one frame.
    gap
        Seconds without a frame after which nothing is known of the time between.
    """

    def __init__(
        self, findings: Findings, subject: Subject, longest: float | None, gap: float
    ) -> None:
        self._findings = findings
        self._subject = subject
        self._longest = longest
        self._gap = gap
        self._run: _Run | None = None

    @property
    def open(self) -> bool:
        """Whether it was wrong at the last frame."""
        return self._run is not None

    def feed(
        self,
        series: Series,
        judged: NDArray[np.bool_] | None,
        wrong: NDArray[np.bool_],
        describe: Callable[[int], Said],
        measure: NDArray[Any] | None = None,
    ) -> None:
        """Judge the new rows of a series.

        Parameters
        ----------
        judged
            The rows at which something can be judged; None: all.
        wrong
            Those of them at which it is wrong.
        describe
            What is wrong with a row; of several in a row the worst is described, or the first.
        measure
            How bad each row is; none: the longer the worse.
        """
        if not series.fresh:
            return
        first = series.first
        wrong = wrong.copy() if judged is None else wrong & judged
        count = series.fresh if judged is None else int(np.count_nonzero(judged[first:]))
        self._findings.examine(self._subject.node, count)
        wrong[:first] = self._run is not None
        if not wrong.any():
            return
        joined = np.zeros(len(series), np.bool_)
        joined[1:] = wrong[1:] & wrong[:-1] & (np.diff(series.time) <= self._gap)
        begins = np.flatnonzero(wrong & ~joined)
        ends = np.flatnonzero(wrong & ~np.append(joined[1:], False))
        for start, end in zip(begins.tolist(), ends.tolist(), strict=True):
            begin = max(start, first)
            if begin > end:
                continue  # what went on until the chunk before has ended there
            if not joined[begin]:
                self.finish()
            self._go_on(series, begin, end, describe, measure)
        if not wrong[-1]:
            self.finish()

    def finish(self) -> None:
        """End what goes on, as after the last frame of a log."""
        run, self._run = self._run, None
        if run is None or not self._is_long(run.start, run.end):
            return
        seconds = run.end - run.start
        self._findings.add(
            Occurrence(
                subject=self._subject,
                start=run.start,
                end=run.end,
                order=run.order,
                frames=run.frames,
                measure=run.measure or seconds,
                text=run.text,
                values={**run.values, "seconds": seconds},
            )
        )

    def _is_long(self, start: float, end: float) -> bool:
        return self._longest is None or end - start > self._longest + _ROUNDING

    def _go_on(
        self,
        series: Series,
        begin: int,
        end: int,
        describe: Callable[[int], Said],
        measure: NDArray[Any] | None,
    ) -> None:
        """Begin a run, or add the rows from begin to end to the one there is."""
        run = self._run
        time = float(series.time[end])
        start = float(series.time[begin]) if run is None else run.start
        if run is None and end < len(series) - 1 and not self._is_long(start, time):
            return  # is over, and was short enough
        row = begin if measure is None else begin + int(np.argmax(measure[begin : end + 1]))
        bad = 0.0 if measure is None else float(measure[row])
        if run is None:
            text, values = describe(row)
            self._run = _Run(start, int(series.order[begin]), time, 0, bad, text, values)
            run = self._run
        elif bad > run.measure:
            run.measure = bad
            run.text, run.values = describe(row)
        run.end = time
        run.frames += end - begin + 1


class LastingWatcher(Watcher):
    """Base of the rules that look for what is wrong for too long."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._all: list[Lasting] = []

    def lasting(self, subject: Subject, longest: float | None, message: type[Message]) -> Lasting:
        """What goes over the frames of a message, and is ended with the log; see `Lasting`."""
        made = Lasting(self.findings, subject, longest, fresh_for(message, self.findings))
        self._all.append(made)
        return made

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002  (what goes on ends with its last frame)
        """End what goes on."""
        for each in self._all:
            each.finish()
