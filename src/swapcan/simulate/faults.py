"""Faults by name: which there are, and when they are to come and go."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from swapcan._generated.protocol import PROTOCOL
from swapcan.simulate.times import PlanError, timed
from typedcan.wire.message import Message


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


FAULTS: Mapping[str, FaultKind] = MappingProxyType(
    {
        kind.name: kind
        for kind in (
            FaultKind("lost_frame", "one frame in four is not sent"),
            FaultKind("late_frame", "one frame in four is held back for two and a half periods"),
            FaultKind("stuck_counter", "the alive counter stays as it is"),
            FaultKind("wrong_checksum", "the checksum of one frame in four is wrong"),
            FaultKind("bus_silence", "nothing is sent any more"),
            FaultKind("welded_relay", "the main positive relay does not open", ("BMU",)),
            FaultKind("stuck_relay", "the main positive relay does not close", ("BMU",)),
            FaultKind("precharge_failure", "the precharge does not reach the voltage", ("BMU",)),
            FaultKind("over_temperature", "cells get too hot", ("BMU",)),
            FaultKind("over_voltage_cell", "a cell's voltage is too high", ("BMU",)),
            FaultKind("low_insulation", "the insulation to ground is bad", ("BMU",)),
            FaultKind("sensor_failure", "a sensor gives no valid value", ("BMU",)),
            FaultKind("charger_over_temperature", "the charger gets too hot", ("CHG",)),
            FaultKind("charger_hardware", "the charger's hardware fails", ("CHG",)),
            FaultKind("charger_input_voltage", "the charger's mains are out of range", ("CHG",)),
            FaultKind("tms_fault", "the cooling unit fails and stops", ("TMS",)),
            FaultKind("connector_over_temperature", "the swap connector gets too hot", ("BSU",)),
        )
    }
)
"""All faults by name."""

TRANSMISSION_FAULTS = frozenset(kind.name for kind in FAULTS.values() if kind.is_transmission)
"""The names of the faults that frames can have, whatever they tell of."""


@dataclass(frozen=True, slots=True)
class PlannedFault:
    """A fault, when it comes and when it goes.

    Parameters
    ----------
    name
        Of the fault.
    start, duration
        In seconds; start counts from the beginning of the run.
    target
        The node that is to have it, or the message whose frames are; None for all that can.
    """

    name: str
    start: float
    duration: float = math.inf
    target: str | None = None

    @property
    def end(self) -> float:
        """When it goes, in seconds from the beginning of the run."""
        return self.start + self.duration

    @property
    def nodes(self) -> tuple[str, ...]:
        """The nodes that have it, if they take part."""
        able = able_nodes(self.name)
        if self.target in (None, *PROTOCOL.nodes):
            return tuple(node for node in able if self.target in (None, node))
        return (PROTOCOL.message(str(self.target)).SENDER,)

    @property
    def messages(self) -> tuple[type[Message], ...]:
        """The messages that a fault of the transmission is for; none for all of the node's."""
        if self.target in (None, *PROTOCOL.nodes):
            return ()
        return (PROTOCOL.message(str(self.target)),)

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


def able_nodes(fault: str) -> tuple[str, ...]:
    """The nodes that can have a fault; raises `PlanError` for an unknown one."""
    kind = _known(fault)
    return kind.nodes or tuple(
        node
        for node in PROTOCOL.nodes
        if any(can_have(message, fault) for message in PROTOCOL.sent_by(node))
    )


def planned_fault(text: str) -> PlannedFault:
    """A planned fault from ``NAME@START``, as in ``over_temperature@30s``.

    ``+DURATION`` behind it lets it go again (``lost_frame@5s+500ms``), ``NODE.`` or ``MESSAGE.``
    before it says who has it (``VCU.bus_silence@1min``, ``B2V_ST1.stuck_counter@0s``). Raises
    `PlanError`.
    """
    where, start, duration = timed(text, "over_temperature@30s")
    target, _, name = where.rpartition(".")
    return _checked(
        PlannedFault(name, start, math.inf if duration is None else duration, target or None)
    )


def _known(fault: str) -> FaultKind:
    if fault not in FAULTS:
        raise PlanError(f"there is no fault {fault!r}; known: {', '.join(FAULTS)}")
    return FAULTS[fault]


def _checked(planned: PlannedFault) -> PlannedFault:
    able = able_nodes(planned.name)
    target = planned.target
    if target is None or target in able:
        return planned
    if target in PROTOCOL.nodes:
        raise PlanError(f"{target} cannot have {planned.name}; it is for {', '.join(able)}")
    messages = {message.NAME: message for message in PROTOCOL.messages}
    if target not in messages:
        raise PlanError(f"there is no node or message {target!r}")
    if not can_have(messages[target], planned.name):
        raise PlanError(f"the frames of {target} cannot have {planned.name}")
    return planned
