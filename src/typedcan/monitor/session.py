"""A watch that one thread feeds while another looks at it, and the recording beside it."""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import can

from typedcan.monitor.picture import Picture
from typedcan.monitor.watch import Watch, WatchEvent
from typedcan.node.clock import Clock
from typedcan.node.events import BusBack, BusLost
from typedcan.shell.recording import Recording, RecordingError
from typedcan.wire.link import Fault

_EVENTS = 10_000
"""How many events are kept for a reader; the oldest go first."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """A recording ended: on request, or by what ``problem`` says."""

    path: Path
    frames: int
    problem: str = ""

    def __str__(self) -> str:
        if self.problem:
            return f"recording ended after {self.frames} frames: {self.problem}"
        return f"{self.path}: recorded {self.frames} frames"


SessionEvent = WatchEvent | Fault | BusLost | BusBack | Recorded


class Happened(NamedTuple):
    """An event, and the second at which it was noticed."""

    at: float
    event: SessionEvent


@dataclass(frozen=True, slots=True)
class Status:
    """How the monitor itself is.

    Parameters
    ----------
    bus_lost
        What the bus said when it was lost, empty while it works.
    recording, recorded
        Where frames are recorded to, None where they are not, and how many were.
    ended
        How the last recording ended, None where there was none.
    frames, messages
        How many came since counting began.
    """

    bus_lost: str
    recording: Path | None
    recorded: int
    ended: Recorded | None
    frames: int
    messages: int


class Session:
    """Takes frames in one thread and tells what they amount to in others."""

    def __init__(self, watch: Watch, clock: Clock) -> None:
        self._watch = watch
        self._clock = clock
        self._began = clock.now()
        watch.clear(self._began)  # making it takes its time, in which nothing was heard
        self._lock = threading.Lock()
        self._events: deque[Happened] = deque(maxlen=_EVENTS)
        self._bus_lost = ""
        self._recording: Recording | None = None
        self._ended: Recorded | None = None

    @property
    def clock(self) -> Clock:
        """The clock of all times here."""
        return self._clock

    @property
    def began(self) -> float:
        """When the session began, in seconds of its clock."""
        return self._began

    @property
    def next_check(self) -> float:
        """When `check` is due."""
        return self._watch.next_check

    def take(self, frame: can.Message) -> None:
        """Take a frame: it is recorded before anything else is done with it."""
        with self._lock:
            now = self._clock.now()
            if self._recording:
                self._record(self._recording, frame)
            self._note(*self._watch.take(frame, now))

    def check(self) -> None:
        """Let time pass up to the clock's."""
        with self._lock:
            self._note(*self._watch.check(self._clock.now()))

    def tell_bus(self, event: BusLost | BusBack) -> None:
        """The bus was lost, or is back."""
        with self._lock:
            self._bus_lost = event.error if isinstance(event, BusLost) else ""
            self._note(event)

    def picture(self) -> Picture:
        """All that is known now."""
        with self._lock:
            now = self._clock.now()
            self._note(*self._watch.check(now))
            return self._watch.picture(now)

    def status(self) -> Status:
        """How the monitor itself is."""
        with self._lock:
            recording = self._recording
            return Status(
                bus_lost=self._bus_lost,
                recording=recording.path if recording else None,
                recorded=recording.frames if recording else 0,
                ended=self._ended,
                frames=self._watch.frames,
                messages=self._watch.messages,
            )

    def events(self) -> list[Happened]:
        """What happened since the last call."""
        with self._lock:
            events = list(self._events)
            self._events.clear()
            return events

    def clear(self) -> None:
        """Count and measure anew."""
        with self._lock:
            self._watch.clear(self._clock.now())

    def record(self, path: Path) -> None:
        """Record all frames from now on; raises `RecordingError` where that cannot be begun."""
        with self._lock:
            if self._recording:
                raise RecordingError(f"{self._recording.path} is being recorded already")
            self._recording = Recording(path)
            self._ended = None

    def stop_recording(self) -> None:
        """End the recording, if there is one, with all of it in the file."""
        with self._lock:
            if self._recording:
                self._end(self._recording)

    def _record(self, recording: Recording, frame: can.Message) -> None:
        try:
            recording.write(frame)
        except RecordingError as error:
            self._end(recording, str(error))

    def _end(self, recording: Recording, problem: str = "") -> None:
        self._recording = None
        try:
            recording.close()
        except RecordingError as error:
            problem = problem or str(error)
        problem = problem or "; ".join(recording.remarks())
        self._ended = Recorded(recording.path, recording.frames, problem)
        self._note(self._ended)

    def _note(self, *events: SessionEvent) -> None:
        for event in events:
            self._events.append(Happened(self._clock.now(), event))
