"""Faults by name: which there are, and when they are to come and go."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from typedcan.simulate.times import PlanError, timed
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol


@dataclass(frozen=True, slots=True)
class FaultKind:
    """A fault that can be injected.

    Parameters
    ----------
    name, text
        Its name, and what happens in one line.
    nodes
        The nodes that can have it as a physical fault; none for a fault of the transmission,
        which every sender can have.
    """

    name: str
    text: str
    nodes: tuple[str, ...] = ()

    @property
    def is_transmission(self) -> bool:
        """Whether the frames are wrong, and not what they tell of."""
        return not self.nodes


_TRANSMISSION = (
    FaultKind("lost_frame", "one frame in four is not sent"),
    FaultKind("late_frame", "one frame in four is held back for two and a half periods"),
    FaultKind("stuck_counter", "the alive counter stays as it is"),
    FaultKind("wrong_checksum", "the checksum of one frame in four is wrong"),
    FaultKind("bus_silence", "nothing is sent any more"),
)

TRANSMISSION_FAULTS = frozenset(kind.name for kind in _TRANSMISSION)
"""The names of the faults that frames can have, whatever they tell of."""


@dataclass(frozen=True, slots=True)
class PlannedFault:
    """A fault, when it comes and when it goes; made by `Faults.planned`.

    Parameters
    ----------
    name
        Of the fault.
    start, duration
        In seconds; start counts from the beginning of the run.
    target
        The node that is to have it, or the message whose frames are; None for all that can.
    nodes
        The nodes that have it, if they take part.
    messages
        The messages that a fault of the transmission is for; none for all of the node's.
    """

    name: str
    start: float
    duration: float
    target: str | None
    nodes: tuple[str, ...]
    messages: tuple[type[Message], ...]

    @property
    def end(self) -> float:
        """When it goes, in seconds from the beginning of the run."""
        return self.start + self.duration

    def __str__(self) -> str:
        target = f"{self.target}." if self.target else ""
        duration = f"+{self.duration:g}s" if math.isfinite(self.duration) else ""
        return f"{target}{self.name}@{self.start:g}s{duration}"


def can_have(message: type[Message], fault: str) -> bool:
    """Whether the frames of a message can have a fault of the transmission."""
    if fault == "stuck_counter":
        return message.COUNTER is not None
    if fault == "wrong_checksum":
        return message.CHECKSUM is not None
    return fault in TRANSMISSION_FAULTS


class Faults:
    """The faults that the nodes of a protocol can have: ``kinds`` are all of them by name.

    Parameters
    ----------
    protocol
        Whose frames can have those of the transmission.
    physical
        What else can be wrong with its nodes, as far as it is simulated.
    example
        A planned fault as people are shown one.
    """

    def __init__(
        self,
        protocol: Protocol,
        physical: Iterable[FaultKind] = (),
        *,
        example: str = "bus_silence@30s",
    ) -> None:
        self._protocol = protocol
        self._example = example
        self.kinds: Mapping[str, FaultKind] = MappingProxyType(
            {kind.name: kind for kind in (*_TRANSMISSION, *physical)}
        )

    def able_nodes(self, fault: str) -> tuple[str, ...]:
        """The nodes that can have a fault; raises `PlanError` for an unknown one."""
        if fault not in self.kinds:
            raise PlanError(f"there is no fault {fault!r}; known: {', '.join(self.kinds)}")
        return self.kinds[fault].nodes or tuple(
            node
            for node in self._protocol.nodes
            if any(can_have(message, fault) for message in self._protocol.sent_by(node))
        )

    def planned(self, text: str) -> PlannedFault:
        """A planned fault from ``NAME@START``, as in ``bus_silence@30s``.

        ``+DURATION`` behind it lets it go again (``lost_frame@5s+500ms``), ``NODE.`` or
        ``MESSAGE.`` before it says who has it (``Gateway.bus_silence@1min``,
        ``Status.stuck_counter@0s``). Raises `PlanError`.
        """
        where, start, duration = timed(text, self._example)
        target, _, name = where.rpartition(".")
        able = self.able_nodes(name)
        nodes, messages = (able, ()) if not target else self._meant(target, name, able)
        lasts = math.inf if duration is None else duration
        return PlannedFault(name, start, lasts, target or None, nodes, messages)

    def _meant(
        self, target: str, fault: str, able: tuple[str, ...]
    ) -> tuple[tuple[str, ...], tuple[type[Message], ...]]:
        """The nodes and the messages that a target means."""
        if target in able:
            return (target,), ()
        if target in self._protocol.nodes:
            raise PlanError(f"{target} cannot have {fault}; it is for {', '.join(able)}")
        message = {each.NAME: each for each in self._protocol.messages}.get(target)
        if message is None:
            raise PlanError(f"there is no node or message {target!r}")
        if not can_have(message, fault):
            raise PlanError(f"the frames of {target} cannot have {fault}")
        return (message.SENDER,), (message,)
