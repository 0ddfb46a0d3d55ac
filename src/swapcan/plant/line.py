"""The high-voltage line between the pack, the truck and the charger, which is no message."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class Line:
    """What flows where all participants are simulated in one place.

    Parameters
    ----------
    load
        What the truck draws, in A: discharging is positive, regenerating negative. None where no
        truck is on this line, so that the pack has to guess from the speed it is told.
    charge
        What the charger gives, in A, never negative. None where no charger is on this line, so
        that the pack has to take what the charger says it gives.
    plugged
        Whether the charger's plug is in the truck. None where no charger is on this line, so that
        the pack has to take a charger that it hears for one that is plugged in.
    """

    load: float | None = None
    charge: float | None = None
    plugged: bool | None = None
