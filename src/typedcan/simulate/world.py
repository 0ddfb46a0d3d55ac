"""Participants and their time: simulated, as fast as it goes, or real."""

from __future__ import annotations

import heapq
import itertools
import math
import threading
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Self

from typedcan.node.clock import Clock, SimulatedClock, SystemClock
from typedcan.node.errors import StillActingError
from typedcan.node.leaving import (
    done_beside,
    raise_or_note,
    raise_what_ends_more,
    send_until_taken,
    still_acting,
)
from typedcan.shell.process_signals import LAST_WORDS
from typedcan.simulate.participant import Participant
from typedcan.simulate.simulated_bus import SimulatedWire
from typedcan.wire.errors import SendingError
from typedcan.wire.message import Message

STEP = 0.01
"""Seconds from one step of the participants to the next."""

_PATIENCE = 1.5
"""Seconds to wait for the thread to end; one that hangs in a driver never does."""

_STOPPED = "the world has been stopped by a signal, it sends nothing more"


class World:
    """Lets participants live, all in one thread.

    `run` lets time pass: on a `SimulatedClock` it jumps from one moment at which something is due
    to the next, otherwise it sleeps in between. ``with world:`` lets them live in a thread of
    their own, until the block is left; on a simulated clock as fast as it goes, in real time with
    the safe codes of what acts in the end. Neither closes a bus.

    Parameters
    ----------
    participants
        Who is there.
    clock
        The clock of all their nodes; the system's where none is given.
    wires
        The simulated wires between them: what arrives on these is received before time goes on.
    """

    def __init__(
        self,
        *participants: Participant,
        clock: Clock | None = None,
        wires: Sequence[SimulatedWire] = (),
    ) -> None:
        self.participants = participants
        self.clock = clock or SystemClock()
        self._nodes = [node for participant in participants for node in participant.nodes]
        self._due = [-math.inf] * len(self._nodes)
        self._heard = [-1] * len(self._nodes)  # frames that were carried at a node's last turn
        self._wires = tuple(wires)
        self._actions: list[tuple[float, int, Callable[[], object]]] = []
        self._number = itertools.count()
        self._watchers: list[Callable[[], object]] = []
        self._began: float | None = None
        self._steps = 0
        self._stop = threading.Event()
        self._is_over = False
        self._thread: threading.Thread | None = None
        self._failure: BaseException | None = None
        self._runs_in: int | None = None  # the thread that is in `run`

    @property
    def elapsed(self) -> float:
        """Seconds since it began to live."""
        return 0.0 if self._began is None else self.clock.now() - self._began

    def at(self, time: float, action: Callable[[], object]) -> None:
        """Have something done when so many seconds have passed since it began to live.

        At once, where they have passed already. Any thread may say so: it is how to tell
        participants something while the world lives in a thread of its own.
        """
        heapq.heappush(self._actions, (time, next(self._number), action))

    def after_each_step(self, watcher: Callable[[], object]) -> None:
        """Have something done after each step of the participants."""
        self._watchers.append(watcher)

    def run(self, seconds: float) -> None:
        """Let so many seconds pass; `math.inf` for ever.

        Raises `RuntimeError` while it lives in a thread of its own, and in real time `SendingError`
        once a signal such as Ctrl-Z has stopped it; the safe codes of what acts were sent before.
        """
        if self._thread:
            raise RuntimeError("the world is running already, in a thread of its own")
        if isinstance(self.clock, SimulatedClock):
            self._live(seconds)
            return
        if self._is_over:
            raise SendingError(_STOPPED)
        LAST_WORDS.add(self)
        self._runs_in = threading.get_ident()
        try:
            self._live(seconds)
            if self._is_over:
                raise SendingError(_STOPPED)
        finally:
            self._runs_in = None
            LAST_WORDS.discard(self)

    def speak_last(self) -> None:
        """Before a signal ends or stops the process: nothing acts any more."""
        self._is_over = True  # the lock of an event may be held by what the signal interrupted
        # What the signal interrupted may keep what `go_on` raises, and end its turn.
        for node in self._nodes:
            node.sends = "what does not act"
        if self._thread:
            self._thread.join(_PATIENCE)
        self.leave()

    def go_on(self) -> None:
        """After a signal that only stopped the process: what it interrupted sends nothing."""
        if self._runs_in == threading.get_ident():
            raise SendingError(_STOPPED)

    def __enter__(self) -> Self:
        self._stop.clear()
        self._is_over = False
        for node in self._nodes:
            node.sends = "all"
        self._thread = threading.Thread(target=self._live_apart, name="typedcan-world", daemon=True)
        if not isinstance(self.clock, SimulatedClock):
            LAST_WORDS.add(self)
        self._thread.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._stop.set()
        try:
            live = self._leave_after(self._thread)
        finally:
            self._thread = None
            LAST_WORDS.discard(self)
        failure, self._failure = self._failure, None
        if live:
            live.__cause__, failure = failure or live.__cause__, live
        if failure:
            raise_or_note("the world", failure, error)

    def leave(self) -> StillActingError | None:
        """In real time send the safe codes of what acts, several times: a frame can get lost.

        Returns what is wrong where something acts all the same.
        """
        nodes = [node for node in self._nodes if node.acting] if self._acting else []
        failure = send_until_taken([node.send_safe_codes for node in nodes])
        raise_what_ends_more(failure)
        return still_acting(self._acting, failure)

    def _leave_after(self, thread: threading.Thread | None) -> StillActingError | None:
        """Leave once a thread has ended, or beside it where it hangs, in a driver for example."""
        if thread:
            thread.join(_PATIENCE)
            if thread.is_alive():
                done_beside(self.leave, self.leave)
                return still_acting(self._acting, None)
        return self.leave()

    @property
    def _acting(self) -> list[Message]:
        simulated = isinstance(self.clock, SimulatedClock)
        return [] if simulated else [each for node in self._nodes for each in node.acting]

    def _live_apart(self) -> None:
        try:
            self._live(math.inf)
        except BaseException as failure:  # noqa: BLE001  (is raised where the world is left)
            self._failure = failure
            self.leave()

    def _live(self, seconds: float) -> None:
        now = self.clock.now()
        if self._began is None:
            self._began = now
        end = now + seconds
        while True:
            self._turn()
            now = self.clock.now()
            if now >= end or self._is_over or self._stop.is_set():
                return
            self._wait(min(self._next_moment(now), end))

    def _turn(self) -> None:
        """Do what is due: actions, a step of the participants, and what their nodes have to do."""
        now = self.clock.now()
        acted = False
        while self._actions and self._moment(self._actions[0][0]) <= now:
            heapq.heappop(self._actions)[2]()
            acted = True
        if self._next_step <= now:
            for participant in self.participants:
                participant.step(now)
            for watcher in self._watchers:
                watcher()
            # Steps that were missed are not made up for: each takes what time has passed.
            self._steps = math.floor((now - self._moment(0)) / STEP + 1e-6) + 1
            acted = True
        if acted:
            self._due = [node.next_due for node in self._nodes]
        self._turn_nodes(now, everyone=not self._wires)

    def _turn_nodes(self, now: float, *, everyone: bool) -> None:
        """Let nodes take and send what there is, until the wires are quiet."""
        while True:
            before = self._carried
            for number, node in enumerate(self._nodes):
                # A turn costs time even where there is nothing to do.
                news = self._carried != self._heard[number]
                if everyone or news or self._due[number] <= now:
                    node.turn()
                    self._due[number] = node.next_due
                    self._heard[number] = self._carried
            if self._carried == before:
                return
            everyone = False

    @property
    def _next_step(self) -> float:
        return self._moment(self._steps * STEP)

    @property
    def _carried(self) -> int:
        return sum(wire.carried for wire in self._wires)

    def _moment(self, elapsed: float) -> float:
        """The time of the clock when so much time has passed since the beginning."""
        return (self._began or 0.0) + elapsed

    def _next_moment(self, now: float) -> float:
        """When there is something to do next, later than now."""
        moment = min((self._next_step, *self._due))
        if self._actions:
            moment = min(moment, self._moment(self._actions[0][0]))
        return moment if moment > now else self._next_step

    def _wait(self, moment: float) -> None:
        if isinstance(self.clock, SimulatedClock):
            self.clock.advance_to(moment)
        else:
            self._stop.wait(max(0.0, moment - self.clock.now()))
