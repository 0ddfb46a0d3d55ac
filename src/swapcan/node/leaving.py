"""Leaving a bus: the safe codes of what was commanded, as long as the bus takes them."""

from __future__ import annotations

import time

from swapcan.node.transmit import Transmitter
from typedcan.wire.errors import StillActingError, one_line

_TIMES = 5
"""How often the safe codes are sent: one frame can get lost."""

_BETWEEN = 0.05
"""Seconds from one time to the next: the shortest period of a message that can act."""

_TRIES = 20
"""How often that is tried on a bus that does not take them."""


def leave_safe(transmitter: Transmitter, *, once: bool) -> StillActingError | None:
    """End what acts, if anything does; what is wrong where that could not be done.

    Parameters
    ----------
    once
        Send them once, and take no time for it.
    """
    failure: Exception | None = None
    taken = 0
    for _ in range(_TRIES if transmitter.acting else 0):
        failure = transmitter.send_safe_codes()
        taken += failure is None
        if once or taken == _TIMES:
            break
        time.sleep(_BETWEEN)
    names = [message.NAME for message in transmitter.acting]
    return StillActingError(names, one_line(failure) if failure else "no answer") if names else None
