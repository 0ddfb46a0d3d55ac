"""The relays between a pack and its charger: closed once both have the same voltage."""

from __future__ import annotations

from enum import Enum, auto

from swapcan.plant.high_voltage import CURRENT_GONE, UNLOADING_LIMIT
from swapcan.plant.relays import Relay, Relays


class _Phase(Enum):
    OPEN = auto()
    NEGATIVE = auto()
    MATCHING = auto()
    POSITIVE = auto()
    CLOSED = auto()
    UNLOADING = auto()


class ChargePath:
    """Charge negative, then charge positive once the voltages match; back the other way.

    ``failed`` holds from a relay that did not close until charging is no longer wanted.
    """

    def __init__(self, relays: Relays) -> None:
        self.relays = relays
        self.failed = False
        self._phase = _Phase.OPEN
        self._since = 0.0

    @property
    def is_closed(self) -> bool:
        """Whether current may flow."""
        return self._phase is _Phase.CLOSED

    @property
    def is_open(self) -> bool:
        """Whether both relays are at rest and told to be open."""
        return self._phase is _Phase.OPEN

    def step(self, now: float, *, wanted: bool, matched: bool, current: float) -> None:
        """Go on to a time in seconds; `Relays.advance` has been there before.

        ``matched`` says that the charger's voltage is near the battery's, ``current`` is what it
        gives, in A.
        """
        self.failed = self.failed and wanted
        if self._phase is _Phase.UNLOADING:
            if abs(current) < CURRENT_GONE or now - self._since >= UNLOADING_LIMIT:
                self._open(now)
        elif self._phase is not _Phase.OPEN and not wanted:
            self._go(_Phase.UNLOADING, now)
        elif self.relays.settled:
            self._close(now, wanted=wanted, matched=matched)

    def _close(self, now: float, *, wanted: bool, matched: bool) -> None:
        """The next step towards closed; no relay is switching."""
        match self._phase:
            case _Phase.OPEN if wanted and not self.failed and not self.relays.weld_faults:
                self._switch(Relay.CHARGE_NEGATIVE, now, _Phase.NEGATIVE)
            case _Phase.NEGATIVE if self._went(Relay.CHARGE_NEGATIVE, now):
                self._go(_Phase.MATCHING, now)
            case _Phase.MATCHING if matched:
                self._switch(Relay.CHARGE_POSITIVE, now, _Phase.POSITIVE)
            case _Phase.POSITIVE if self._went(Relay.CHARGE_POSITIVE, now):
                self._go(_Phase.CLOSED, now)
            case _:
                pass

    def _went(self, relay: Relay, now: float) -> bool:
        if self.relays.is_closed(relay):
            return True
        self.failed = True
        self._go(_Phase.UNLOADING, now)
        return False

    def _open(self, now: float) -> None:
        if not self.relays.settled:
            return
        for relay in (Relay.CHARGE_POSITIVE, Relay.CHARGE_NEGATIVE):
            if self.relays.is_commanded(relay):
                self.relays.command(relay, closed=False, now=now)
                return
        self._go(_Phase.OPEN, now)

    def _switch(self, relay: Relay, now: float, phase: _Phase) -> None:
        self.relays.command(relay, closed=True, now=now)
        self._go(phase, now)

    def _go(self, phase: _Phase, now: float) -> None:
        self._phase = phase
        self._since = now
