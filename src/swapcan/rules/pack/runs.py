"""Rows in a row that are wrong, as one occurrence, from one chunk to the next."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.findings import Findings, Occurrence, Said, Subject

ROUNDING = 1e-6
"""What is compared are multiples of 0.001 that floats do not hold; no step is as small as this."""


class Runs:
    """Takes what a rule has judged of one subject, and reports each run of wrong rows at its end.

    Parameters
    ----------
    subject
        What all rows are about.
    least
        Shorter runs are passed over.
    """

    def __init__(self, findings: Findings, subject: Subject, least: int = 1) -> None:
        self._findings = findings
        self._subject = subject
        self._least = least
        self._open: Occurrence | None = None

    def feed(
        self,
        time: NDArray[np.float64],
        order: NDArray[np.int64],
        wrong: NDArray[np.bool_],
        describe: Callable[[int], Said],
        measure: NDArray[np.float64] | None = None,
    ) -> None:
        """Take the rows that could be judged, all of them new.

        Parameters
        ----------
        time, order
            Seconds since the log's begin, and number in the log, of the frame of each row.
        describe
            What is wrong with a row; of a run the worst row is described, or the first.
        measure
            How bad each row is.
        """
        if not len(wrong):
            return
        self._findings.examine(self._subject.node, len(wrong))
        if not wrong[0]:
            self.finish()
        if not wrong.any():
            return
        steps = np.diff(wrong.astype(np.int8), prepend=0, append=0)
        begins, ends = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)
        for begin, end in zip(begins.tolist(), ends.tolist(), strict=True):
            worst = begin if measure is None else begin + int(np.argmax(measure[begin:end]))
            text, values = describe(worst)
            found = Occurrence(
                subject=self._subject,
                start=float(time[begin]),
                end=float(time[end - 1]),
                order=int(order[begin]),
                frames=end - begin,
                measure=0.0 if measure is None else float(measure[worst]),
                text=text,
                values=values,
            )
            self._open = found if self._open is None else _joined(self._open, found)
            if end < len(wrong):
                self.finish()

    def finish(self) -> None:
        """Report the run that lasts, if there is one: it ends here."""
        if self._open is not None and self._open.frames >= self._least:
            self._findings.add(self._open)
        self._open = None


def _joined(begun: Occurrence, more: Occurrence) -> Occurrence:
    worst = more if more.measure > begun.measure else begun
    return replace(
        worst, start=begun.start, order=begun.order, end=more.end, frames=begun.frames + more.frames
    )
