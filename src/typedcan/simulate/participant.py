"""What all simulated participants have in common: nodes, a step of time, physical faults."""

from __future__ import annotations

from typing import ClassVar

from typedcan.model.errors import TypedcanError
from typedcan.node.node import Node


class UnknownFaultError(TypedcanError, LookupError):
    """There is no fault of that name."""


class Participant:
    """One participant of the protocol: what it does, apart from talking.

    A subclass hands over its nodes and says in `step` what time and the last messages change;
    the nodes do the talking.

    Class attributes: ``name`` of the node in the protocol, and ``faults``, the names of the
    physical faults that it knows.

    Parameters
    ----------
    nodes
        Its nodes, one for each bus that it is on.
    """

    name: ClassVar[str]
    faults: ClassVar[frozenset[str]] = frozenset()

    def __init__(self, *nodes: Node) -> None:
        self.nodes: tuple[Node, ...] = nodes
        self._active: set[str] = set()

    @property
    def active_faults(self) -> frozenset[str]:
        """The physical faults that it has now."""
        return frozenset(self._active)

    @property
    def status(self) -> str:
        """What it is doing, in a word or two for people; empty where there is nothing to say."""
        return ""

    def step(self, now: float) -> None:
        """Go on to a time, in seconds of the clock of its nodes.

        Is called at least every 10 ms of that clock, each time before the nodes' turn.
        """
        raise NotImplementedError

    def inject(self, fault: str) -> None:
        """Have a physical fault from now on; raises `UnknownFaultError`."""
        self._active.add(self._known(fault))

    def heal(self, fault: str) -> None:
        """Have a physical fault no more; raises `UnknownFaultError`."""
        self._active.discard(self._known(fault))

    def has(self, fault: str) -> bool:
        """Whether it has a physical fault now; raises `UnknownFaultError`."""
        return self._known(fault) in self._active

    def _known(self, fault: str) -> str:
        if fault not in self.faults:
            known = ", ".join(sorted(self.faults)) or "none"
            raise UnknownFaultError(f"{self.name} has no fault {fault!r}; it knows {known}")
        return fault
