"""Participants that share a high-voltage line, and the world in which they do."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from swapcan._generated.protocol import PROTOCOL
from swapcan.plant.line import Line
from swapcan.wire import codec_for
from typedcan.node.clock import Clock
from typedcan.node.node import Node
from typedcan.simulate import participant, world
from typedcan.simulate.simulated_bus import SimulatedWire
from typedcan.spoken.codec import words_of
from typedcan.wire.codec import Codec
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol


class Participant(participant.Participant):
    """A participant that may be on a high-voltage `Line` with others.

    See `typedcan.simulate.participant.Participant`. It says what it has to say in the edition and
    the readings of its codec, as far as that has words for it; ``protocol`` is what is spoken.
    """

    def __init__(self, *nodes: Node, codec: Codec | None = None) -> None:
        super().__init__(*nodes)
        codec = codec or codec_for()
        self.protocol: Protocol = codec.protocol
        self.words = words_of(codec)
        self.line: Line | None = None
        self._say_the_rest()

    def supply(
        self,
        kind: type[Message],
        make: Callable[[], Iterable[Message]],
        *,
        node: Node | None = None,
        period: float | None = None,
    ) -> None:
        """Send a message cyclically from a node, the first where none is given.

        Nothing where there is no such message in what is spoken; see `Node.supply`.
        """
        if self.words.has(kind):
            sayable = self.words.gist
            (node or self.nodes[0]).supply(kind, lambda: map(sayable, make()), period=period)

    def tell(self, *messages: Message) -> None:
        """Send what stays the same, as what is spoken has it: on request, or all the time."""
        for message in filter(self._has, messages):
            kind = self.words.kind(type(message))
            on_request = kind.PERIOD is None or kind in self.protocol.conditional
            node = self.nodes[0]
            (node.provide if on_request else node.set)(self.words.gist(message))

    def ask_for(self, message: Message) -> None:
        """Send a request, once or all the time, as what is spoken has it."""
        if self._has(message):
            self.nodes[0].set(self.words.gist(message))

    def _has(self, message: Message) -> bool:
        return self.words.has(type(message))

    def _say_the_rest(self) -> None:
        """Send what only the edition has, with its start values."""
        own = {self.words.wanted(kind) for kind in PROTOCOL.messages}
        for kind in self.protocol.sent_by(self.name):
            if kind not in own and kind.PERIOD and kind not in self.protocol.conditional:
                made: Any = kind
                self.nodes[0].set(made())


class World(world.World):
    """Lets participants live that share a `Line`; see `typedcan.simulate.world.World`.

    The line carries what those of them give and draw that set its values.
    """

    def __init__(
        self,
        *participants: participant.Participant,
        clock: Clock | None = None,
        wires: Sequence[SimulatedWire] = (),
    ) -> None:
        super().__init__(*participants, clock=clock, wires=wires)
        self.line = Line()
        for each in participants:
            if isinstance(each, Participant):
                each.line = self.line
