"""What comes in and what the passing of time changes, told to those who want to know."""

from __future__ import annotations

import logging
import math
import time
from collections import deque

import can

from typedcan.model.errors import one_line
from typedcan.node.clock import Clock
from typedcan.node.events import BusBack, BusLost, Dispatcher, ReceiveFailed, SendFailed
from typedcan.node.inbox import Inbox
from typedcan.node.life import Life
from typedcan.node.port import Port
from typedcan.node.request import Requests

Notice = BusLost | BusBack | SendFailed | ReceiveFailed
"""What is noticed in any thread, and told in the one that receives."""

_LOG = logging.getLogger("typedcan")

_WAIT = 0.1
"""Seconds in one call of the bus: as long as a node takes to stop, and to notice a new request."""

_HANGING = 0.5
"""Seconds without a return of the bus, or of a callback, that count as hanging."""

_STEP = 0.02
"""Seconds from one look to the next of the one that stands in."""

_PAUSE = 0.001
"""Seconds after a bus that did not wait for a frame as it was asked to."""


class Reception:
    """Takes what arrives at one node, and lets time pass for it."""

    def __init__(
        self,
        port: Port,
        inbox: Inbox,
        requests: Requests,
        dispatcher: Dispatcher,
        notices: deque[Notice],
        clock: Clock,
    ) -> None:
        self._port = port
        self._inbox = inbox
        self._requests = requests
        self._dispatcher = dispatcher
        self._notices = notices
        self._clock = clock
        self._came_round = clock.now()  # when the thread that receives was last done with a frame
        self._failing: set[int] = set()

    def start(self) -> None:
        """A life begins."""
        self._notices.clear()
        self._failing.clear()
        self._came_round = now = self._clock.now()
        self._inbox.start(now)

    @property
    def next_check(self) -> float:
        """When time alone changes something; `math.inf` for never."""
        return min(self._inbox.next_check, self._requests.next_check, self._port.retry_at)

    @property
    def hangs(self) -> bool:
        """Whether the thread that receives does not come back from the bus, or from a callback."""
        return self._clock.now() - self._came_round >= _HANGING

    def turn(self) -> None:
        """Take what has arrived, and let time pass up to the clock's."""
        while frame := self._port.receive(0):
            self._take(frame, self._clock.now())
        self._check(self._clock.now())

    def run(self, life: Life) -> None:
        """Take what arrives, until it is over."""
        # What is done for every frame is kept short; what else is due is looked for now and then.
        receive, take, clock = self._port.receive, self._take, self._clock.now
        now = due = clock()
        while not life.is_over:
            frame = receive(due - now if due > now else 0)
            self._came_round = now = clock()
            changed = frame is not None and take(frame, now)
            if changed or frame is None or now >= due:
                did_not_wait = frame is None and now < due
                self._check(now)
                self.tell_notices()
                due = min(self.next_check, now + _WAIT)
                if self._port.retry_at < math.inf:  # until then receiving returns at once
                    time.sleep(max(due - now, 0))
                elif did_not_wait:
                    time.sleep(_PAUSE)

    def stand_in(self, life: Life) -> None:
        """Let time pass until the thread that receives is back."""
        while self.hangs and not life.is_over:
            self.let_time_pass()
            time.sleep(_STEP)

    def let_time_pass(self) -> None:
        """Tell what time alone has changed, and what was noticed in other threads."""
        self._check(self._clock.now())
        self.tell_notices()

    def tell_notices(self) -> None:
        """Tell what was noticed in other threads."""
        while self._notices:
            try:
                notice = self._notices.popleft()
            except IndexError:  # another thread has told the last one
                return
            self._dispatcher.emit(notice)

    def _take(self, frame: can.Message, now: float) -> bool:
        """Take a frame; True where that may change when there is something to do."""
        try:
            changed = self._inbox.take(frame, now)
        except Exception as error:  # noqa: BLE001 - such as that of a user's checksum
            frame_id = getattr(frame, "arbitration_id", 0)
            if frame_id not in self._failing:
                self._failing.add(frame_id)
                self._notices.append(ReceiveFailed(frame_id, one_line(error), now))
                _LOG.exception("a frame could not be handled; the node goes on")
            return True
        if self._failing:
            self._failing.discard(frame.arbitration_id)
        return changed

    def _check(self, now: float) -> None:
        if now >= self._inbox.next_check:
            self._inbox.check(now)
        if now >= self._requests.next_check:
            self._requests.check(now)
