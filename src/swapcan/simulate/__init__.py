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

from swapcan.simulate.battery import Battery, Layout
from swapcan.simulate.bmu import Bmu
from swapcan.simulate.bsu import Bsu
from swapcan.simulate.chg import Chg
from swapcan.simulate.faults import FaultKind, PlannedFault
from swapcan.simulate.line import Line
from swapcan.simulate.line_world import Participant, World
from swapcan.simulate.participant import UnknownFaultError
from swapcan.simulate.plan import DEFAULT_PLAN, STEPS, PlannedStep, plan_of, planned_step
from swapcan.simulate.shared_bus import SharedBus
from swapcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from swapcan.simulate.simulation import Simulation
from swapcan.simulate.standard_faults import FAULTS, FaultyBus, planned_fault
from swapcan.simulate.times import PlanError
from swapcan.simulate.tms import Tms
from swapcan.simulate.vcu import Vcu

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
