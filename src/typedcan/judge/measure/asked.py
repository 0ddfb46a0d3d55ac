"""When messages that are sent on request are asked for, or no more."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.decoded import DecodedChunk
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Request


def requests_of(protocol: Protocol) -> dict[type[Message], Request]:
    """What asks for each message that is sent on request."""
    return {message: request for request in protocol.requests for message in request.answers}


class Asked:
    """Follows the requests of one log."""

    def __init__(self, protocol: Protocol) -> None:
        self._requests = requests_of(protocol)
        self._last: dict[str, int] = {}

    def changes(self, chunk: DecodedChunk, message: type[Message]) -> NDArray[np.int64]:
        """Where in the log its request changed, ascending: the last time before, and here."""
        field = self._requests[message].field
        series = chunk.sound(field.message)
        raw = series.raw(field.field)
        rows = np.flatnonzero(raw[1:] != raw[:-1]) + 1
        if series.fresh and not series.first:
            rows = np.concatenate([[0], rows])  # the first of all
        changes = np.concatenate([[self._last.get(message.NAME, -1)], series.order[rows]])
        self._last[message.NAME] = int(changes[-1])
        return changes
