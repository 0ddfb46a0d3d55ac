"""A simulated pack alone with an outside that plays all others."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from nodes.bmu_talk import ON, Pack
from nodes.outside import alone

from swapcan.messages import B2V_ST1, BmsState
from swapcan.nodes.bmu import Bmu


@pytest.fixture
def pack() -> Iterator[Pack]:
    with alone(lambda bus, clock: Bmu(bus, clock=clock)) as all_three:
        yield all_three


@pytest.fixture
def closed(pack: Pack) -> Pack:
    """A pack that has switched high voltage on."""
    _, vcu, _ = pack
    vcu.say(ON)
    vcu.run(2.5)
    assert vcu.last(B2V_ST1).bms is BmsState.HV_CLOSED
    return pack
