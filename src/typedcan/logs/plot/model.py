"""What a plot shows, before it is drawn; all times are seconds since the log's first frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.read import Damage
from typedcan.logs.transfers import CycleCounts

GAP_PERIODS = 5
"""More than so many periods without a frame are a gap."""


_FEW = 0.005
"""Share of the values of a heat map that may lie beyond its colours, on either side."""

_FAR = 0.5
"""And how far, as a share of the range of all others."""


class Mark(StrEnum):
    """Why there is no value for a while."""

    GAP = "gap"
    INVALID = "invalid"
    ABNORMAL = "abnormal"


Spans = NDArray[np.float64]
"""Begins and ends, shape (n, 2), ascending."""


@dataclass(frozen=True, slots=True)
class Curve:
    """A signal with numbers.

    Parameters
    ----------
    name, title
        Of the database, and with the channel where there are several.
    unit
        Empty where there is none.
    factor
        The smallest step of the signal.
    time, value
        The points, ascending in time, finite.
    begins
        Whether a line begins anew at a point: it is never drawn across a mark.
    marks
        Where there is no value.
    """

    name: str
    title: str
    unit: str
    factor: float
    time: NDArray[np.float64]
    value: NDArray[np.float64]
    begins: NDArray[np.bool_]
    marks: dict[Mark, Spans]


@dataclass(frozen=True, slots=True)
class Band:
    """A signal with labels.

    Parameters
    ----------
    name, title
        Of the database, and with the channel where there are several.
    states
        Code, label and where the signal has it, ascending by code. Thinned, spans can overlap.
    marks
        Where there is no value.
    """

    name: str
    title: str
    states: tuple[tuple[int, str, Spans], ...]
    marks: dict[Mark, Spans]


@dataclass(frozen=True, slots=True)
class Heat:
    """Cells or probes: a row for each, a column for each cycle or for several; k rows, n columns.

    Parameters
    ----------
    title, unit
        What is shown.
    step
        The smallest step of a value.
    rows
        The name of each row.
    spans
        From where to where a column is, shape (n, 2); what is between them is a gap.
    low, high
        The lowest and highest value in each column, shape (n, k), NaN where there is none.
    invalid
        Whether there was a reading without a value among them, shape (n, k).
    """

    title: str
    unit: str
    step: float
    rows: tuple[str, ...]
    spans: Spans
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    invalid: NDArray[np.bool_]

    def scale(self) -> tuple[float, float]:
        """The lowest and the highest value, but of those far beyond all others the next ones.

        A single spike would leave no colours for the rest.
        """
        values = np.concatenate([self.low[~np.isnan(self.low)], self.high[~np.isnan(self.high)]])
        if not len(values):
            return 0.0, 1.0
        low, high = np.quantile(values, [_FEW, 1 - _FEW], method="nearest")
        room = _FAR * (high - low) + self.step
        near = values[(values >= low - room) & (values <= high + room)]
        return float(near.min()), float(near.max())


@dataclass(frozen=True, slots=True)
class Plot:
    """All that is drawn of one log.

    Parameters
    ----------
    title
        Name of the log.
    begin
        Time stamp of the log's first frame, seconds since 1970, or None where times are relative.
    start, end
        The part that is shown.
    curves, bands, heats
        What is drawn, in the order in which it was asked for.
    absent
        Names of signals of which there is no frame.
    cycles
        What became of the cycles of cells and probes that were asked for, by name.
    refused
        Frames with a wrong length or checksum, which are left out.
    damage
        Where the log broke.
    """

    title: str
    begin: float | None
    start: float
    end: float
    curves: tuple[Curve, ...]
    bands: tuple[Band, ...]
    heats: tuple[Heat, ...]
    absent: tuple[str, ...]
    cycles: Mapping[str, CycleCounts]
    refused: int
    damage: Damage | None

    @property
    def strips(self) -> list[list[Curve]]:
        """The curves by unit; those without a unit each alone."""
        strips: dict[str, list[Curve]] = {}
        for curve in self.curves:
            strips.setdefault(curve.unit or f"\0{curve.title}", []).append(curve)
        return list(strips.values())
