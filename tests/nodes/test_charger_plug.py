"""A charger that is silent is told from one that is unplugged, where both are simulated."""

from __future__ import annotations

from rules.recorded import recorded

import swapcan
from swapcan.messages import B2V_ST1, ChargeLine, ChargeState


def told(plan: str, *faults: str, seconds: float) -> list[tuple[float, B2V_ST1]]:
    """What the pack says, and when."""
    frames = recorded(plan, *faults, seconds=seconds, nodes=("BMU", "CHG"))
    messages = [
        (frame.timestamp, swapcan.decode(frame.arbitration_id, bytes(frame.data)))
        for frame in frames
    ]
    return [(time, message) for time, message in messages if isinstance(message, B2V_ST1)]


def test_a_plugged_charger_that_falls_silent_is_a_charge_error() -> None:
    status = told("charge@0.5s", "CHG.bus_silence@6s", seconds=10.0)
    assert [each.chg_st for time, each in status if 4 < time < 6][-1] is ChargeState.CHARGING
    assert {each.chg_line for time, each in status if time > 2} == {ChargeLine.CONNECTED}
    assert status[-1][1].chg_st is ChargeState.CHARGE_ERROR


def test_an_unplugged_charger_is_not_connected_from_then_on() -> None:
    status = told("charge@0.5s+6s", seconds=8.0)
    after = [each for time, each in status if time > 6.7]
    assert {each.chg_line for each in after} == {ChargeLine.NOT_CONNECTED}
    assert {each.chg_st for each in after} == {ChargeState.READY_TO_BE_CHARGING}
