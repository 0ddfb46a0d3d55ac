"""The simulated swap controller, as BMU and VCU see it: table 17 of 5.2.4."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from nodes.outside import Outside, alone

from swapcan.messages import BSU_BMS_0, ConnectorState, LockState, WarningLevel
from swapcan.nodes.bsu import Bsu
from swapcan.nodes.world import World

Controller = tuple[Bsu, Outside, World]


@pytest.fixture
def controller() -> Iterator[Controller]:
    with alone(lambda bus, clock: Bsu(bus, clock=clock)) as all_three:
        yield all_three


def test_the_pack_is_locked_and_connected(controller: Controller) -> None:
    _, others, _ = controller
    others.run(1.0)
    last = others.last(BSU_BMS_0)
    assert (last.lock, last.connect_st) == (LockState.LOCKED, ConnectorState.CONNECTED)
    assert last.conctor_temp_warn == WarningLevel.INACTIVE


def test_the_live_counter_runs_through_all_256_values(controller: Controller) -> None:
    _, others, _ = controller
    others.run(60.0)
    values = [message.live for message in others.all(BSU_BMS_0)]
    assert len(values) == 600
    assert values == [number % 256 for number in range(600)]


def test_an_unlocked_pack_is_not_connected(controller: Controller) -> None:
    bsu, others, _ = controller
    bsu.unlock()
    others.run(0.2)
    last = others.last(BSU_BMS_0)
    assert (last.lock, last.connect_st) == (LockState.UNLOCKED, ConnectorState.NOT_CONNECTED)
    bsu.lock()
    others.run(0.2)
    assert others.last(BSU_BMS_0).lock == LockState.LOCKED


def test_a_hot_connector_warns_in_three_levels_and_cools_down_again(
    controller: Controller,
) -> None:
    bsu, others, _ = controller
    bsu.inject("connector_over_temperature")
    others.run(20.0)
    levels = [message.conctor_temp_warn for message in others.all(BSU_BMS_0)]
    assert sorted(set(levels)) == list(WarningLevel)
    assert levels == sorted(levels)
    temperature = others.last(BSU_BMS_0).connector_temp
    assert isinstance(temperature, float)
    assert temperature > 90.0
    bsu.heal("connector_over_temperature")
    others.run(20.0)
    assert others.last(BSU_BMS_0).conctor_temp_warn == WarningLevel.INACTIVE
