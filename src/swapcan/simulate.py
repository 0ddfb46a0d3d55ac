"""Simulated nodes: a truck, a pack, a charger, a cooling unit, a swap controller, on any bus.

For example a pack and a charger, as a VCU on the same bus sees them:

    with can.Bus(...) as one, can.Bus(...) as two:
        with World(Bmu(one), Chg(two)):
            ...

or all five on simulated buses and a simulated clock, as fast as it goes:

    with Simulation.simulated(plan=DEFAULT_PLAN, faults=[planned_fault("welded_relay@60s")]) as all:
        all.world.run(140.0)
        print(all.vcu.states)

`FaultyBus` spoils what any node sends, one that is not simulated as well.
"""

from swapcan.nodes.bmu import Bmu
from swapcan.nodes.bsu import Bsu
from swapcan.nodes.chg import Chg
from swapcan.nodes.faults import FAULTS, FaultyBus, planned_fault
from swapcan.nodes.plan import DEFAULT_PLAN, STEPS, PlannedStep, plan_of, planned_step
from swapcan.nodes.simulation import Simulation
from swapcan.nodes.tms import Tms
from swapcan.nodes.vcu import Vcu
from swapcan.nodes.world import Participant, World
from swapcan.plant.battery import Battery, Layout
from swapcan.plant.line import Line
from typedcan.simulate.faults import FaultKind, PlannedFault
from typedcan.simulate.participant import UnknownFaultError
from typedcan.simulate.shared_bus import SharedBus
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.times import PlanError

__all__ = [
    "DEFAULT_PLAN",
    "FAULTS",
    "STEPS",
    "Battery",
    "Bmu",
    "Bsu",
    "Chg",
    "FaultKind",
    "FaultyBus",
    "Layout",
    "Line",
    "Participant",
    "PlanError",
    "PlannedFault",
    "PlannedStep",
    "SharedBus",
    "SimulatedBus",
    "SimulatedWire",
    "Simulation",
    "Tms",
    "UnknownFaultError",
    "Vcu",
    "World",
    "plan_of",
    "planned_fault",
    "planned_step",
]
