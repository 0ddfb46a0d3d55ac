"""Logs of all other kinds, frame by frame through python-can's reader for them."""

from __future__ import annotations

import math
import sqlite3
import struct
import zlib
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import can
import numpy as np
from can.io.generic import MessageReader
from can.util import dlc2len

from typedcan.logs.frames import FrameBlock
from typedcan.logs.read.blocks import NARROW, WIDE, Channels
from typedcan.logs.read.frame import (
    BIT_RATE_SWITCH,
    ERROR,
    ERROR_STATE,
    EXTENDED,
    FD,
    LARGEST_ID,
    REMOTE,
    SENT,
)
from typedcan.logs.read.source import BLOCK_SIZE, Damage, FileSource, LogError

_SQLITE = b"SQLite format 3\0"
_DAMAGE = (
    ArithmeticError,
    AttributeError,
    EOFError,
    LookupError,
    NotImplementedError,
    OSError,
    TypeError,
    ValueError,
    sqlite3.Error,
    struct.error,
    zlib.error,
)


class OtherSource(FileSource):
    """A log of a kind that python-can or one of its plugins reads, such as SQLite.

    Parameters
    ----------
    path
        The log.
    block_size
        Frames in a block.

    Raises
    ------
    LogError
        Where python-can does not know the suffix.
    """

    def __init__(self, path: Path, block_size: int = BLOCK_SIZE) -> None:
        super().__init__(path, block_size)
        self._count = 0
        self._reader: MessageReader | None = None
        try:
            self._reader = _reader(path)
        except _DAMAGE as error:
            if path.suffix.lower() not in can.io.MESSAGE_READERS:
                known = ", ".join(sorted(can.io.MESSAGE_READERS))
                raise LogError(f"{path}: no log of a known kind; known are {known}") from None
            self._broke(error)

    def close(self) -> None:
        """Close the file."""
        if self._reader is not None:
            self._reader.stop()
            self._reader = None

    def __iter__(self) -> Iterator[FrameBlock]:
        """The frames, in blocks."""
        channels = Channels()
        frames = self._frames()
        while some := list(islice(frames, self._block_size)):
            yield _block(some, channels)

    def _frames(self) -> Iterator[can.Message]:
        if self._reader is None:
            return
        try:
            for frame in self._reader:
                if not isinstance(frame.arbitration_id, int) or not isinstance(
                    frame.timestamp, int | float
                ):
                    raise ValueError("a frame without identifier or time")  # noqa: TRY004
                _payload_length(frame)  # raises where a damaged file made nonsense of a frame
                _channel_of(frame)
                self._count += 1
                yield frame
        except _DAMAGE as error:
            self._broke(error)
        else:
            self._position = self._size  # before, python-can does not say how far it is

    def _broke(self, error: Exception) -> None:
        where = f"frame {self._count + 1}"
        problem = " ".join(str(error).split()) or type(error).__name__
        self.damage = Damage(self.path, where, problem, "all frames from there on")


def _reader(path: Path) -> MessageReader:
    """python-can chooses by the suffix; a database may have any."""
    with path.open("rb") as file:
        is_database = file.read(len(_SQLITE)) == _SQLITE
    return can.SqliteReader(path) if is_database else can.LogReader(path)


def _block(frames: list[can.Message], channels: Channels) -> FrameBlock:
    width = WIDE if any(len(frame.data) > NARROW for frame in frames) else NARROW
    payloads = (bytes(frame.data).ljust(width, b"\0") for frame in frames)
    return FrameBlock(
        np.array([frame.timestamp for frame in frames], np.float64),
        np.array([frame.arbitration_id for frame in frames], np.uint32),
        np.array([_flags_of(frame) for frame in frames], np.uint8),
        np.array([channels.index(_channel_of(frame)) for frame in frames], np.int16),
        np.array([_payload_length(frame) for frame in frames], np.uint8),
        np.frombuffer(bytearray().join(payloads), np.uint8).reshape(-1, width),
        channels.known,
    )


def _payload_length(frame: can.Message) -> int:
    """The bytes of payload of a frame, or the DLC of a remote frame.

    Raises `ValueError` where python-can made a frame of a line that does not hold one.
    """
    if not 0 <= frame.arbitration_id <= LARGEST_ID:
        raise ValueError("the identifier has more than 29 bits")
    if not math.isfinite(frame.timestamp):
        raise ValueError("the time is no number")
    length = frame.dlc if frame.is_remote_frame else len(frame.data)
    meant = frame.dlc
    if length != meant and not frame.is_fd:
        meant = min(meant, NARROW)  # a DLC above 8 stands for 8 bytes
    if not 0 <= length <= WIDE or length not in (meant, dlc2len(max(frame.dlc, 0))):
        raise ValueError("the length and the payload do not agree")
    return length


def _channel_of(frame: can.Message) -> int | str | None:
    """The channel of a frame.

    Raises `ValueError` where it is garbage.
    """
    channel = frame.channel
    if channel is None or isinstance(channel, int):
        return channel
    if isinstance(channel, str) and channel.isprintable():
        return channel
    raise ValueError("the channel is no name")


def _flags_of(frame: can.Message) -> int:
    """The `FrameFlag` bits of a frame."""
    return (
        EXTENDED * frame.is_extended_id
        | REMOTE * frame.is_remote_frame
        | ERROR * frame.is_error_frame
        | FD * frame.is_fd
        | BIT_RATE_SWITCH * frame.bitrate_switch
        | ERROR_STATE * frame.error_state_indicator
        | SENT * (not frame.is_rx)
    )
