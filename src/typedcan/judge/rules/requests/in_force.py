"""When requests were in force, and when their answers came first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.series import Series
from typedcan.wire.message import Message
from typedcan.wire.protocol import Request


class Moment(NamedTuple):
    """A frame: seconds since the log's begin, number in the log."""

    time: float
    order: int


@dataclass(slots=True, eq=False)
class InForce:
    """A request in force, from its first frame to the one that withdraws it.

    Parameters
    ----------
    begin, end
        These frames; no end while it is in force.
    answers
        The first frame of each answer that came, sound ones only.
    """

    begin: Moment
    end: Moment | None = None
    answers: dict[type[Message], Moment] = field(default_factory=dict[type[Message], Moment])


class RequestsInForce:
    """Follows one request through a log.

    A request is an event message: it is in force from the first frame that asks to the first one
    that does not, whatever code that has.

    Parameters
    ----------
    request
        Which one.
    """

    def __init__(self, request: Request) -> None:
        self.request = request
        self.open: InForce | None = None

    def feed(self, chunk: Chunk) -> list[InForce]:
        """The requests of which something is in a chunk, in their order."""
        series = chunk.sound(self.request.field.message)
        if not series.fresh and self.open is None:
            return []
        requests = [] if self.open is None else [self.open]
        for row in self._changes(series):
            at = Moment(float(series.time[row]), int(series.order[row]))
            if self.open is None:
                self.open = InForce(at)
                requests.append(self.open)
            else:
                self.open.end = at
                self.open = None
        for in_force in requests:
            self._find_answers(in_force, chunk)
        return requests

    def _changes(self, series: Series) -> Iterator[int]:
        """The new rows with which the request begins or ends."""
        asked = series.raw(self.request.field.field)[series.first :] == self.request.code
        changed = np.diff(asked, prepend=self.open is not None)
        yield from (np.flatnonzero(changed) + series.first).tolist()

    def _find_answers(self, in_force: InForce, chunk: Chunk) -> None:
        for answer in self.request.answers:
            if answer in in_force.answers:
                continue
            series = chunk.sound(answer)
            row = first_after(series.order, max(in_force.begin.order, chunk.first_order - 1))
            if row is None or (in_force.end and series.order[row] > in_force.end.order):
                continue
            in_force.answers[answer] = Moment(float(series.time[row]), int(series.order[row]))


def first_after(order: NDArray[np.int64], after: int) -> int | None:
    """The first row with a number above another; None where there is none."""
    row = int(np.searchsorted(order, after, side="right"))
    return row if row < len(order) else None
