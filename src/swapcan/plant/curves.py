"""Curves of a cell and what it may be asked for, as points with straight lines between them."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence

Points = Sequence[tuple[float, float]]
"""Pairs of x and y, x rising."""

OPEN_CIRCUIT: Points = (
    (0.00, 2.750),
    (0.02, 2.950),
    (0.05, 3.100),
    (0.10, 3.200),
    (0.20, 3.240),
    (0.30, 3.270),
    (0.40, 3.285),
    (0.60, 3.300),
    (0.70, 3.325),
    (0.90, 3.335),
    (0.96, 3.350),
    (0.98, 3.380),
    (1.00, 3.480),
    (1.02, 3.700),
)
"""Volts of a resting lithium iron phosphate cell over its state of charge, 1 for full."""

DISCHARGE_BY_SOC: Points = ((0.02, 0.0), (0.20, 1.0))
"""Share of the rated discharge current that is allowed, over the state of charge."""

CHARGE_BY_SOC: Points = ((0.90, 1.0), (0.9999, 0.1), (1.0, 0.0))
"""Share of the rated charging current that is allowed, over the state of charge."""

DISCHARGE_BY_TEMPERATURE: Points = ((-25.0, 0.0), (10.0, 1.0), (45.0, 1.0), (60.0, 0.0))
"""Share of the rated discharge current that is allowed, over degrees Celsius."""

CHARGE_BY_TEMPERATURE: Points = ((0.0, 0.0), (15.0, 1.0), (45.0, 1.0), (55.0, 0.0))
"""Share of the rated charging current that is allowed, over degrees Celsius."""

RESISTANCE_BY_TEMPERATURE: Points = ((-20.0, 3.0), (0.0, 1.8), (25.0, 1.0), (60.0, 0.6))
"""Inner resistance of a cell compared with that at 25 degrees Celsius."""


def interpolate(points: Points, x: float) -> float:
    """The y at an x; that of the first or last point outside of them."""
    at = bisect_right(points, x, key=lambda point: point[0])
    if at == 0:
        return points[0][1]
    if at == len(points):
        return points[-1][1]
    (x_0, y_0), (x_1, y_1) = points[at - 1], points[at]
    return y_0 + (y_1 - y_0) * (x - x_0) / (x_1 - x_0)


class Table:
    """A curve in even steps, which is quick to look up for every cell.

    Parameters
    ----------
    points
        The curve; its x must be whole multiples of ``step`` to come out unchanged.
    step
        Between two entries of the table, in units of x.
    """

    def __init__(self, points: Points, step: float) -> None:
        first, last = points[0][0], points[-1][0]
        self._first = first
        self._per_unit = 1 / step
        count = round((last - first) / step)
        self._values = [interpolate(points, first + step * entry) for entry in range(count + 1)]

    def __call__(self, x: float) -> float:
        """The y at an x; that of the first or last point outside of them."""
        position = (x - self._first) * self._per_unit
        entry = int(position)
        if position <= 0:
            return self._values[0]
        if entry >= len(self._values) - 1:
            return self._values[-1]
        low = self._values[entry]
        return low + (self._values[entry + 1] - low) * (position - entry)
