"""One bus for several nodes: each hears the others, here and outside, and never itself."""

from __future__ import annotations

from collections.abc import Iterator
from uuid import uuid4

import can
import pytest

from typedcan.simulate.shared_bus import SharedBus


def identifiers(bus: can.BusABC) -> list[int]:
    """What has arrived, and that nothing else comes."""
    found = []
    while received := bus.recv(0):
        found.append(received.arbitration_id)
    return found


@pytest.fixture(params=[False, True], ids=["no_echo", "with_echo"])
def buses(request: pytest.FixtureRequest) -> Iterator[tuple[can.BusABC, can.BusABC]]:
    """The bus to share, which gives back what was sent on it or does not, and another one."""
    channel = f"test-{uuid4()}"
    options = {"ignore_config": True, "receive_own_messages": request.param}
    with (
        can.Bus(channel, "virtual", **options) as bus,
        can.Bus(channel, "virtual", ignore_config=True) as other,
    ):
        yield bus, other


def test_what_a_node_sends_reaches_the_others_once(buses: tuple[can.BusABC, can.BusABC]) -> None:
    bus, outside = buses
    shared = SharedBus(bus)
    with shared.share() as one, shared.share() as two, shared.share() as three:
        one.send(can.Message(arbitration_id=0x100))
        assert identifiers(two) == identifiers(three) == identifiers(outside) == [0x100]
        assert identifiers(one) == []


def test_what_arrives_reaches_all_nodes(buses: tuple[can.BusABC, can.BusABC]) -> None:
    bus, outside = buses
    shared = SharedBus(bus)
    with shared.share() as one, shared.share() as two:
        two.send(can.Message(arbitration_id=0x100))
        outside.send(can.Message(arbitration_id=0x200))
        outside.send(can.Message(arbitration_id=0x201))
        assert identifiers(one) == [0x100, 0x200, 0x201]
        assert identifiers(two) == [0x200, 0x201]


def test_shutting_a_share_down_leaves_the_bus_open(buses: tuple[can.BusABC, can.BusABC]) -> None:
    bus, outside = buses
    SharedBus(bus).share().shutdown()
    bus.send(can.Message(arbitration_id=0x100))
    assert identifiers(outside) == [0x100]


def test_what_another_sends_with_an_identifier_of_ones_own_arrives(
    buses: tuple[can.BusABC, can.BusABC],
) -> None:
    bus, outside = buses
    shared = SharedBus(bus)
    with shared.share() as one, shared.share() as two:
        one.send(can.Message(arbitration_id=0x100, data=b"\x01"))
        outside.send(can.Message(arbitration_id=0x100, data=b"\x02"))
        outside.send(can.Message(arbitration_id=0x100, data=b"\x01", is_extended_id=False))
        heard = [two.recv(0), two.recv(0), two.recv(0), two.recv(0)]
        assert [(bytes(each.data), each.is_extended_id) for each in heard if each] == [
            (b"\x01", True),
            (b"\x02", True),
            (b"\x01", False),
        ]
        assert identifiers(one) == [0x100, 0x100]
    assert (shared.sent, shared.received) == (1, 2)
