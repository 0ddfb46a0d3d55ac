"""What the nodes of the demo have in common: links, periods, and a turn each."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping

from swapcan.bus import Link, Received
from swapcan.errors import ReceiveTimeoutError
from swapcan.message import Message

Maker = Callable[[], Iterable[Message]]
"""Makes the frames that a message has in one cycle."""


class Node:
    """A node that sends its messages at their periods and reacts to those of others.

    Times are seconds since the start.
    """

    def __init__(self, link: Link) -> None:
        self.link = link
        self.now = 0.0
        self._makers = self.makers()
        self._due: dict[type[Message], float] = {}

    def makers(self) -> Mapping[type[Message], Maker]:
        """Which messages this node sends, and how each is made."""
        raise NotImplementedError

    @property
    def links(self) -> tuple[Link, ...]:
        """The links to all buses that this node is on."""
        return (self.link,)

    def link_for(self, kind: type[Message]) -> Link:  # noqa: ARG002
        """The link that a message goes out on."""
        return self.link

    def react(self, message: Message) -> None:
        """Take a message of another node into account."""

    def start(self, *kinds: type[Message]) -> None:
        """Send messages from now on: at their periods, or once where they have none."""
        for kind in kinds:
            self._due.setdefault(kind, self.now)

    def stop(self, *kinds: type[Message]) -> None:
        """Send messages no more."""
        for kind in kinds:
            self._due.pop(kind, None)

    @property
    def next_due(self) -> float:
        """When there is something to send."""
        return min(self._due.values())

    def turn(self, now: float) -> None:
        """React to what has arrived, then send what is due."""
        self.now = now
        for link in self.links:
            for received in arrived(link):
                self.react(received.message)
        for kind, due in list(self._due.items()):
            if due <= now:
                self._send(kind, due)

    def _send(self, kind: type[Message], due: float) -> None:
        if kind.PERIOD is None:
            self.stop(kind)
        else:
            self._due[kind] = due + kind.PERIOD
        for message in self._makers[kind]():
            self.link_for(kind).send(message)


def arrived(link: Link) -> Iterator[Received]:
    """What has arrived at a link so far."""
    while True:
        try:
            yield link.receive(timeout=0)
        except ReceiveTimeoutError:
            return
