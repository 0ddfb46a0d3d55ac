"""What a live node tells besides what it receives, and how it reaches callbacks and streams."""

from __future__ import annotations

import asyncio
import logging
import threading
from collections import deque
from collections.abc import AsyncGenerator, Callable
from dataclasses import dataclass
from typing import Any

from typedcan.supervise import SupervisionEvent
from typedcan.transfer import Problem, Value
from typedcan.wire.link import Fault, Received
from typedcan.wire.message import Message

_LOG = logging.getLogger("typedcan")

_RAISED = "a callback raised; the node goes on"

_END = object()


@dataclass(frozen=True, slots=True)
class BusLost:
    """The bus does not work any more; ``error`` is what it said, ``at`` the second it did."""

    error: str
    at: float

    def __str__(self) -> str:
        return f"bus lost: {self.error}"


@dataclass(frozen=True, slots=True)
class BusBack:
    """The bus that was lost works again."""

    at: float

    def __str__(self) -> str:
        return "bus back"


@dataclass(frozen=True, slots=True)
class SendFailed:
    """A message could not be sent; it is reported once, until it can be sent again."""

    message: type[Message]
    error: str
    at: float

    def __str__(self) -> str:
        return f"{self.message.NAME}: not sent: {self.error}"


@dataclass(frozen=True, slots=True)
class ReceiveFailed:
    """A frame could not be handled; it is reported once, until one like it can be again.

    ``frame_id`` is its identifier.
    """

    frame_id: int
    error: str
    at: float

    def __str__(self) -> str:
        return f"frame 0x{self.frame_id:08X} not handled: {self.error}"


@dataclass(frozen=True, slots=True)
class NodeFailed:
    """A thread of the node cannot go on: the node sends its safe codes, and then nothing more."""

    error: str
    at: float

    def __str__(self) -> str:
        return f"the node cannot go on and sends nothing more: {self.error}"


@dataclass(frozen=True, slots=True)
class Overrun:
    """The reader of a stream was too slow: so many of the oldest events were dropped."""

    dropped: int

    def __str__(self) -> str:
        return f"{self.dropped} events dropped"


Event = (
    Received[Message]
    | Fault
    | SupervisionEvent
    | Problem
    | Value
    | BusLost
    | BusBack
    | SendFailed
    | ReceiveFailed
    | NodeFailed
    | Overrun
)
"""All that a node tells; results of its transfers can have classes of their own."""


class Stream:
    """Events on their way from a thread to one reader on an event loop.

    Must be made on that loop. No more than ``limit`` wait; the oldest make room. With a ``kind``
    they are those of that class, or of that message class; then it is logged where one is dropped.
    """

    def __init__(self, limit: int, kind: type | None = None) -> None:
        try:
            self._loop = asyncio.get_running_loop()
        except RuntimeError:
            raise RuntimeError("events() is called outside of an event loop") from None
        self._limit = limit
        self.kind = kind
        self._events: deque[Any] = deque()
        self._dropped = 0
        self._lock = threading.Lock()
        self._arrived = asyncio.Event()
        self._woken = False

    def put(self, event: object) -> None:
        """Hand over an event, from any thread."""
        with self._lock:
            self._events.append(event)
            if len(self._events) > self._limit:
                self._events.popleft()
                self._dropped += 1
            if self._woken:
                return  # the reader will find this event beside the one that wakes it
            self._woken = True
        try:
            self._loop.call_soon_threadsafe(self._arrived.set)
        except RuntimeError:
            _LOG.debug("the event loop of a stream is closed")

    def end(self) -> None:
        """Let the reader end once it has read all, from any thread."""
        self.put(_END)

    async def read(self) -> AsyncGenerator[Any, None]:
        """The events in their order, until `end`."""
        while True:
            await self._arrived.wait()
            self._arrived.clear()
            with self._lock:
                events, self._events = self._events, deque()
                dropped, self._dropped = self._dropped, 0
                self._woken = False
            if dropped and self.kind:
                _LOG.warning("%s: %s", self.kind.__name__, Overrun(dropped))
            elif dropped:
                yield Overrun(dropped)
            for event in events:
                if event is _END:
                    return
                yield event


class Dispatcher:
    """Who wants to know what: callbacks by the kind of event, and streams of all or of a kind."""

    def __init__(self) -> None:
        self._callbacks: dict[type | None, tuple[Callable[[Any], object], ...]] = {}
        self._streams: tuple[Stream, ...] = ()
        self._lock = threading.Lock()

    def on(self, kind: type, callback: Callable[[Any], object]) -> Callable[[], None]:
        """Call back with each event of a kind; returns what ends that."""
        with self._lock:
            self._callbacks[kind] = (*self._callbacks.get(kind, ()), callback)
        off = False

        def take_off() -> None:
            nonlocal off
            with self._lock:
                if not off:
                    off = True
                    callbacks = list(self._callbacks[kind])
                    callbacks.remove(callback)
                    self._callbacks[kind] = tuple(callbacks)

        return take_off

    def emit(self, event: object, kind: type | None = None) -> None:
        """Tell an event to the callbacks of its type and of ``kind``, and to all streams.

        `SystemExit` and its like are raised again once all have been told.
        """
        callbacks, failure = self._callbacks, None
        for callback in (*callbacks.get(type(event), ()), *callbacks.get(kind, ())):
            try:
                callback(event)
            except Exception:  # noqa: BLE001 - what a user's function raises stops no node
                _LOG.exception(_RAISED)
            except BaseException as error:  # noqa: BLE001 - the others are told first
                failure = failure or error
        for stream in self._streams:
            if stream.kind in (None, type(event), kind):
                stream.put(event)
        if failure:
            raise failure

    def stream(self, limit: int, kind: type | None = None) -> AsyncGenerator[Any, None]:
        """Events from now on, until `end_streams`; must be called on an event loop."""
        stream = Stream(limit, kind)
        with self._lock:
            self._streams = (*self._streams, stream)
        return self._read(stream)

    def end_streams(self) -> None:
        """Let all streams end once they are read."""
        with self._lock:
            streams, self._streams = self._streams, ()
        for stream in streams:
            stream.end()

    async def _read(self, stream: Stream) -> AsyncGenerator[Any, None]:
        try:
            async for event in stream.read():
                yield event
        finally:
            with self._lock:
                self._streams = tuple(each for each in self._streams if each is not stream)
