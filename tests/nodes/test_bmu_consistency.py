"""The messages of a simulated pack agree with each other, while it drives and while it charges."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace

import pytest
from nodes.outside import Outside, alone

from swapcan.messages import (
    B2V_ST0,
    B2V_ST1,
    B2V_ST2,
    B2V_ST3,
    B2V_ST4,
    B2V_ST5,
    B2V_ST6,
    V2B_CMD,
    B2V_Temp,
    B2V_Ucell,
    BmsState,
    C2B_ACStatus,
    ChargerOperation,
    ChargeState,
    HvCommand,
    RelayState,
)
from swapcan.nodes.bmu import Bmu
from swapcan.plant.battery import Battery, Layout
from typedcan.model.signal_state import SignalState
from typedcan.wire.message import Message

ON = V2B_CMD(hv_on_off=HvCommand.HV_ON, vehicle_speed=0.0)
CYCLE = 0.1
LAYOUT = Layout(cscs=3, cells=14, probes=4, capacity=100.0)
"""No multiple of what goes into a frame."""


@pytest.fixture(scope="module")
def heard() -> Iterator[list[tuple[float, Message]]]:
    """Half a minute of driving, off, and some charging."""
    with alone(
        lambda bus, clock: Bmu(bus, clock=clock, seed=7, battery=Battery(LAYOUT, soc=0.31, seed=7))
    ) as (_, others, _):
        drive(others)
        charge(others)
        assert not others.faults
        yield others.heard


def drive(others: Outside) -> None:
    others.say(ON)
    others.run(3.0)
    for second in range(30):
        speed = round(30 - 30 * math.cos(second / 15 * math.pi))
        others.say(replace(ON, vehicle_speed=float(speed)))
        others.run(1.0)
    others.say(replace(ON, hv_on_off=HvCommand.HV_OFF))
    others.run(4.0)


def charge(others: Outside) -> None:
    voltage = number(others.last(B2V_ST3).upack_batt)
    status = C2B_ACStatus(
        voltage_output=voltage, current_output=0.0, charger_start=ChargerOperation.ON
    )
    others.say(status)
    others.run(1.5)
    for _ in range(20):
        others.say(replace(status, current_output=40.0))
        others.run(1.0)
    assert others.last(B2V_ST1).chg_st is ChargeState.CHARGING


def number(value: object) -> float:
    """A value that is one."""
    assert isinstance(value, int | float)
    return value


def whole(value: object) -> int:
    """A value that is a whole number."""
    assert isinstance(value, int)
    return value


def by_cycle(heard: list[tuple[float, Message]], kind: type[Message]) -> dict[int, Message]:
    """The messages of a kind by the number of the measurement that they are of."""
    return {
        math.floor(time / CYCLE + 1e-6): message for time, message in heard if type(message) is kind
    }


def readings(
    heard: list[tuple[float, Message]],
    kind: type[B2V_Ucell] | type[B2V_Temp],
    start: str,
    per_frame: int,
) -> dict[int, dict[tuple[int, int], float]]:
    """The readings of each complete cycle by measurement, then by CSC and position."""
    found: dict[int, dict[tuple[int, int], float]] = defaultdict(dict)
    measurement = -1
    for time, message in heard:
        if not isinstance(message, kind):
            continue
        csc, frame = whole(message.csc_no), whole(message.frame_no)
        if (csc, frame) == (1, 1):
            # All frames of a cycle are made when its first one is sent.
            measurement = math.floor(time / CYCLE + 1e-6)
        names = [name for name in kind.FIELDS if name.startswith(start)]
        assert len(names) == per_frame
        for offset, name in enumerate(names, 1):
            value = getattr(message, name)
            if not isinstance(value, SignalState):
                found[measurement][csc, per_frame * (frame - 1) + offset] = value
    return found


def test_the_extremes_are_those_of_the_cells_that_are_sent(
    heard: list[tuple[float, Message]],
) -> None:
    cells = readings(heard, B2V_Ucell, "csc_no_ucell", 3)
    highest, lowest = by_cycle(heard, B2V_ST5), by_cycle(heard, B2V_ST6)
    checked = 0
    for cycle in cells.keys() & highest.keys() & lowest.keys():
        values = cells[cycle]
        if len(values) < 42:
            continue  # the first and the last may be cut off
        top, bottom = highest[cycle], lowest[cycle]
        assert isinstance(top, B2V_ST5)
        assert isinstance(bottom, B2V_ST6)
        assert top.max_ucell == max(values.values())
        assert bottom.min_ucell == min(values.values())
        assert values[whole(top.max_ucell_csc_no), whole(top.max_ucell_position)] == top.max_ucell
        assert (
            values[whole(bottom.min_ucell_csc_no), whole(bottom.min_ucell_position)]
            == bottom.min_ucell
        )
        assert number(top.avg_ucell) == pytest.approx(sum(values.values()) / 42, abs=0.0011)
        checked += 1
    assert checked > 500


def test_the_pack_has_the_voltage_of_the_cells_that_are_sent(
    heard: list[tuple[float, Message]],
) -> None:
    cells, packs = readings(heard, B2V_Ucell, "csc_no_ucell", 3), by_cycle(heard, B2V_ST3)
    for cycle in cells.keys() & packs.keys():
        pack = packs[cycle]
        assert isinstance(pack, B2V_ST3)
        if len(cells[cycle]) == 42:
            assert number(pack.upack_batt) == pytest.approx(sum(cells[cycle].values()), abs=0.051)


def test_the_extremes_are_those_of_the_probes_that_are_sent(
    heard: list[tuple[float, Message]],
) -> None:
    probes, extremes = readings(heard, B2V_Temp, "csc_no_temp", 6), by_cycle(heard, B2V_ST4)
    checked = 0
    for cycle in probes.keys() & extremes.keys():
        values, extreme = probes[cycle], extremes[cycle]
        if len(values) < 12:
            continue
        assert isinstance(extreme, B2V_ST4)
        assert extreme.max_temp == max(values.values())
        assert extreme.min_temp == min(values.values())
        at = (whole(extreme.max_temp_csc_no), whole(extreme.max_temp_position))
        assert values[at] == extreme.max_temp
        assert number(extreme.min_temp) <= number(extreme.avg_temp) <= number(extreme.max_temp)
        checked += 1
    assert checked > 250


def test_the_state_of_charge_follows_the_current(heard: list[tuple[float, Message]]) -> None:
    messages = [message for _, message in heard if isinstance(message, B2V_ST2)]
    start = number(messages[0].soc)
    ampere_seconds = 0.0
    for message in messages:
        ampere_seconds += number(message.current) * CYCLE
        # 100 Ah are 360,000 As; SOC comes in steps of 0.4 %.
        expected = start - ampere_seconds / 3600
        assert number(message.soc) == pytest.approx(expected, abs=0.45)
    assert min(number(message.soc) for message in messages) < start
    assert min(number(message.current) for message in messages) < -30


def test_the_state_fits_the_relays(heard: list[tuple[float, Message]]) -> None:
    relays, states = by_cycle(heard, B2V_ST0), by_cycle(heard, B2V_ST1)
    seen = set()
    for cycle in relays.keys() & states.keys():
        relay, status = relays[cycle], states[cycle]
        assert isinstance(relay, B2V_ST0)
        assert isinstance(status, B2V_ST1)
        both = relay.st_main_pos == relay.st_main_neg == RelayState.CLOSED
        if status.bms is BmsState.HV_CLOSED:
            assert both
        if status.bms is BmsState.HV_OPEN:
            assert not both
        seen.add(status.bms)
    assert seen == {BmsState.HV_OPEN, BmsState.PRECHARGE, BmsState.HV_CLOSED}


def test_the_highest_level_is_that_of_the_alarms(heard: list[tuple[float, Message]]) -> None:
    for _, message in heard:
        if isinstance(message, B2V_ST1):
            levels = [getattr(message, name) for name in message.FIELDS if name.startswith("flt_")]
            assert message.fault_levl == max(levels)
