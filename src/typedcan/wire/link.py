"""Typed messages on a bus of python-can: sent complete, checked on receipt.

The bus is lent: nothing here opens, configures or closes one. `can.CanError` passes through.
"""

from __future__ import annotations

import asyncio
import math
import time
from collections import deque
from collections.abc import AsyncGenerator, Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor

import can

from typedcan.wire.codec import Codec
from typedcan.wire.errors import ReceiveTimeoutError
from typedcan.wire.message import Message
from typedcan.wire.protect import SendCounters
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
        For checksum algorithms of one's own.
    on_fault
        Is called with each `Fault` of a received frame, before `receive` goes on.
    """

    def __init__(
        self,
        bus: can.BusABC,
        codec: Codec,
        *,
        on_fault: Callable[[Fault], None] | None = None,
    ) -> None:
        self._bus = bus
        self._codec = codec
        self._on_fault = on_fault
        self._sent = SendCounters()
        self._receiver = Receiver(self._codec)
        self._unread: deque[can.Message] = deque()

    @property
    def counts(self) -> Counts:
        """A snapshot of how many frames came in and what became of them."""
        return self._receiver.counts

    def send(self, message: Message, timeout: float | None = None) -> can.Message:
        """Send a message and return its frame.

        Checksum and alive counter are filled in, also where the message has old ones. The
        counter goes on once the bus has accepted the frame. ``timeout`` is python-can's, in
        seconds. Raises `EncodeError` before anything is sent, and `can.CanError`.
        """
        kind = type(message)
        data = self._codec.encode(message, counter=self._sent.peek(kind), renew=True)
        frame = can.Message(
            arbitration_id=kind.FRAME_ID, is_extended_id=kind.EXTENDED, data=data, is_rx=False
        )
        self._bus.send(frame, timeout=timeout)
        self._sent.advance(kind)
        return frame

    def receive(self, timeout: float | None = 1.0) -> Received:
        """Wait for the next message and return it.

        Foreign frames are skipped, frames with a wrong length or checksum reported and skipped; a
        wrong counter is reported, and the message returned with that fault. ``timeout`` is in
        seconds; None waits for ever, 0 takes what has arrived. Raises `ReceiveTimeoutError`, also
        where frames arrive but no message among them, and `can.CanError`.
        """
        deadline = time.monotonic() + (math.inf if timeout is None else timeout)
        while True:
            left = deadline - time.monotonic()
            frame = self._next_frame(min(max(left, 0.0), _WAIT))
            received = self._take(frame) if frame else None
            if received:
                return received
            drained = frame is None or timeout != 0
            if timeout is not None and drained and time.monotonic() >= deadline:
                raise ReceiveTimeoutError(timeout)

    def __iter__(self) -> Iterator[Received]:
        """Messages as they arrive, until the bus is shut down; raises `can.CanError`."""
        while True:
            try:
                received = self.receive(_WAIT)
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

    async def listen(self) -> AsyncGenerator[Received, None]:
        """Messages as they arrive, for ``async for``, until the bus is shut down.

        A thread waits on the bus, one frame at a time, so that every interface works on every
        event loop. Leaving the loop ends that thread and nothing else, and no frame is lost: one
        that came in meanwhile is the next that this link returns. Raises `can.CanError`.
        """
        pending: Future[can.Message | None] | None = None
        thread = ThreadPoolExecutor(1, "swapcan-listen")
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

    def _take(self, frame: can.Message) -> Received | None:
        taken = self._receiver.take(frame)
        faults = taken.faults if isinstance(taken, Received) else (taken,) if taken else ()
        if self._on_fault:
            for fault in faults:
                self._on_fault(fault)
        return taken if isinstance(taken, Received) else None

    def _is_shut_down(self) -> bool:
        # python-can has no public name for it.
        return self._bus._is_shutdown  # noqa: SLF001
