"""Bits of a message that are to be 0."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings, Said, Subject
from swapcan.conform.text import Text
from typedcan.wire.message import Message

ALL_BITS = (1 << 64) - 1


def judge_zeros(
    findings: Findings, chunk: Chunk, masks: Mapping[type[Message], int], text: Text
) -> None:
    """Judge the frames that can be believed of some messages.

    Parameters
    ----------
    masks
        The bits that are to be 0, with bit 0 the lowest of byte 0.
    text
        What is said of a frame with others; gets the ``bits`` that are 1.
    """
    for message, mask in masks.items():
        series = chunk.sound(message)
        words = np.ascontiguousarray(series.payload).view("<u8")[:, 0] & np.uint64(mask)
        subject = Subject(message.SENDER, message.NAME)
        findings.rows(subject, series, words != 0, partial(_describe, text, words))


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
    word = int(words[row])
    return text, {"bits": ranges([bit for bit in range(64) if word >> bit & 1])}
