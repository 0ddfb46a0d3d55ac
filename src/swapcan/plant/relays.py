"""The relays of a simulated pack: they take time, may stick, and never switch two at a time."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

SWITCHING_TIME = 0.02
"""Seconds from the command to the contact."""

_FEEDBACK_TIME = 0.1
"""Seconds after which a contact that has not followed its command is given up."""


class Relay(Enum):
    """The relays between the battery and what is connected to it."""

    MAIN_POSITIVE = "main positive"
    MAIN_NEGATIVE = "main negative"
    PRECHARGE = "precharge"
    CHARGE_POSITIVE = "charge positive 1"
    CHARGE_NEGATIVE = "charge negative 1"
    ACCESSORY = "accessory"

    def __str__(self) -> str:
        return self.value


@dataclass(frozen=True, slots=True)
class RelayChange:
    """A contact that closed or opened, and when, in seconds."""

    at: float
    relay: Relay
    closed: bool

    def __str__(self) -> str:
        return f"{self.at:.3f} s: {self.relay} {'closes' if self.closed else 'opens'}"


class Relays:
    """Coils and contacts, which need not agree.

    ``stuck_closed`` and ``stuck_open`` are the relays whose contacts do not open, or close, any
    more; ``weld_faults`` and ``open_faults`` those that were found out. What the main positive
    relay does is proven by the voltage behind it, so its weld is for others to find.
    ``changes`` are the last thousand changes of contacts, ``on_change`` is called at each.
    """

    def __init__(self, on_change: Callable[[RelayChange], None] | None = None) -> None:
        self.on_change = on_change
        self.changes: deque[RelayChange] = deque(maxlen=1000)
        self.stuck_closed: set[Relay] = set()
        self.stuck_open: set[Relay] = set()
        self.weld_faults: set[Relay] = set()
        self.open_faults: set[Relay] = set()
        self._coils: set[Relay] = set()
        self._contacts: set[Relay] = set()
        self._since = -math.inf
        self._moving: Relay | None = None

    def is_closed(self, relay: Relay) -> bool:
        """Whether the contact is closed."""
        return relay in self._contacts

    def is_commanded(self, relay: Relay) -> bool:
        """Whether the relay is told to be closed."""
        return relay in self._coils

    @property
    def closed(self) -> frozenset[Relay]:
        """The relays whose contacts are closed."""
        return frozenset(self._contacts)

    @property
    def settled(self) -> bool:
        """Whether the last command is done, or given up."""
        return self._moving is None

    def command(self, relay: Relay, *, closed: bool, now: float) -> None:
        """Tell a relay to close or open; raises `RuntimeError` while another one is switching."""
        if self._moving:
            raise RuntimeError(f"{relay} cannot switch while {self._moving} does")
        if closed:
            self._coils.add(relay)
        else:
            self._coils.discard(relay)
        self._since = now
        self._moving = relay

    def advance(self, now: float) -> None:
        """Let the contacts follow; note the faults of those that do not."""
        if self._moving and now >= self._since + SWITCHING_TIME - 1e-9:
            self._follow(self._moving, now)
            self._judge(self._moving, now)
        elif self._moving is None and self._contacts != self._coils:
            # A contact that was stuck comes loose.
            for relay in Relay:
                if relay not in self._coils:
                    self._follow(relay, now)

    def _follow(self, relay: Relay, now: float) -> None:
        closed = relay in self._coils
        stuck = self.stuck_open if closed else self.stuck_closed
        if closed == (relay in self._contacts) or relay in stuck:
            return
        if closed:
            self._contacts.add(relay)
        else:
            self._contacts.discard(relay)
            if relay is not Relay.MAIN_POSITIVE:
                self.weld_faults.discard(relay)
        change = RelayChange(now, relay, closed)
        self.changes.append(change)
        if self.on_change:
            self.on_change(change)

    def _judge(self, relay: Relay, now: float) -> None:
        closed = relay in self._coils
        if closed == (relay in self._contacts):
            if closed:
                self.open_faults.discard(relay)
            self._moving = None
        elif now >= self._since + _FEEDBACK_TIME:
            if closed:
                self.open_faults.add(relay)
            elif relay is not Relay.MAIN_POSITIVE:
                self.weld_faults.add(relay)
            self._moving = None
