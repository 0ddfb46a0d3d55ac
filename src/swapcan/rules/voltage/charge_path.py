"""Which main relays may be open under high voltage: where charge contactors stand in for them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST0, B2V_ST1, ChargeLine, RelayState
from typedcan.judge.chunk import Chunk
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.measure.since import last

MAIN = ("st_main_pos", "st_main_neg")
_CONTACTORS = ("st_chg_pos1", "st_chg_neg1", "st_chg_pos2", "st_chg_neg2")


class ChargePath:
    """Follows charge contactors and charging gun through one log.

    A pack may be charged over its charge contactors, with a main relay open. That relay may stay
    open until it closes again.
    """

    def __init__(self) -> None:
        # Orders of the last frames, as floats; -1: none.
        self._charged = -1.0
        self._closed = dict.fromkeys(MAIN, -1.0)

    def feed(self, chunk: Chunk) -> dict[str, NDArray[np.bool_]]:
        """For each main relay, at which frames of B2V_ST0 it may be open so.

        To be called once for each chunk.
        """
        relays = chunk.sound(B2V_ST0)
        if not len(relays):
            return {field: np.zeros(0, np.bool_) for field in MAIN}
        charges = np.logical_or.reduce(
            [relays.raw(field) == RelayState.CLOSED for field in _CONTACTORS]
        )
        charges |= LastKnown(chunk.sound(B2V_ST1), relays).is_code("chg_line", ChargeLine.CONNECTED)
        charges[: relays.first] = False
        order = relays.order.astype(np.float64)
        charged = last(relays, charges, order, self._charged)
        self._charged = float(charged[-1])
        found: dict[str, NDArray[np.bool_]] = {}
        for field in MAIN:
            is_closed = (relays.raw(field) == RelayState.CLOSED) & ~charges
            is_closed[: relays.first] = False
            closed = last(relays, is_closed, order, self._closed[field])
            self._closed[field] = float(closed[-1])
            found[field] = charged > closed
        return found
