"""The voltage of every cell as far as it is known, from single frames and from complete sets."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from swapcan.transfer import CellVoltages, Reading
from typedcan.model.signal_state import SignalState

_FRESH = 1.0
"""Seconds for which a voltage counts as received: ten periods."""

_PER_FRAME = 3


class Cell(NamedTuple):
    """One cell: its CSC and its number there, both from 1, and its voltage in V."""

    csc: int
    number: int
    volts: float


@dataclass(frozen=True, slots=True)
class CellMap:
    """The cells at one moment.

    Parameters
    ----------
    groups
        By CSC, the reading of each cell in order; None where none has come yet.
    received
        How many of them came in the last second.
    total
        How many there are, None where nobody has told yet.
    age
        Seconds since the last frame, None where there was none.
    """

    groups: Mapping[int, tuple[Reading | None, ...]]
    received: int
    total: int | None
    age: float | None

    @property
    def is_complete(self) -> bool:
        """Whether all cells came in the last second."""
        return self.received == self.total

    @property
    def lowest(self) -> Cell | None:
        """The cell with the lowest voltage."""
        return min(self._measured(), key=lambda cell: cell.volts, default=None)

    @property
    def highest(self) -> Cell | None:
        """The cell with the highest voltage."""
        return max(self._measured(), key=lambda cell: cell.volts, default=None)

    def _measured(self) -> Iterator[Cell]:
        for csc, readings in self.groups.items():
            for number, reading in enumerate(readings, 1):
                if isinstance(reading, int | float):
                    yield Cell(csc, number, reading)

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it: in V; a state as its text, null where nothing has come."""
        return {
            "received": self.received,
            "total": self.total,
            "age": self.age,
            "volts": {
                str(csc): [_plain(reading) for reading in readings]
                for csc, readings in self.groups.items()
            },
        }


def _plain(reading: Reading | None) -> float | str | None:
    if isinstance(reading, SignalState):
        return str(reading)
    return None if reading is None else round(reading, 6)


class _Piece(NamedTuple):
    readings: tuple[Reading, ...]
    at: float


class Cells:
    """Keeps what each frame said last. A complete set tells how many cells each CSC has."""

    def __init__(self) -> None:
        self._pieces: dict[tuple[int, int], _Piece] = {}
        self._counts: Mapping[int, int] | None = None
        self._told: int | None = None

    def take(self, message: Any, at: float) -> None:
        """Take a B2V_Ucell, of whatever class, that came at ``at`` seconds."""
        if isinstance(message.csc_no, int) and message.csc_no > 0 and message.frame_no > 0:
            readings = (message.csc_no_ucell_n, message.csc_no_ucell_n1, message.csc_no_ucell_n2)
            self._pieces[message.csc_no, message.frame_no] = _Piece(readings, at)

    def take_totals(self, message: Any) -> None:
        """Take how many cells there are by a B2V_BattInfo2; another number means another pack."""
        if message.tot_cell_num != self._told:
            self._counts = None
            self._pieces.clear()
        self._told = message.tot_cell_num

    def take_set(self, cells: CellVoltages) -> None:
        """Take how many cells each CSC has."""
        self._counts = {csc: len(group) for csc, group in cells.items()}

    def map(self, now: float) -> CellMap:
        """What is known at ``now``."""
        known = {csc: self._readings(csc, count) for csc, count in sorted(self._numbers().items())}
        ages = [now - piece.at for piece in self._pieces.values()]
        return CellMap(
            groups={
                csc: tuple(reading for reading, _ in readings) for csc, readings in known.items()
            },
            received=sum(now - at <= _FRESH for group in known.values() for _, at in group),
            total=self._told or None,
            age=min(ages, default=None),
        )

    def _numbers(self) -> Mapping[int, int]:
        """How many cells each CSC has; before a complete set came, up to the last with a value."""
        if self._counts is not None:
            return self._counts
        numbers: dict[int, int] = {}
        for (csc, frame), piece in self._pieces.items():
            for position, reading in enumerate(piece.readings, 1):
                number = (frame - 1) * _PER_FRAME + position
                if reading is not SignalState.INVALID and number > numbers.get(csc, 0):
                    numbers[csc] = number
        return numbers

    def _readings(self, csc: int, count: int) -> list[tuple[Reading | None, float]]:
        readings: list[tuple[Reading | None, float]] = []
        for index in range(count):
            frame, position = divmod(index, _PER_FRAME)
            piece = self._pieces.get((csc, frame + 1))
            readings.append((piece.readings[position], piece.at) if piece else (None, -math.inf))
        return readings
