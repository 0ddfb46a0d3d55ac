"""Which frames that arrive are one's own: some interfaces give back what was sent on them."""

from __future__ import annotations

from collections import defaultdict, deque

import can

_WITHIN = 5.0
"""Seconds in which an interface gives back what was sent, to a process that may be held up.

Later the same bytes are another's."""

_AT_ONCE = 0.5
"""Seconds after which it is plain, on a bus that is heard to its end, that nothing comes back."""

Identifier = tuple[int, bool]
"""The number of a frame, and whether it has 29 bits."""

_Key = tuple[Identifier, bytes]


class Echoes:
    """What was sent and may come back; any thread may add to it.

    An interface gives back all or nothing. Where the first frames do not come back none will, and
    the same bytes are those of another who sends the same.
    """

    def __init__(self) -> None:
        self._sent: defaultdict[_Key, deque[float]] = defaultdict(deque)
        self._first: float | None = None
        self._come: bool | None = None

    def sent(self, frame: can.Message, now: float) -> None:
        """A frame was sent."""
        if self._come is not False:
            self._sent[_key(frame)].append(now)
            self._first = now if self._first is None else self._first

    def is_one(self, frame: can.Message, now: float) -> bool:
        """Whether a frame that has arrived is one's own."""
        # Not by is_rx: SocketCAN denies it to what other programs of this machine send.
        if self._come is False:
            return False
        sent = self._sent.get(_key(frame), deque[float]())
        while sent and sent[0] < now - _WITHIN:
            sent.popleft()
        if not sent:
            return False
        sent.popleft()
        self._come = True
        return True

    def heard_all(self, now: float) -> None:
        """Nothing more waits to be read."""
        if self._come is None and self._first is not None and now - self._first > _AT_ONCE:
            self._come = False
            self._sent.clear()


def identifier_of(frame: can.Message) -> Identifier:
    """By what it is known which message is in a frame: one number in both widths is two."""
    return frame.arbitration_id, frame.is_extended_id


def _key(frame: can.Message) -> _Key:
    return identifier_of(frame), bytes(frame.data)
