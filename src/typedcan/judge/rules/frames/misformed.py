"""Frames that are meant as a message's but are misformed, judged among its other frames."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.series import Series
from typedcan.logs.columns import MessageColumns
from typedcan.logs.frames import FrameBlock
from typedcan.wire.message import Message

Describe = Callable[[type[Message], FrameBlock, int], Said]
"""What is wrong with one row of a block."""

_NONE = np.empty(0, np.int64)


def judge_misformed(
    findings: Findings,
    chunk: Chunk,
    messages: Sequence[type[Message]],
    misformed: Mapping[type[Message], NDArray[np.int64]],
    describe: Describe,
) -> None:
    """Judge the frames of all messages and some others; those in a row are one occurrence.

    Parameters
    ----------
    messages
        All of the protocol.
    misformed
        Rows of the chunk's block that are wrong, by the message that they are meant as; all frames
        of the messages themselves are right.
    """
    for message in messages:
        own = chunk.frames(message)
        rows = misformed.get(message, _NONE)
        if len(rows):
            _judge(findings, chunk, message, rows, describe)
        elif own.fresh:
            subject = Subject(message.SENDER, message.NAME)
            right = np.zeros(len(own), np.bool_)
            findings.rows(subject, own, right, partial(describe, message, chunk.block))


def _judge(
    findings: Findings,
    chunk: Chunk,
    message: type[Message],
    misformed: NDArray[np.int64],
    describe: Describe,
) -> None:
    """Judge one message where some frames are misformed."""
    own, block = chunk.frames(message), chunk.block
    rows = np.sort(np.concatenate([own.order[own.first :] - chunk.first_order, misformed]))
    columns = MessageColumns(
        message.NAME,
        message.FRAME_ID,
        is_extended=message.EXTENDED,
        block=block,
        rows=rows,
        columns={},
    )
    series = Series(message, columns, None, chunk.begin, chunk.first_order)

    def described(place: int) -> Said:
        return describe(message, block, int(rows[place]))

    subject = Subject(message.SENDER, message.NAME)
    findings.rows(subject, series, np.isin(rows, misformed), described)
