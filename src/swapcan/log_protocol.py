"""The protocol of this standard as `swapcan.logs` takes it."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from typedcan.logs.protocol import known

OWN = known(PROTOCOL.model)
"""All that is known of it; its tables of readings are called ``cells`` and ``probes``."""

CELLS, PROBES = OWN.readings
"""Cell voltages, and probe temperatures."""
