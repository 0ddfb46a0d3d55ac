"""Leaving a bus: the safe codes of what was commanded, as long as the bus takes them."""

from __future__ import annotations

import logging
import os
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial

from typedcan.model.errors import one_line
from typedcan.node.errors import StillActingError
from typedcan.node.port import Port
from typedcan.node.transmit import Transmitter
from typedcan.wire.message import Message

_LOG = logging.getLogger("typedcan")

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
        failure = send_until_taken([self._send] if self._transmitter.acting else [], once=once)
        self.failure = still_acting(self._transmitter.acting, failure)
        raise_what_ends_more(failure)

    def leave_beside(self) -> None:
        """The same where the thread that sends does not come back; this does."""
        if not self._safe or self.is_elsewhere or not self._transmitter.acting:
            return
        if not done_beside(self.leave, partial(self.leave, once=True)):
            self.failure = still_acting(self._transmitter.acting, None)

    def _send(self) -> BaseException | None:
        failure = self._transmitter.send_safe_codes()
        if failure:
            with suppress(Exception):
                self._port.renew()
        return failure


def send_until_taken(
    senders: Sequence[Callable[[], BaseException | None]], *, once: bool = False
) -> BaseException | None:
    """Have safe codes sent by turns, several times, as long as a bus takes them or may yet.

    Parameters
    ----------
    senders
        Each sends what it has to, and returns what the bus has raised, or raises.
    once
        Takes no time.

    Returns what failed in the last turn, or has broken into them.
    """
    failure: BaseException | None = None
    broken_into: BaseException | None = None
    taken = 0
    for _ in range(_TRIES if senders else 0):
        failures = [_tried(send) for send in senders]
        failure = next(filter(None, failures), None)
        taken += failure is None
        if once or taken == _TIMES:
            break
        broken_into = _tried(partial(time.sleep, _BETWEEN)) or broken_into
    return failure or broken_into


def done_beside(action: Callable[[], object], instead: Callable[[], object]) -> bool:
    """Do something in a thread that may hang, or else ``instead`` here; whether it has ended."""
    beside = threading.Thread(target=action, name="typedcan-leave", daemon=True)
    try:
        beside.start()
    except RuntimeError:  # no thread can be started any more
        instead()
        return True
    beside.join(_PATIENCE)
    return not beside.is_alive()


def _tried(action: Callable[[], BaseException | None]) -> BaseException | None:
    try:
        return action()
    except BaseException as error:  # noqa: BLE001 - nothing keeps this from trying again
        return error


def still_acting(
    messages: Sequence[Message], failure: BaseException | None
) -> StillActingError | None:
    """What is wrong where messages act all the same; None where there are none."""
    if not messages:
        return None
    names = [message.NAME for message in messages]
    error = StillActingError(names, one_line(failure) if failure else "the bus hangs")
    error.__cause__ = failure
    return error


def raise_what_ends_more(failure: BaseException | None) -> None:
    """In the main thread raise what is not an `Exception`, such as `KeyboardInterrupt`."""
    is_main = threading.current_thread() is threading.main_thread()
    if failure and is_main and not isinstance(failure, Exception):
        raise failure


def raise_or_note(who: str, failure: BaseException, error: BaseException | None) -> None:
    """Raise what is wrong with leaving, or tell it beside the error that a block was left with."""
    if error is None:
        raise failure
    text = f"{who}: {one_line(failure)}"
    error.add_note(text)
    _LOG.error("%s", text)
