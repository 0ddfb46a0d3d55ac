"""Typed messages on a bus of python-can: sent complete, checked on receipt.

The bus is lent: nothing here opens, configures or closes one. `can.CanError` passes through.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import AsyncGenerator, Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, overload

import can

from typedcan.wire.codec import Codec
from typedcan.wire.errors import ReceiveTimeoutError
from typedcan.wire.message import Message, MessageT
from typedcan.wire.protect import SendCounters
from typedcan.wire.protocol import Protocol
from typedcan.wire.receiver import Counts, Fault, FaultKind, Received, Receiver

__all__ = ["Counts", "Fault", "FaultKind", "Link", "Received", "Receiver"]

_WAIT = 1.0
"""Seconds in one call of the bus, after which a bus that was shut down is noticed."""

_WAIT_IN_THREAD = 0.1
"""The same beside an event loop: as long a cancelled `Link.listen` takes to leave."""


class Link:
    """One node's typed messages on a bus of python-can.

    Keep one for as long as the bus, since it has the alive counters of both directions. One
    thread may send while another receives, if the bus lets them: `can.ThreadSafeBus` does.

    Parameters
    ----------
    bus
        Any bus of python-can; it is neither configured nor closed here.
    codec
        The protocol's, or one with checksum algorithms of one's own; a protocol stands for its own.
    on_fault
        Is called with each `Fault` of a received frame, before `receive` goes on.
    source_address
        The J1939 address to send from, where the database leaves it open (0xFE); without it, that
        of the node that sends the message.
    """

    def __init__(
        self,
        bus: can.BusABC,
        codec: Codec | Protocol,
        *,
        on_fault: Callable[[Fault], None] | None = None,
        source_address: int | None = None,
    ) -> None:
        self._bus = bus
        self._codec = Codec(codec) if isinstance(codec, Protocol) else codec
        self._on_fault = on_fault
        self._source_address = source_address
        self._sent = SendCounters()
        self._receiver = Receiver(self._codec)
        self._unread: deque[can.Message] = deque()

    @property
    def counts(self) -> Counts:
        """A snapshot of how many frames came in and what became of them."""
        return self._receiver.counts

    def send(
        self, message: Message, timeout: float | None = None, *, destination: int | None = None
    ) -> can.Message:
        """Send a message and return its frame.

        Checksum and alive counter are filled in, also where the message has old ones. The
        counter goes on once the bus has accepted the frame. ``timeout`` is python-can's, in
        seconds; ``destination`` is the J1939 address of the receiver, of messages that are matched
        by PGN and are not always for all. Raises `EncodeError` and `SendingError` before anything
        is sent, and `can.CanError`.
        """
        kind = type(message := self._codec.said(message))
        frame = self._codec.frame(
            message,
            counter=self._sent.peek(kind),
            source_address=self._source_address,
            destination=destination,
        )
        self._bus.send(frame, timeout=timeout)
        self._sent.advance(kind)
        return frame

    @overload
    def receive(self, *, timeout: float | None = 1.0) -> Received[Message]: ...
    @overload
    def receive(
        self, kind: type[MessageT], *, timeout: float | None = 1.0
    ) -> Received[MessageT]: ...
    def receive(
        self, kind: type[Message] | None = None, *, timeout: float | None = 1.0
    ) -> Received[Any]:
        """Wait for the next message, or the next one of a class, and return it.

        Foreign frames and messages of other classes are skipped, frames with a wrong length or
        checksum reported and skipped; a wrong counter is reported, and the message returned with
        that fault. ``timeout`` is in seconds; None waits for ever, 0 takes what has arrived. Raises
        `ReceiveTimeoutError`, also where frames arrive but no such message among them,
        `UnknownMessageError` for a class that is none of the protocol's, and `can.CanError`.
        """
        if kind is not None:
            self._codec.reader(kind)
        start = time.monotonic()
        wait = _WAIT if timeout is None or timeout >= _WAIT else max(timeout, 0.0)
        while True:
            frame = self._next_frame(wait)
            received = None if frame is None else self._take(frame)
            if received is not None and (kind is None or received.kind is kind):
                return received
            if timeout is not None:
                left = timeout - (time.monotonic() - start)
                if left <= 0 and (frame is None or timeout != 0):
                    raise ReceiveTimeoutError(timeout)
                wait = min(max(left, 0.0), _WAIT)

    def __iter__(self) -> Iterator[Received[Message]]:
        """Messages as they arrive, until the bus is shut down; raises `can.CanError`."""
        while True:
            try:
                received = self.receive(timeout=_WAIT)
            except ReceiveTimeoutError:
                if self._is_shut_down():
                    return
            except (can.CanError, OSError, ValueError):
                # Interfaces differ in what they raise once they are shut down.
                if self._is_shut_down():
                    return
                raise
            else:
                yield received

    async def listen(self) -> AsyncGenerator[Received[Message], None]:
        """Messages as they arrive, for ``async for``, until the bus is shut down.

        A thread waits on the bus, one frame at a time, so that every interface works on every
        event loop. Leaving the loop ends that thread and nothing else, and no frame is lost: one
        that came in meanwhile is the next that this link returns. Raises `can.CanError`.
        """
        pending: Future[can.Message | None] | None = None
        thread = ThreadPoolExecutor(1, "typedcan-listen")
        try:
            while True:
                pending = thread.submit(self._next_frame, _WAIT_IN_THREAD)
                frame = await asyncio.wrap_future(pending)
                pending = None
                if frame is None and self._is_shut_down():
                    return
                if frame and (received := self._take(frame)):
                    yield received
        except (can.CanError, OSError, ValueError):
            if not self._is_shut_down():
                raise
        finally:
            if pending:
                await self._put_back(pending)
            thread.shutdown(wait=False)

    async def _put_back(self, pending: Future[can.Message | None]) -> None:
        """Keep the frame that a cancelled `listen` was waiting for."""
        if pending.cancelled():
            return
        await asyncio.wait([asyncio.wrap_future(pending)])
        frame = None if pending.exception() else pending.result()
        if frame:
            self._unread.append(frame)

    def _next_frame(self, timeout: float) -> can.Message | None:
        return self._unread.popleft() if self._unread else self._bus.recv(timeout)

    def _take(self, frame: can.Message) -> Received[Message] | None:
        taken = self._receiver.take(frame)
        if type(taken) is Received:
            if taken.faults and self._on_fault:
                for fault in taken.faults:
                    self._on_fault(fault)
            return taken
        if isinstance(taken, Fault) and self._on_fault:
            self._on_fault(taken)
        return None

    def _is_shut_down(self) -> bool:
        # python-can has no public name for it.
        return self._bus._is_shutdown  # noqa: SLF001
