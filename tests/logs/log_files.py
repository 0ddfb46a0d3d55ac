"""Logs of every kind, written by python-can, and what python-can makes of them."""

from __future__ import annotations

import random
from collections.abc import Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import can
import pytest
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock, FrameFlag

START = 1_700_000_000.0
"""When the logs begin, in seconds since 1970."""

Row = tuple[float, int, int, int | str | None, int, bytes]
"""A frame: time stamp, identifier, flags, channel, length and payload."""

_FD_LENGTHS = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64]


def frame_of(kind: str, *, timestamp: float, noise: random.Random) -> can.Message:
    """A frame with random properties.

    ``kind`` is ``classic``, ``remote``, ``error`` or ``fd``.
    """
    extended = noise.random() < 0.5
    fd = kind == "fd"
    length = noise.choice(_FD_LENGTHS) if fd else noise.randrange(9)
    return can.Message(
        timestamp=timestamp,
        arbitration_id=noise.randrange(2**29 if extended else 2**11),
        is_extended_id=extended,
        is_remote_frame=kind == "remote",
        is_error_frame=kind == "error",
        is_fd=fd,
        is_rx=noise.random() < 0.7,
        bitrate_switch=fd and noise.random() < 0.5,
        error_state_indicator=fd and noise.random() < 0.5,
        channel=noise.randrange(3),
        dlc=length,
        data=None if kind == "remote" else noise.randbytes(length),
        check=True,
    )


def mixed_frames(
    count: int, *, kinds: str = "classic remote error fd", start: float = START, seed: int = 1
) -> list[can.Message]:
    """Frames of these kinds, half of them classic data frames, up to 20 ms apart."""
    noise = random.Random(seed)
    others = kinds.split()
    frames, now = [], start
    for _ in range(count):
        kind = others[0] if noise.random() < 0.5 else noise.choice(others)
        frames.append(frame_of(kind, timestamp=round(now, 6), noise=noise))
        now += noise.random() * 0.02
    return frames


def write_log(path: Path, frames: Iterable[can.Message], **options: Any) -> Path:
    """A log of these frames; its suffix says of which kind."""
    with can.Logger(path, **options) as logger:
        for frame in frames:
            logger.on_message_received(frame)
    return path


def row_of(frame: can.Message) -> Row:
    """A frame of python-can's as a row."""
    flags = FrameFlag(0)
    for flag, is_set in (
        (FrameFlag.EXTENDED, frame.is_extended_id),
        (FrameFlag.REMOTE, frame.is_remote_frame),
        (FrameFlag.ERROR, frame.is_error_frame),
        (FrameFlag.FD, frame.is_fd),
        (FrameFlag.BIT_RATE_SWITCH, frame.bitrate_switch),
        (FrameFlag.ERROR_STATE, frame.error_state_indicator),
        (FrameFlag.SENT, not frame.is_rx),
    ):
        if is_set:
            flags |= flag
    length = frame.dlc if frame.is_remote_frame else len(frame.data)
    channel = frame.channel
    assert channel is None or isinstance(channel, int | str)
    return (
        frame.timestamp,
        frame.arbitration_id,
        int(flags),
        channel,
        length,
        bytes(frame.data),
    )


def rows_by_python_can(path: Path, **options: Any) -> list[Row]:
    """What python-can's reader gives for this log."""
    with can.LogReader(path, **options) as reader:
        return [row_of(frame) for frame in reader]


def long_is_fd(rows: list[Row]) -> list[Row]:
    """Rows of a format that does not say which frames are CAN FD: those above 8 bytes are."""
    return [(*row[:2], row[2] | FrameFlag.FD, *row[3:]) if len(row[5]) > 8 else row for row in rows]


def rows_in(blocks: Iterable[FrameBlock]) -> list[Row]:
    """What stands in the blocks; what is beyond a payload has to be zero."""
    rows: list[Row] = []
    for block in blocks:
        assert len(block) > 0
        _check_shape(block)
        columns = zip(
            block.timestamp.tolist(),
            block.frame_id.tolist(),
            block.flags.tolist(),
            block.channel.tolist(),
            block.length.tolist(),
            block.data,
            strict=True,
        )
        for timestamp, frame_id, flags, channel, length, data in columns:
            held = 0 if flags & FrameFlag.REMOTE else length
            assert not data[held:].any()
            payload = data[:held].tobytes()
            rows.append((timestamp, frame_id, flags, block.channels[channel], length, payload))
    return rows


def _check_shape(block: FrameBlock) -> None:
    columns: list[tuple[NDArray[Any], str]] = [
        (block.timestamp, "float64"),
        (block.frame_id, "uint32"),
        (block.flags, "uint8"),
        (block.channel, "int16"),
        (block.length, "uint8"),
        (block.data, "uint8"),
    ]
    for column, kind in columns:
        assert column.dtype == kind
        assert len(column) == len(block)
    assert block.data.shape[1] in (8, 64)
    assert block.data.flags.c_contiguous


NEEDS_ASAMMDF = pytest.mark.skipif(
    find_spec("asammdf") is None, reason="asammdf, an extra of its own, is not installed"
)
"""For what writes or reads MF4."""
