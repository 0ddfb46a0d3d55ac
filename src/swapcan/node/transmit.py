"""Typed messages to the bus, one frame at a time, with checksums and alive counters of a node."""

from __future__ import annotations

import threading
from collections.abc import Callable

import can

from swapcan.node.events import SendFailed
from swapcan.node.port import Port
from swapcan.wire import Codec
from typedcan.wire.acting import SentCommands
from typedcan.wire.clock import Clock
from typedcan.wire.errors import one_line
from typedcan.wire.message import Message
from typedcan.wire.protect import SendCounters

_AT_MOST = 0.5
"""Seconds to wait for a transmission of another thread before the safe codes are sent beside it."""


class Transmitter:
    """Sends the messages of one node; any thread may."""

    def __init__(
        self, port: Port, codec: Codec, clock: Clock, report: Callable[[SendFailed], None]
    ) -> None:
        self._port = port
        self._codec = codec
        self._clock = clock
        self._report = report
        self._counters = SendCounters()
        self._failing: set[type[Message]] = set()
        self._commands = SentCommands()
        # Reentrant: a signal may come in the middle of a transmission, and end the process.
        self._lock = threading.RLock()

    def check(self, message: Message) -> None:
        """Raise `EncodeError` where a message has a value that cannot be sent."""
        self._codec.encode(message)

    @property
    def acting(self) -> tuple[Message, ...]:
        """The messages that were sent last with a code that acts."""
        return self._commands.acting

    def frame(self, message: Message, *, safe: bool = False) -> can.Message:
        """The frame of a message as it would go out next; ``safe`` as `Codec.encode` has it."""
        kind = type(message)
        counter = self._counters.peek(kind)
        data = self._codec.encode(message, counter=counter, renew=True, safe=safe)
        return can.Message(
            arbitration_id=kind.FRAME_ID, is_extended_id=kind.EXTENDED, data=data, is_rx=False
        )

    def send(self, message: Message) -> None:
        """Send a message; the counter goes on once the bus has accepted the frame.

        Raises `EncodeError` and what the bus raises.
        """
        with self._lock:
            frame = self.frame(message)
            self._commands.begin(message)
            self._port.send(frame)
            self._commands.end(message)
            self._counters.advance(type(message))
        self._failing.discard(type(message))

    def send_safe_codes(self) -> Exception | None:
        """Send each message that can act and was sent, with its safe codes.

        Returns what the first one raised that could not be sent; the others are sent all the same.
        """
        failure: Exception | None = None
        # A thread that hangs in the bus must not keep the others from trying.
        held = self._lock.acquire(timeout=_AT_MOST)
        try:
            for message in self._commands.all:
                try:
                    self._send_safe(message)
                except Exception as error:  # noqa: BLE001 - whatever a bus or an algorithm raises
                    failure = failure or error
        finally:
            if held:
                self._lock.release()
        return failure

    def _send_safe(self, message: Message) -> None:
        self._port.send(self.frame(message, safe=True))
        self._commands.made_safe(message)
        self._counters.advance(type(message))

    def try_to_send(self, message: Message) -> None:
        """Send a message, or report that it cannot be sent, once until it can."""
        try:
            self.send(message)
        except Exception as error:  # noqa: BLE001 - whatever a bus or an algorithm raises
            self.failed(type(message), error)

    def failed(self, kind: type[Message], error: Exception) -> None:
        """Report that a message cannot be sent, unless that is known."""
        if kind not in self._failing:
            self._failing.add(kind)
            self._report(SendFailed(kind, one_line(error), self._clock.now()))
