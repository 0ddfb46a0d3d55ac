"""What simulated nodes do and notice, as lines of text or JSON.

In JSON, one object a line:

    {"time": 1.234, "node": "VCU", "kind": "state", "text": "driving"}

``time`` is in seconds since the start, ``node`` is the one that does or notices something, and
``kind`` is one of

- state: what the node does now;
- fault: a fault that was injected into it begins or ends;
- supervision: a message is late, lost, alive again or was never seen;
- signal: a signal says that something is wrong, or no longer does;
- frame: a frame had a wrong length, checksum or counter;
- bus: the bus is lost or back, a message could not be sent, a frame not be handled;
- answer: what it asked for, or that nobody answered.

Supervision, signal and frame have ``message`` too.
"""

from __future__ import annotations

import json
from functools import partial
from typing import Any

from swapcan.node.answers import BatteryInfo
from swapcan.nodes.simulation import Simulation
from typedcan.commands.transcript import faults_text
from typedcan.node.errors import RequestError
from typedcan.node.events import BusBack, BusLost, NodeFailed, ReceiveFailed, SendFailed
from typedcan.node.node import Node
from typedcan.node.request import Pending
from typedcan.shell.console import say
from typedcan.simulate.shared_bus import SharedBus
from typedcan.supervise import NotSeen, SignalChanged, StateChanged
from typedcan.wire.link import Fault
from typedcan.wire.message import Message

_PAUSE = 1.0
"""Seconds for which the same fault of frames of the same message is not said again."""

_KINDS = {
    StateChanged: "supervision",
    NotSeen: "supervision",
    SignalChanged: "signal",
    BusLost: "bus",
    BusBack: "bus",
    SendFailed: "bus",
    ReceiveFailed: "bus",
    NodeFailed: "bus",
}


class SimulationReport:
    """Prints what happens in a simulation from now on.

    Parameters
    ----------
    simulation
        Is watched while its world runs.
    as_json
        Whether the lines are JSON.
    """

    def __init__(self, simulation: Simulation, *, as_json: bool) -> None:
        self._simulation = simulation
        self._as_json = as_json
        self._status = dict.fromkeys(simulation.participants, "")
        self._faults: dict[str, frozenset[str]] = dict.fromkeys(
            simulation.participants, frozenset()
        )
        self._frame_faults: dict[tuple[str, str, str], float] = {}
        self._answered: set[Pending[Any]] = set()
        self._lines: list[str] = []
        for name, participant in simulation.participants.items():
            for node in participant.nodes:
                self._listen(name, node)
        simulation.world.after_each_step(self._look)

    def summary(self, seconds: float, *buses: SharedBus) -> str:
        """How long it was, how many frames there were, and what was wrong with them."""
        participants = self._simulation.participants
        counts = [node.counts for each in participants.values() for node in each.nodes]
        sent = sum(bus.sent for bus in buses)
        received = sum(bus.received for bus in buses)
        return (
            f"simulated {', '.join(participants)} for {seconds:.1f} s:"
            f" frames sent {sent}, from others {received}, {faults_text(counts)}"
        )

    def _listen(self, name: str, node: Node) -> None:
        for kind, word in _KINDS.items():
            node.on(kind, partial(self._tell, name, word))
        node.on(Fault, partial(self._tell_frame_fault, name))

    def _tell(self, name: str, word: str, event: Any) -> None:
        message = getattr(event, "message", None)
        self._add(name, word, str(event), message.NAME if message else None)

    def _tell_frame_fault(self, name: str, fault: Fault) -> None:
        now = self._simulation.world.elapsed
        key = (name, fault.message, fault.kind)
        if now - self._frame_faults.get(key, -_PAUSE) >= _PAUSE:
            self._frame_faults[key] = now
            self._add(name, "frame", str(fault), fault.message)

    def _look(self) -> None:
        """See what has changed since the step before."""
        for name, participant in self._simulation.participants.items():
            faults = participant.active_faults.union(
                *(bus.active_faults for bus in self._simulation.buses[name])
            )
            for fault in sorted(faults ^ self._faults[name]):
                self._add(name, "fault", f"{fault} {'begins' if fault in faults else 'ends'}")
            self._faults[name] = faults
            status = participant.status
            if status != self._status[name]:
                self._status[name] = status
                self._add(name, "state", status)
        vcu = self._simulation.vcu
        if vcu:
            for pending in (vcu.pack_code, vcu.battery_info):
                if pending and pending.done() and pending not in self._answered:
                    self._answered.add(pending)
                    self._add(vcu.name, "answer", _answer(pending))
        # Not where they arise: a node goes on whatever its callbacks raise, a closed pipe too.
        lines, self._lines = self._lines, []
        for line in lines:
            say(line, flush=True)

    def _add(self, node: str, kind: str, text: str, message: str | None = None) -> None:
        elapsed = self._simulation.world.elapsed
        if self._as_json:
            line: dict[str, Any] = {"time": round(elapsed, 6), "node": node, "kind": kind}
            line |= {"message": message} if message else {}
            self._lines.append(json.dumps(line | {"text": text}))
        else:
            self._lines.append(f"{elapsed:10.3f}  {node}  {text}")


def _answer(pending: Pending[Any]) -> str:
    try:
        answer = pending.result(0)
    except RequestError as error:
        return str(error)
    if isinstance(answer, BatteryInfo):
        return f"battery: {_values(answer.info1)}, {_values(answer.info2)}"
    return f"pack code {answer}"


def _values(message: Message) -> str:
    fields = message.FIELDS.values()
    return ", ".join(f"{field.name} {field.text(getattr(message, field.name))}" for field in fields)
