"""Typed messages to the bus, one frame at a time, with checksums and alive counters of a node."""

from __future__ import annotations

import threading
from collections.abc import Callable

import can

from swapcan.clock import Clock
from swapcan.codec import Codec
from swapcan.errors import EncodeError
from swapcan.message import Message
from swapcan.node.events import SendFailed
from swapcan.node.port import TROUBLE, Port
from swapcan.protect import SendCounters


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
        self._lock = threading.Lock()

    def check(self, message: Message) -> None:
        """Raise `EncodeError` where a message has a value that cannot be sent."""
        self._codec.encode(message)

    def frame(self, message: Message) -> can.Message:
        """The frame of a message as it would go out next."""
        kind = type(message)
        data = self._codec.encode(message, counter=self._counters.peek(kind), renew=True)
        return can.Message(
            arbitration_id=kind.FRAME_ID, is_extended_id=True, data=data, is_rx=False
        )

    def send(self, message: Message) -> None:
        """Send a message; the counter goes on once the bus has accepted the frame.

        Raises `EncodeError` and what the bus raises.
        """
        with self._lock:
            self._port.send(self.frame(message))
            self._counters.advance(type(message))
        self._failing.discard(type(message))

    def try_to_send(self, message: Message) -> None:
        """Send a message, or report that it cannot be sent, once until it can."""
        try:
            self.send(message)
        except (EncodeError, *TROUBLE) as error:
            self.failed(type(message), error)

    def failed(self, kind: type[Message], error: Exception) -> None:
        """Report that a message cannot be sent, unless that is known."""
        if kind not in self._failing:
            self._failing.add(kind)
            text = " ".join(str(error).split()) or type(error).__name__
            self._report(SendFailed(kind, text, self._clock.now()))
