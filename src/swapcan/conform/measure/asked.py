"""When messages that are sent on request are asked for, or no more."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from typedcan.wire.message import Message
from typedcan.wire.protocol import Request

REQUESTS: Mapping[type[Message], Request] = {
    message: request for request in PROTOCOL.requests for message in request.answers
}
"""What asks for each message that is sent on request."""


class Asked:
    """Follows the requests of one log."""

    def __init__(self) -> None:
        self._last: dict[str, int] = {}

    def changes(self, chunk: Chunk, message: type[Message]) -> NDArray[np.int64]:
        """Where in the log its request changed, ascending: the last time before, and here."""
        field = REQUESTS[message].field
        series = chunk.sound(field.message)
        raw = series.raw(field.field)
        rows = np.flatnonzero(raw[1:] != raw[:-1]) + 1
        if series.fresh and not series.first:
            rows = np.concatenate([[0], rows])  # the first of all
        changes = np.concatenate([[self._last.get(message.NAME, -1)], series.order[rows]])
        self._last[message.NAME] = int(changes[-1])
        return changes
