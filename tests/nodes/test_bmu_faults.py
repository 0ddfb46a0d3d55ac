"""Faults of the simulated pack: what the VCU sees of them, and that they go again."""

from __future__ import annotations

import pytest
from nodes.bmu_talk import OFF, ON, Pack, number, relays, states
from nodes.outside import Outside

from swapcan.messages import (
    B2V_RQ,
    B2V_ST0,
    B2V_ST1,
    B2V_ST3,
    B2V_ST4,
    B2V_ST5,
    B2V_Ucell,
    BmsState,
    FaultFlag,
    FaultLevel,
    HvOffRequest,
    RelayState,
)
from typedcan.model.signal_state import SignalState


def test_a_grave_fault_asks_for_high_voltage_off_until_it_is_gone(closed: Pack) -> None:
    bmu, vcu, _ = closed
    vcu.say(OFF)
    bmu.inject("over_temperature")
    vcu.run(3.0)
    assert vcu.last(B2V_RQ).hv_off is HvOffRequest.REQUEST_HV_OFF
    assert vcu.last(B2V_ST1).flt_over_temp is FaultLevel.LEVEL3_MOST_SEVERE_FAULT
    assert vcu.last(B2V_ST1).fault_levl is FaultLevel.LEVEL3_MOST_SEVERE_FAULT
    assert vcu.last(B2V_ST4).max_temp == 62.0
    bmu.heal("over_temperature")
    vcu.run(3.0)
    assert vcu.last(B2V_RQ).hv_off is HvOffRequest.NO_REQUEST_HV_OFF
    assert vcu.last(B2V_ST1).fault_levl is FaultLevel.NORMAL
    vcu.say(ON)
    vcu.run(2.5)
    assert vcu.last(B2V_ST1).bms is BmsState.HV_CLOSED


def test_a_pack_that_is_not_obeyed_opens_by_itself(closed: Pack) -> None:
    bmu, vcu, _ = closed
    bmu.inject("low_insulation")
    vcu.run(5.0)
    assert vcu.last(B2V_ST1).bms is BmsState.HV_CLOSED
    vcu.run(3.0)
    assert vcu.last(B2V_ST1).bms is BmsState.HV_OPEN
    assert vcu.last(B2V_ST0).flt_pack_self_protect is FaultFlag.FAULT


def test_a_welded_relay_is_shown_closed_and_as_a_fault_until_it_opens(closed: Pack) -> None:
    bmu, vcu, _ = closed
    bmu.inject("welded_relay")
    vcu.run(1.0)
    assert vcu.last(B2V_ST0).flt_main_pos_relay_weld is FaultFlag.NORMAL
    vcu.say(OFF)
    vcu.run(3.0)
    seen = vcu.last(B2V_ST0)
    assert seen.flt_main_pos_relay_weld is FaultFlag.FAULT
    assert relays(seen) == (RelayState.CLOSED, RelayState.OPEN, RelayState.OPEN)
    assert vcu.last(B2V_ST1).fault_levl is FaultLevel.LEVEL3_MOST_SEVERE_FAULT
    assert vcu.last(B2V_ST1).bms is BmsState.HV_OPEN
    bmu.heal("welded_relay")
    vcu.run(2.0)
    seen = vcu.last(B2V_ST0)
    assert seen.flt_main_pos_relay_weld is FaultFlag.NORMAL
    assert relays(seen) == (RelayState.OPEN,) * 3


def test_a_relay_that_cannot_close_is_reported(pack: Pack) -> None:
    bmu, vcu, _ = pack
    bmu.inject("stuck_relay")
    vcu.say(ON)
    vcu.run(3.0)
    assert vcu.last(B2V_ST1).bms is BmsState.FAIL_TO_HV_ON
    assert vcu.last(B2V_ST0).flt_main_pos_relay_open is FaultFlag.FAULT


def test_a_failed_precharge_is_reported_and_works_again_when_healed(pack: Pack) -> None:
    bmu, vcu, _ = pack
    bmu.inject("precharge_failure")
    vcu.say(ON)
    vcu.run(5.0)
    assert states(vcu)[-2:] == [BmsState.PRECHARGE, BmsState.FAIL_TO_HV_ON]
    bmu.heal("precharge_failure")
    vcu.say(OFF)
    vcu.run(0.5)
    vcu.say(ON)
    vcu.run(2.5)
    assert vcu.last(B2V_ST1).bms is BmsState.HV_CLOSED


def test_a_cell_with_too_high_a_voltage_is_in_all_messages(pack: Pack) -> None:
    bmu, vcu, _ = pack
    before = last_voltage(vcu)
    bmu.inject("over_voltage_cell")
    vcu.run(2.0)
    highest = vcu.last(B2V_ST5)
    assert highest.max_ucell == pytest.approx(3.8)
    assert cells(vcu)[highest.max_ucell_csc_no, highest.max_ucell_position] == pytest.approx(3.8)
    assert vcu.last(B2V_ST1).flt_over_ucell is FaultLevel.LEVEL3_MOST_SEVERE_FAULT
    assert last_voltage(vcu) - before == pytest.approx(3.8 - before / 24, abs=0.2)


def last_voltage(vcu: Outside) -> float:
    vcu.run(0.2)
    return number(vcu.last(B2V_ST3).upack_batt)


def cells(vcu: Outside) -> dict[tuple[object, object], float | SignalState]:
    """The voltages that came last, by CSC and position."""
    found: dict[tuple[object, object], float | SignalState] = {}
    for frame in vcu.all(B2V_Ucell):
        assert isinstance(frame.frame_no, int)
        values = (frame.csc_no_ucell_n, frame.csc_no_ucell_n1, frame.csc_no_ucell_n2)
        for position, value in enumerate(values, 3 * (frame.frame_no - 1) + 1):
            found[frame.csc_no, position] = value
    return found


def test_a_cell_without_a_sensor_is_sent_as_invalid(pack: Pack) -> None:
    bmu, vcu, _ = pack
    bmu.inject("sensor_failure")
    vcu.run(1.0)
    assert list(cells(vcu).values()).count(SignalState.INVALID) == 1
    assert len(cells(vcu)) == 24
    assert vcu.last(B2V_ST1).flt_hw is FaultLevel.LEVEL_2_MORE_SEVERE_FAULT
    bmu.heal("sensor_failure")
    vcu.run(1.0)
    assert SignalState.INVALID not in cells(vcu).values()
    assert vcu.last(B2V_ST1).fault_levl is FaultLevel.NORMAL
