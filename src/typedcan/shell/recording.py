"""Recording frames to a log file, in any format that python-can writes."""

from __future__ import annotations

import struct
import threading
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from copy import copy
from pathlib import Path

import can
from can.io.generic import MessageWriter
from can.util import channel2int

from typedcan.model.errors import TypedcanError, one_line

_CANNOT: Mapping[str, tuple[tuple[str, str], ...]] = {
    ".trc": (
        ("error frames", "is_error_frame"),
        ("remote frames", "is_remote_frame"),
        ("CAN FD frames", "is_fd"),
    ),
}
"""What python-can's writers leave out without a word."""

_LATEST = 2.0**32
"""Seconds since 1970 that every format can hold."""

_CHANNELS = 0xFFFE
"""The highest channel number that all formats can hold."""


class RecordingError(TypedcanError):
    """A log file cannot be written: one line says which and why."""


class Recording:
    """A log file that is being written; python-can knows its format by the suffix.

    Raises `RecordingError` where the file is there already, cannot be made, or has a suffix that
    python-can does not write.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.frames = 0
        """How many were written."""
        self.left_out: Counter[str] = Counter()
        """What the format or its writer cannot hold, by kind; the recording went on."""
        self.retimed = 0
        """How many were written with the system's time, since their own was none."""
        self._cannot = _CANNOT.get(path.suffix.lower(), ())
        self._names_channels = path.suffix.lower() == ".log"
        self._thread_error: BaseException | None = None
        self._hook = threading.excepthook
        before = set(threading.enumerate())
        self._writer = _open(path)
        # The SQLite writer has a thread; what goes wrong there would only be printed.
        self._threads = set(threading.enumerate()) - before
        if self._threads:
            threading.excepthook = self._note_thread_error

    def write(self, frame: can.Message) -> None:
        """Write a frame; raises `RecordingError` where the file takes no more.

        One whose time stamp cannot be gets the system's time, since writers refuse it. One that the
        format cannot hold is left out and counted, and so is one that the writer refuses.
        """
        for kind, attribute in self._cannot:
            if getattr(frame, attribute):
                self.left_out[kind] += 1
                return
        timed = _timed(frame)
        self.retimed += timed is not frame
        frame = timed
        try:
            self._writer.on_message_received(frame if self._names_channels else _numbered(frame))
        except (ValueError, TypeError, OverflowError, struct.error) as error:
            self.left_out[f"frames that the writer refuses ({one_line(error)})"] += 1
            return
        except Exception as error:  # noqa: BLE001 - writers raise what they like
            raise self._error(error) from None
        if self._thread_error:
            raise self._error(self._thread_error)
        self.frames += 1

    def remarks(self) -> Iterator[str]:
        """What is not in the file as it was on the bus, a line each."""
        for kind, many in self.left_out.items():
            yield f"{self.path}: left out, {self.path.suffix} cannot hold them: {many:,} {kind}"
        if self.retimed:
            yield f"{self.path}: {self.retimed:,} frames without a time have that of this computer"

    def close(self) -> None:
        """Write what is still on its way, and close the file; raises `RecordingError`."""
        try:
            self._writer.stop()
        except Exception as error:  # noqa: BLE001 - as above
            # Some writers leave the file open where the last of it cannot be written.
            with suppress(Exception):
                self._writer.file.close()  # type: ignore[attr-defined]
            raise self._error(error) from None
        finally:
            if self._threads:
                threading.excepthook = self._hook
        if self._thread_error:
            raise self._error(self._thread_error)

    def _note_thread_error(self, args: threading.ExceptHookArgs, /) -> None:
        if args.thread in self._threads:
            self._thread_error = args.exc_value
        else:
            self._hook(args)

    def _error(self, error: BaseException) -> RecordingError:
        return RecordingError(f"{self.path}: {_reason(error)}")


def free_name(folder: Path, stem: str, suffix: str = ".blf") -> Path:
    """The first of stem-1, stem-2 and so on that is not there yet."""
    number = 1
    while (path := folder / f"{stem}-{number}{suffix}").exists():
        number += 1
    return path


def _open(path: Path) -> MessageWriter:
    try:
        path.open("xb").close()  # writers replace what is there
    except FileExistsError:
        raise RecordingError(f"{path}: is there already, choose another name") from None
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from None
    try:
        return can.Logger(path)
    except Exception as error:  # noqa: BLE001 - as above
        path.unlink(missing_ok=True)
        problem = _reason(error)
        if path.suffix.lower() not in (*can.io.logger.MESSAGE_WRITERS, ".gz"):
            known = ", ".join(sorted(can.io.logger.MESSAGE_WRITERS))
            problem = (
                f"python-can writes no {path.suffix or 'file without a suffix'}; it writes {known}"
            )
        raise RecordingError(f"{path}: {problem}") from None


def _timed(frame: can.Message) -> can.Message:
    """The frame, with the system's time where its own is none."""
    if 0 <= frame.timestamp < _LATEST:  # not where it is not a number
        return frame
    writable = copy(frame)
    writable.timestamp = time.time()
    return writable


def _numbered(frame: can.Message) -> can.Message:
    """The frame, without a channel that ends in too long a number, such as a serial number."""
    number = channel2int(frame.channel)
    if number is None or number < _CHANNELS:
        return frame
    writable = copy(frame)
    writable.channel = None
    return writable


def _reason(error: BaseException) -> str:
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return one_line(error)
