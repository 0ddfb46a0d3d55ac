"""The CAN frames of an MF4 file's channel groups, through asammdf, some records at a time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from traceback import walk_tb
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.read.blocks import NARROW, WIDE, Channels, clear_beyond
from typedcan.logs.read.mf4_stream import open_stream
from typedcan.logs.read.silence import silenced
from typedcan.logs.read.source import LogError, Start

# asammdf has no types that a checker could use: what comes from it is Any, in this module alone

_BUS_EVENT = 2  # flag of a channel group
_SOURCE_BUS = 2
_BUS_CAN = 2
_DATA, _ERROR, _REMOTE = _KINDS = "CAN_DataFrame", "CAN_ErrorFrame", "CAN_RemoteFrame"
_REQUIRED = {_DATA: {"ID", "DataLength", "DataBytes"}, _ERROR: set[str](), _REMOTE: {"ID", "DLC"}}
_MOST_BYTES = 65_536  # of a record
_ID_MASK = 0x1FFF_FFFF
_FD_FLAGS = (
    ("EDL", FrameFlag.FD),
    ("BRS", FrameFlag.BIT_RATE_SWITCH),
    ("ESI", FrameFlag.ERROR_STATE),
)

_1970 = datetime(1970, 1, 1)


class DamagedMf4(Exception):
    """What asammdf cannot read, in one line."""


@dataclass(frozen=True, slots=True)
class Group:
    """A channel group of frames: its index in the file, its kind, how many records of what size."""

    index: int
    kind: str
    count: int
    record_size: int


@contextmanager
def _damage() -> Iterator[None]:
    """Every error is `DamagedMf4`: asammdf trusts the file, so that any may come of it."""
    try:
        with silenced("asammdf"):
            yield
    except DamagedMf4:
        raise
    except Exception as error:  # noqa: BLE001
        _make_deletable(error)
        text = " ".join(str(error).split())
        raise DamagedMf4(f"{type(error).__name__}: {text}" if text else "unreadable") from None


def _make_deletable(error: Exception) -> None:
    """Spare the terminal a traceback: asammdf's MDF4 cannot be deleted before it is half open."""
    for frame, _ in walk_tb(error.__traceback__):
        half_open: Any = frame.f_locals.get("self")
        if type(half_open).__name__ == "MDF4":
            for name in ("header", "identification"):
                if not hasattr(half_open, name):
                    setattr(half_open, name, None)


class Mf4File:
    """An MF4 file that is open.

    Everything raises `DamagedMf4` on a damaged file; opening it, `LogError` without asammdf.
    """

    def __init__(self, path: Path) -> None:
        try:
            asammdf = import_module("asammdf")
        except ImportError:
            raise LogError(f"{path}: needs asammdf: pip install 'swapcan[mf4]'") from None
        self._stream = open_stream(path)
        try:
            with _damage(), redirect_stdout(None):  # asammdf prints what it cannot finish
                self._mdf: Any = asammdf.MDF(self._stream, process_bus_logging=False)
                self.start = _start(self._mdf.header.start_time)
                self._start = (self.start.wall - _1970).total_seconds()
        except DamagedMf4:
            self._stream.close()
            raise

    def close(self) -> None:
        """Close the file."""
        self._mdf.close()
        self._stream.close()

    def groups(self) -> list[Group]:
        """The groups of the CAN bus that have records."""
        with _damage():
            found = (_group(index, group) for index, group in enumerate(self._mdf.groups))
            return [group for group in found if group]

    def frames(self, group: Group, start: int, count: int, channels: Channels) -> FrameBlock:
        """So many frames of a group from a record on, or fewer where the file has no more."""
        with _damage():
            signal = self._mdf.get(
                group.kind, group.index, record_offset=start, record_count=count, raw=False
            )
            names = signal.samples.dtype.names or ()
            fields = {name.rpartition(".")[2]: signal.samples[name] for name in names}
            return _block(group.kind, fields, signal.timestamps + self._start, channels)


def _start(began: datetime) -> Start:
    """Asammdf leaves the zone out where the header says that it is the recorder's."""
    is_utc = began.tzinfo is not None
    wall = began.astimezone(UTC).replace(tzinfo=None) if is_utc else began
    return Start(wall, is_utc=is_utc, counted=False)


def _group(index: int, group: Any) -> Group | None:
    head = group.channel_group
    source = head.acq_source
    if not head.flags & _BUS_EVENT or not head.cycles_nr or source is None:
        return None
    if not source.source_type & _SOURCE_BUS or source.bus_type != _BUS_CAN:
        return None
    names = [channel.name for channel in group.channels]
    kinds = [kind for kind in _KINDS if kind in names]
    if not kinds:
        return None
    held = int(head.samples_byte_nr)
    size = held + int(head.invalidation_bytes_nr)
    if size > _MOST_BYTES:
        raise DamagedMf4(f"records of {size:,} bytes, which no frame needs")
    for channel in group.channels:  # asammdf's C code reads wherever these say
        bits = 8 * int(channel.byte_offset) + int(channel.bit_offset) + int(channel.bit_count)
        if bits > 8 * held:
            raise DamagedMf4(f"a channel that is not within its records of {held} bytes")
    return Group(index, kinds[0], int(head.cycles_nr), size)


def _block(
    kind: str, fields: dict[str, NDArray[Any]], timestamp: NDArray[Any], channels: Channels
) -> FrameBlock:
    """Frames of one kind; as for python-can, some fields may be missing."""
    missing = _REQUIRED[kind] - fields.keys()
    if missing:
        raise DamagedMf4(f"{kind} has no {', '.join(sorted(missing))}")
    count = len(timestamp)
    flags = _flags(kind, fields, count)
    data, length = _payload(fields, count)
    remote = flags & FrameFlag.REMOTE != 0
    if remote.any():
        clear_beyond(data, np.where(remote, np.uint8(0), length))
        length = np.where(remote, fields["DLC"] if kind == _REMOTE else 0, length).astype(np.uint8)
    if "BusChannel" in fields:
        channel = channels.indices(fields["BusChannel"].astype(np.int32))
    else:
        channel = np.full(count, channels.index(None), np.int16)
    frame_id = fields.get("ID", np.zeros(count)).astype(np.uint32) & np.uint32(_ID_MASK)
    times = timestamp.astype(np.float64)
    return FrameBlock(times, frame_id, flags, channel, length, data, channels.known)


def _flags(kind: str, fields: dict[str, NDArray[Any]], count: int) -> NDArray[np.uint8]:
    constant = {_DATA: 0, _ERROR: int(FrameFlag.ERROR), _REMOTE: int(FrameFlag.REMOTE)}
    flags = np.full(count, constant[kind], np.uint8)
    sent = np.zeros(count, bool)
    if "Dir" in fields:
        direction = fields["Dir"]
        sent = direction != b"Rx" if direction.dtype.kind == "S" else direction.astype(int) != 0
    bits: list[tuple[NDArray[Any], FrameFlag]] = [(sent, FrameFlag.SENT)]
    bits.append((fields.get("IDE", np.ones(count)), FrameFlag.EXTENDED))
    if kind != _REMOTE:
        bits += [(fields[name], flag) for name, flag in _FD_FLAGS if name in fields]
    if kind == _ERROR and "RTR" in fields:
        bits.append((fields["RTR"], FrameFlag.REMOTE))
    for field, flag in bits:
        flags[field.astype(bool)] |= np.uint8(flag)
    return flags


def _payload(
    fields: dict[str, NDArray[Any]], count: int
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Rows of payload and the bytes of each; rows of 8 bytes where no frame is longer."""
    if "DataBytes" not in fields or "DataLength" not in fields:
        return np.zeros((count, NARROW), np.uint8), np.zeros(count, np.uint8)
    held = fields["DataBytes"].reshape(count, -1)
    length = np.minimum(fields["DataLength"], min(held.shape[1], WIDE)).astype(np.uint8)
    width = NARROW if not count or int(length.max()) <= NARROW else WIDE
    data = np.zeros((count, width), np.uint8)
    used = min(width, held.shape[1])
    data[:, :used] = held[:, :used]
    clear_beyond(data, length)
    return data, length
