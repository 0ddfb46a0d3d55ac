"""Bits of a message that are to be 0."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.model.layout import bits
from typedcan.model.protocol import ReservedBits, Signal
from typedcan.report.language import Text
from typedcan.wire.message import Message

_WORD = 8
"""Bytes that are looked at together."""


def mask_of(places: Iterable[Signal | ReservedBits]) -> int:
    """The bits that signals or reserved fields take, with bit 0 the lowest of byte 0."""
    return sum(1 << bit for bit in {bit for place in places for bit in bits(place)})


def judge_zeros(
    findings: Findings, chunk: Chunk, masks: Mapping[type[Message], int], text: Text
) -> None:
    """Judge the frames that can be believed of some messages.

    Parameters
    ----------
    masks
        The bits that are to be 0, as `mask_of` has them.
    text
        What is said of a frame with others; gets the ``bits`` that are 1.
    """
    for message, mask in masks.items():
        series = chunk.sound(message)
        if series.fresh:
            words = _words(series.payload) & _words(_bytes(mask, message.LENGTH))
            subject = Subject(message.SENDER, message.NAME)
            wrong = words[:, 0] != 0 if words.shape[1] == 1 else (words != 0).any(axis=1)
            findings.rows(subject, series, wrong, partial(_describe, text, words))


def _words(payload: NDArray[np.uint8]) -> NDArray[np.uint64]:
    """Payloads of any length as words, filled up with 0."""
    more = -payload.shape[1] % _WORD
    padded = np.pad(payload, ((0, 0), (0, more))) if more else np.ascontiguousarray(payload)
    return padded.view("<u8")


def _bytes(mask: int, length: int) -> NDArray[np.uint8]:
    return np.frombuffer(mask.to_bytes(length, "little"), np.uint8)[None, :]


def ranges(numbers: Sequence[int]) -> str:
    """Ascending numbers in words, such as ``3, 5-9``."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 1 else f"{run[0]}" for run in runs)


def _describe(text: Text, words: NDArray[np.uint64], row: int) -> Said:
    number = int.from_bytes(words[row].tobytes(), "little")
    return text, {"bits": ranges([bit for bit in range(number.bit_length()) if number >> bit & 1])}
