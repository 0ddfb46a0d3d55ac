"""The faults of the simulated nodes, and the bus that spoils what they send."""

from __future__ import annotations

import can

from swapcan._generated.protocol import PROTOCOL
from typedcan.model.checksums.registry import Given
from typedcan.node.clock import Clock
from typedcan.simulate import faulty_bus
from typedcan.simulate.faults import FaultKind, Faults
from typedcan.wire.protocol import Protocol

_FAULTS = Faults(
    PROTOCOL,
    (
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
    ),
    example="over_temperature@30s",
)

FAULTS = _FAULTS.kinds
"""All faults by name."""

able_nodes = _FAULTS.able_nodes
planned_fault = _FAULTS.planned


class FaultyBus(faulty_bus.FaultyBus):
    """Stands for a bus of the standard; see `typedcan.simulate.faulty_bus.FaultyBus`.

    Parameters
    ----------
    bus, clock
        The bus to send on, and what a late frame waits by.
    protocol, algorithms
        As `Codec` has them; needed to make checksums right again.
    """

    def __init__(
        self,
        bus: can.BusABC,
        *,
        clock: Clock | None = None,
        protocol: Protocol = PROTOCOL,
        algorithms: Given | None = None,
    ) -> None:
        super().__init__(bus, protocol, clock=clock, algorithms=algorithms)
