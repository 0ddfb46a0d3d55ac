"""Raw codes of signals that are wrong, judged over all frames."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings, Said, Subject
from swapcan.conform.series import Series
from typedcan.wire.message import Field, Message


@dataclass(frozen=True, slots=True)
class Codes:
    """The codes of one field that are wrong.

    Parameters
    ----------
    runs
        Those in a row, from the first to the last: comparing is faster than looking up.
    """

    message: type[Message]
    field: Field
    runs: tuple[tuple[int, int], ...]

    @property
    def right(self) -> list[int]:
        """The codes that are not wrong."""
        codes = np.arange(1 << self.field.length)
        return [int(code) for code in codes[~self.are_wrong(codes)]]

    def are_wrong(self, raw: NDArray[Any]) -> NDArray[np.bool_]:
        """Which raw values are."""
        wrong = np.zeros(len(raw), np.bool_)
        for first, last in self.runs:
            wrong |= raw == first if first == last else (raw >= first) & (raw <= last)
        return wrong


def wrong_codes(message: type[Message], field: Field, wrong: Iterable[int]) -> Codes:
    """The codes of a field that are wrong, in any order."""
    runs: list[tuple[int, int]] = []
    for code in sorted(wrong):
        if runs and code == runs[-1][1] + 1:
            runs[-1] = runs[-1][0], code
        else:
            runs.append((code, code))
    return Codes(message, field, tuple(runs))


def judge_codes(
    findings: Findings,
    chunk: Chunk,
    every: Iterable[Codes],
    describe: Callable[[Codes, int], Said],
    measure: Callable[[Codes, NDArray[np.int64]], NDArray[np.float64]] | None = None,
) -> None:
    """Judge the fields of the frames that can be believed.

    Parameters
    ----------
    describe
        What is wrong with a code.
    measure
        How bad codes are.
    """
    for codes in every:
        series = chunk.sound(codes.message)
        if not series.fresh:
            continue
        wrong = np.zeros(len(series), np.bool_)
        wrong[series.first :] = codes.are_wrong(series.new_raw(codes.field.name))
        subject = Subject(codes.message.SENDER, codes.message.NAME, codes.field.dbc_name)
        described = partial(_describe, describe, codes, series)
        bad = None
        if measure is not None and wrong.any():
            bad = measure(codes, series.raw(codes.field.name))
        findings.rows(subject, series, wrong, described, bad)


def _describe(
    describe: Callable[[Codes, int], Said], codes: Codes, series: Series, row: int
) -> Said:
    return describe(codes, int(series.raw(codes.field.name)[row]))


def senders(every: Iterable[Codes]) -> tuple[str, ...]:
    """The nodes that send the messages of these fields."""
    return tuple(dict.fromkeys(codes.message.SENDER for codes in every))
