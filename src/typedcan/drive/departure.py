"""What is a protocol's own in leaving a bus: who lives on, and how all is told to be off."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from typedcan.simulate.participant import Participant


@dataclass(frozen=True, slots=True, kw_only=True)
class Departure:
    """How simulated nodes leave those who act on what they have commanded.

    Each callable is tried whatever becomes of the others. It is made before anything acts, so that
    nothing can go wrong in making it once something does.

    Parameters
    ----------
    heal
        What ends faults that keep safe codes back, or spoil them; is called first.
    withdraw
        What has participants command by themselves what is safe, and forgets reports that prove
        nothing; is called once the safe codes were sent.
    live_on
        Participants who live on meanwhile, since they have been told by ``withdraw``.
    stand_still
        Participants who would command again what their state asks for: they do not live on, and
        their safe codes are repeated for a while.
    are_off
        Whether those who act have reported that they are off, since the last code that acts.
        Without it nobody can tell: leaving takes as long as it may, and does not count as safe.
    """

    heal: Sequence[Callable[[], object]] = ()
    withdraw: Sequence[Callable[[], object]] = ()
    live_on: Sequence[Participant] = ()
    stand_still: Sequence[Participant] = ()
    are_off: Callable[[], bool] = lambda: False
