"""Raw codes of signals that are wrong, judged over all frames."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.series import Series
from typedcan.wire.fields import Field, FloatField
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

Span = tuple[int, int]
"""Codes in a row, from the first to the last."""


@dataclass(frozen=True, slots=True)
class Codes:
    """The codes of one field that are wrong.

    Parameters
    ----------
    spans
        Those in a row: comparing is faster than looking up.
    right
        Those that are not wrong, where they are few.
    detail
        What tells them from other wrong codes of the field.
    """

    message: type[Message]
    field: Field
    spans: tuple[Span, ...]
    right: tuple[int, ...] = ()
    detail: str = ""

    def are_wrong(self, raw: NDArray[Any]) -> NDArray[np.bool_]:
        """Which raw values are."""
        wrong = np.zeros(len(raw), np.bool_)
        for first, last in self.spans:
            wrong |= raw == first if first == last else (raw >= first) & (raw <= last)
        return wrong


def whole_fields(protocol: Protocol) -> Iterator[tuple[type[Message], Field]]:
    """The fields that are whole numbers on the wire, in every frame of their message."""
    for message in protocol.messages:
        for field in message.FIELDS.values():
            if not (isinstance(field, FloatField) or field.signal.multiplexer):
                yield message, field


def without(spans: Iterable[Span], right: Collection[int]) -> tuple[Span, ...]:
    """What is left of spans without some codes."""
    left: list[Span] = []
    for first, last in spans:
        begin = first
        for code in sorted(code for code in right if first <= code <= last):
            left.append((begin, code - 1))
            begin = code + 1
        left.append((begin, last))
    return tuple((first, last) for first, last in left if first <= last)


def judge_codes(
    findings: Findings,
    chunk: Chunk,
    every: Iterable[Codes],
    describe: Callable[[Codes, int], Said],
    measure: Callable[[Codes, NDArray[Any]], NDArray[np.float64]] | None = None,
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
        message, name = codes.message, codes.field.dbc_name
        subject = Subject(message.SENDER, message.NAME, name, codes.detail)
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
