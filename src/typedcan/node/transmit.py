"""Typed messages to the bus, one frame at a time, with checksums and alive counters of a node."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Literal

import can

from typedcan.model.errors import one_line
from typedcan.node.clock import Clock
from typedcan.node.commanded import SentCommands
from typedcan.node.events import SendFailed
from typedcan.node.port import Port
from typedcan.wire.acting import acts
from typedcan.wire.codec import Codec
from typedcan.wire.errors import SendingError
from typedcan.wire.message import Message
from typedcan.wire.protect import SendCounters

Sends = Literal["all", "what does not act", "nothing"]
"""What is sent; the safe codes of what acts always are."""

_AT_MOST = 0.5
"""Seconds to wait for a transmission of another thread before the safe codes are sent beside it."""


class Transmitter:
    """Sends the messages of one node; any thread may."""

    def __init__(
        self,
        port: Port,
        codec: Codec,
        clock: Clock,
        report: Callable[[SendFailed], None],
        source_address: int,
    ) -> None:
        self._port = port
        self._codec = codec
        self._source_address = source_address
        self._clock = clock
        self._report = report
        self._counters = SendCounters()
        self._failing: set[type[Message]] = set()
        self._commands = SentCommands()
        self._under_way: Message | None = None
        self._under_way_in: int | None = None
        self._hangs = False
        self.sends: Sends = "all"
        """Once this is less, it is less for every transmission that has not begun yet."""
        self.ends_safe = True
        """Whether what acts gets its safe codes where it went out after it was to."""
        # Reentrant: a signal may come in the middle of a transmission, and end the process.
        self._lock = threading.RLock()

    def check(self, message: Message) -> None:
        """Raise `EncodeError` or `SendingError` where a message cannot be sent."""
        self._codec.frame(message)

    @property
    def acting(self) -> tuple[Message, ...]:
        """The messages that were sent last with a code that acts."""
        acting = self._commands.acting
        hanging = self._under_way
        if hanging is None or type(hanging) in map(type, acting) or not acts(hanging):
            return acting
        return (*acting, hanging)  # its safe codes may have overtaken it

    @property
    def is_sending_here(self) -> bool:
        """Whether the thread that asks is in the middle of a transmission."""
        return self._under_way_in == threading.get_ident()

    def frame(self, message: Message, *, safe: bool = False) -> can.Message:
        """The frame of a message as it would go out next; ``safe`` as `Codec.encode` has it."""
        return self._codec.frame(
            message,
            counter=self._counters.peek(type(message)),
            safe=safe,
            source_address=self._source_address,
        )

    def send(self, message: Message) -> None:
        """Send a message; the counter goes on once the bus has accepted the frame.

        Raises `EncodeError`, what the bus raises, and `SendingError` for what is sent no more.
        """
        with self._lock:
            self._hangs = False
            if self._refuses(message):
                raise SendingError(f"{message.NAME}: the node is being left, it is sent no more")
            frame = self.frame(message)
            self._commands.begin(message)
            self._under_way, self._under_way_in = message, threading.get_ident()
            try:
                self._port.send(frame)
            except BaseException:
                self._commands.begin(message)  # as far as is known it is on the bus
                raise
            else:
                self._commands.end(message)
                self._counters.advance(type(message))
            finally:
                self._under_way = self._under_way_in = None
                if self.ends_safe and self.acting and self._refuses(message):
                    # The node was left while this was under way: it is left again, if it can be.
                    self.send_safe_codes(settle=False)
        self._failing.discard(type(message))

    def send_safe_codes(self, *, settle: bool = True) -> Exception | None:
        """Send each message that can act and was sent, with its safe codes.

        With ``settle`` what has gone out so counts as acting no more.
        Returns what the first one raised that could not be sent; the others are sent all the same,
        also before `KeyboardInterrupt` and its like are raised again.
        """
        failure: BaseException | None = None
        # A thread that hangs in the bus must not keep the others from trying, and not each time.
        held = self._lock.acquire(timeout=0 if self._hangs else _AT_MOST)
        self._hangs = not held
        try:
            for message in self._commands.all:
                try:
                    self._port.send(self.frame(message, safe=True))
                    self._counters.advance(type(message))
                    if settle:
                        self._commands.made_safe(message)
                except BaseException as error:  # noqa: BLE001 - the others have to be tried
                    failure = failure or error
        finally:
            if held:
                self._lock.release()
        if failure is None or isinstance(failure, Exception):
            return failure
        raise failure

    def try_to_send(self, message: Message) -> None:
        """Send a message, or report that it cannot be sent, once until it can."""
        try:
            if not self._refuses(message):
                self.send(message)
        except Exception as error:  # noqa: BLE001 - whatever a bus or an algorithm raises
            self.failed(type(message), error)

    def failed(self, kind: type[Message], error: Exception) -> bool:
        """Report that a message cannot be sent, unless that is known; whether it was news."""
        if kind in self._failing:
            return False
        self._failing.add(kind)
        self._report(SendFailed(kind, one_line(error), self._clock.now()))
        return True

    def _refuses(self, message: Message) -> bool:
        if self.sends == "what does not act":
            return acts(message)
        return self.sends == "nothing"
