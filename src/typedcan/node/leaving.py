"""Leaving a bus: the safe codes of what was commanded, as long as the bus takes them."""

from __future__ import annotations

import os
import threading
import time
from contextlib import suppress

from typedcan.model.errors import one_line
from typedcan.node.errors import StillActingError
from typedcan.node.port import Port
from typedcan.node.transmit import Transmitter

_TIMES = 5
"""How often the safe codes are sent: one frame can get lost."""

_BETWEEN = 0.05
"""Seconds from one time to the next: the shortest period of a message that can act."""

_TRIES = 20
"""How often that is tried on a bus that does not take them."""

_PATIENCE = 1.5
"""Seconds to wait for the tries that are made beside a thread that hangs."""


class Leaving:
    """The end of what one node has commanded; ``safe`` as `Node` has ``leave="safe"``."""

    def __init__(self, transmitter: Transmitter, port: Port, *, safe: bool) -> None:
        self._transmitter = transmitter
        self._port = port
        self._safe = safe
        self._pid: int | None = None  # of the process in which it was started
        self.failure: StillActingError | None = None
        """What is wrong where something acts all the same."""
        transmitter.ends_safe = safe

    def start(self) -> None:
        """A life begins: all may be sent."""
        self._pid = os.getpid()
        self.failure = None
        self._transmitter.sends = "all"

    @property
    def is_elsewhere(self) -> bool:
        """Whether this process is a copy of the one in which the node was started."""
        return self._pid not in (None, os.getpid())

    def begin(self) -> None:
        """From now on nothing that acts is sent."""
        if self._transmitter.sends == "all":
            self._transmitter.sends = "what does not act"

    def end(self) -> None:
        """From now on nothing is sent but safe codes."""
        self._transmitter.sends = "nothing"

    def leave(self, *, once: bool = False) -> None:
        """Send the safe codes of what acts, if anything does; with ``once`` without taking time.

        Raises nothing but what is not an `Exception`, in the main thread.
        """
        if not self._safe or self.is_elsewhere:
            return
        failure: BaseException | None = None
        taken = 0
        for _ in range(_TRIES if self._transmitter.acting else 0):
            failure = self._send()
            taken += failure is None
            if once or taken == _TIMES:
                break
            time.sleep(_BETWEEN)
        self.failure = self._still_acting(failure)
        is_main = threading.current_thread() is threading.main_thread()
        if failure and is_main and not isinstance(failure, Exception):
            raise failure

    def leave_beside(self) -> None:
        """The same where the thread that sends does not come back; this does."""
        if not self._safe or self.is_elsewhere or not self._transmitter.acting:
            return
        beside = threading.Thread(target=self.leave, name="typedcan-leave", daemon=True)
        try:
            beside.start()
        except RuntimeError:  # no thread can be started any more
            self.leave(once=True)
        else:
            beside.join(_PATIENCE)
            if beside.is_alive():
                self.failure = self._still_acting(None)

    def _send(self) -> BaseException | None:
        try:
            failure = self._transmitter.send_safe_codes()
        except BaseException as error:  # noqa: BLE001 - nothing keeps this from trying again
            return error
        if failure:
            with suppress(Exception):
                self._port.renew()
        return failure

    def _still_acting(self, failure: BaseException | None) -> StillActingError | None:
        names = [message.NAME for message in self._transmitter.acting]
        if not names:
            return None
        error = StillActingError(names, one_line(failure) if failure else "the bus hangs")
        error.__cause__ = failure
        return error
