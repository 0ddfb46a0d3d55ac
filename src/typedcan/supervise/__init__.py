"""Supervision of what a node receives: which messages come, how regularly, with which faults."""

from typedcan.supervise.events import NotSeen, SignalChanged, State, StateChanged, SupervisionEvent
from typedcan.supervise.snapshot import MessageSnapshot, SignalSnapshot, Snapshot
from typedcan.supervise.supervisor import Supervisor

__all__ = [
    "MessageSnapshot",
    "NotSeen",
    "SignalChanged",
    "SignalSnapshot",
    "Snapshot",
    "State",
    "StateChanged",
    "SupervisionEvent",
    "Supervisor",
]
