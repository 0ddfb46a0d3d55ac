"""The whole catalogue of faults, in simulations: each noticed by another node, named, got over."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import pytest

from swapcan import Fault
from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    BSU_BMS_0,
    TMS_BMS_0,
    V2B_CMD,
    BmsState,
    C2B_ACStatus,
)
from swapcan.nodes.faults import FAULTS, able_nodes, planned_fault
from swapcan.nodes.plan import plan_of
from swapcan.nodes.simulation import Simulation
from typedcan.simulate.faults import TRANSMISSION_FAULTS
from typedcan.supervise import SignalChanged, State, StateChanged
from typedcan.wire.message import Message

BEGIN, END = 3.0, 7.0
"""Seconds for which the faults are there."""

TIMEOUT = 5.0
"""Seconds in which a physical fault has to be noticed."""


@dataclass(frozen=True)
class Physical:
    """How a physical fault shows: who notices it in which signal, and what brings it about."""

    nodes: tuple[str, ...]
    observer: str
    message: type[Message]
    field: str
    plan: str = "hv_on@1s, hv_on@9s"
    begin: float = BEGIN


PACK = ("BMU", "VCU")
CHARGE = ("BMU", "CHG")
PHYSICAL = {
    "welded_relay": Physical(
        PACK, "VCU", B2V_ST0, "flt_main_pos_relay_weld", "hv_on@1s, hv_off@4s, hv_on@10s"
    ),
    "stuck_relay": Physical(PACK, "VCU", B2V_ST0, "flt_main_pos_relay_open", begin=0.5),
    "over_temperature": Physical(PACK, "VCU", B2V_ST1, "flt_over_temp"),
    "over_voltage_cell": Physical(PACK, "VCU", B2V_ST1, "flt_over_ucell"),
    "low_insulation": Physical(PACK, "VCU", B2V_ST1, "flt_low_ins_res"),
    "sensor_failure": Physical(PACK, "VCU", B2V_ST1, "flt_hw"),
    "charger_over_temperature": Physical(CHARGE, "BMU", C2B_ACStatus, "charger_over_temp", ""),
    "charger_hardware": Physical(CHARGE, "BMU", C2B_ACStatus, "charger_hardware", ""),
    "charger_input_voltage": Physical(CHARGE, "BMU", C2B_ACStatus, "charger_input_voltage", ""),
    "tms_fault": Physical(("BMU", "TMS"), "BMU", TMS_BMS_0, "fault_lv", ""),
    "connector_over_temperature": Physical(
        ("BMU", "BSU"), "BMU", BSU_BMS_0, "conctor_temp_warn", ""
    ),
}
OTHERWISE_SHOWN = {"precharge_failure"}
"""The standard has no fault signal for it, but a state."""

Event = StateChanged | SignalChanged | Fault
Noticed = list[tuple[float, str, Event]]


@contextmanager
def simulation(
    nodes: tuple[str, ...], plan: str, fault: str
) -> Iterator[tuple[Simulation, Noticed]]:
    """A simulation with a fault, and what its nodes notice: second, node, event."""
    planned = [planned_fault(fault)]
    with Simulation.simulated(nodes, plan=plan_of(plan), faults=planned) as running:
        noticed: Noticed = []
        for name, participant in running.participants.items():
            for node in participant.nodes:
                for kind in (StateChanged, SignalChanged, Fault):
                    node.on(
                        kind,
                        lambda event, name=name: noticed.append(
                            (running.world.elapsed, name, event)
                        ),
                    )
        yield running, noticed


@pytest.mark.parametrize("fault", PHYSICAL)
def test_a_physical_fault_is_noticed_named_and_got_over(fault: str) -> None:
    case = PHYSICAL[fault]
    planned = f"{fault}@{case.begin}s+{END - case.begin}s"
    with simulation(case.nodes, case.plan, planned) as (running, noticed):
        running.world.run(12.0)
        changes = [
            (at, event.active)
            for at, name, event in noticed
            if isinstance(event, SignalChanged)
            and (name, event.message, event.field) == (case.observer, case.message, case.field)
        ]
        assert changes[0][1]
        assert case.begin < changes[0][0] < case.begin + TIMEOUT
        assert {event.kind for _, _, event in noticed if isinstance(event, SignalChanged)} <= {
            "alarm",
            "invalid",
        }
        assert not changes[-1][1]
        assert changes[-1][0] > END
        if running.vcu:
            assert running.vcu.trouble == ""
            assert running.vcu.states[-1] is BmsState.HV_CLOSED
        assert running.bmu
        assert running.bmu.state.faults.level == 0


def test_a_precharge_failure_ends_in_its_state_and_can_be_tried_again() -> None:
    with simulation(PACK, "hv_on@1s, hv_on@7s", "precharge_failure@0s+6s") as (running, _):
        assert running.vcu
        running.world.run(6.0)
        assert BmsState.FAIL_TO_HV_ON in running.vcu.states
        assert BmsState.HV_CLOSED not in running.vcu.states
        assert running.vcu.status == "off: the BMU cannot switch on"
        running.world.run(4.0)
        assert running.vcu.states[-1] is BmsState.HV_CLOSED
        assert running.vcu.trouble == ""


WATCHED: dict[str, tuple[str, type[Message]]] = {
    "BMU": ("VCU", B2V_ST1),
    "VCU": ("BMU", V2B_CMD),
    "CHG": ("BMU", C2B_ACStatus),
    "TMS": ("BMU", TMS_BMS_0),
    "BSU": ("VCU", BSU_BMS_0),
}
"""Of each node, who watches which of its messages."""


def is_state(state: State) -> Callable[[Event], bool]:
    return lambda event: isinstance(event, StateChanged) and event.new is state


def is_fault(text: str) -> Callable[[Event], bool]:
    return lambda event: isinstance(event, Fault) and text in (event.kind, event.counter)


def signs(message: type[Message], fault: str) -> list[Callable[[Event], bool]]:
    """What a fault of a message's frames is noticed by, in that order."""
    lost = is_fault("skipped") if message.COUNTER else is_state(State.LATE)
    return {
        "lost_frame": [lost],
        "late_frame": [is_state(State.LATE), is_state(State.ALIVE)],
        "stuck_counter": [is_fault("repeated")],
        "wrong_checksum": [is_fault("checksum")],
        "bus_silence": [is_state(State.LATE), is_state(State.LOST), is_state(State.ALIVE)],
    }[fault]


@pytest.mark.parametrize("fault", sorted(TRANSMISSION_FAULTS))
def test_a_fault_of_the_transmission_is_noticed_at_every_node_that_has_it(fault: str) -> None:
    with simulation(PROTOCOL.nodes, "", f"{fault}@{BEGIN}s+5.5s") as (running, noticed):
        running.world.run(11.0)
        for node in able_nodes(fault):
            observer, message = WATCHED[node]
            assert message.PERIOD
            own = [
                (at, event)
                for at, name, event in noticed
                if name == observer and at > BEGIN and message.NAME in str(event)
            ]
            sought = signs(message, fault)
            first = next(at for at, event in own if sought[0](event))
            assert first <= BEGIN + 5 * message.PERIOD
            for sign in sought:  # each in what comes after the one before
                assert any(sign(event) for _, event in own), (node, own)
                while not sign(own.pop(0)[1]):
                    pass
        noticed.clear()
        running.world.run(3.0)
        assert noticed == []
        for node in PROTOCOL.nodes:
            observer, message = WATCHED[node]
            observers = running.participants[observer].nodes
            assert State.ALIVE in {watching.state(message) for watching in observers}


def test_the_catalogue_is_complete_in_both_directions() -> None:
    with Simulation.simulated() as running:
        known = {name: each.faults for name, each in running.participants.items()}
    physical = frozenset[str]().union(*known.values())
    assert physical | TRANSMISSION_FAULTS == set(FAULTS)
    assert physical == set(PHYSICAL) | OTHERWISE_SHOWN
    for name, faults in known.items():
        assert {kind.name for kind in FAULTS.values() if name in kind.nodes} == faults
