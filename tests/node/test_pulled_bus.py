"""Pulling the bus: sockets that are closed in mid-run, over a multicast group on this machine."""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator

import can
import pytest
from node.bench import Recorder

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1, B2V_ST2
from swapcan.node import Node
from typedcan.node.events import BusBack, BusLost
from typedcan.supervise import State, StateChanged

GROUP = "239.74.163.2"


@pytest.fixture
def open_socket() -> Iterator[Callable[[], can.BusABC]]:
    """Opens buses of one multicast group and port, and closes them after the test."""
    pytest.importorskip("msgpack", reason="python-can's udp_multicast needs msgpack")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("", 0))
        port = probe.getsockname()[1]
    buses: list[can.BusABC] = []

    def open_one() -> can.BusABC:
        buses.append(can.Bus(GROUP, "udp_multicast", ignore_config=True, port=port))
        return buses[-1]

    try:
        probing = open_one()
    except can.CanError as error:
        pytest.skip(f"no multicast here: {error}")
    probing.send(can.Message(arbitration_id=0x1))
    if probing.recv(1.0) is None:  # every member of a group hears what it sends
        pytest.skip("no multicast here: a datagram to the group does not come back")
    probing.shutdown()
    yield open_one
    for bus in buses:
        bus.shutdown()


def test_the_receiver_reports_a_sender_lost_in_time_and_alive_once_it_is_back(
    open_socket: Callable[[], can.BusABC],
) -> None:
    changed, lost, back = Recorder(), Recorder(), Recorder()
    plugged_in = threading.Event()

    def reopen() -> can.BusABC:
        if not plugged_in.is_set():
            raise can.CanInitializationError("no such device")
        return open_socket()

    pulled = open_socket()
    with (
        Node(PROTOCOL, "VCU", open_socket(), expect=[B2V_ST1]) as vcu,
        Node(PROTOCOL, "BMU", pulled, reopen=reopen) as bmu,
    ):
        vcu.on(StateChanged, changed)
        bmu.on(BusLost, lost)
        bmu.on(BusBack, back)
        bmu.set(B2V_ST1())
        changed.wait_until(lambda event: event.new is State.ALIVE)
        pulled.shutdown()
        silence = changed.wait_until(lambda event: event.new is State.LOST).silence
        assert silence == pytest.approx(0.5, abs=0.15)  # five periods of 0.1 s
        assert back.seen == []
        plugged_in.set()
        changed.wait_until(lambda event: event.old is State.LOST and event.new is State.ALIVE)
        back.wait()
    assert len(lost.seen) == 1
    # The counter went on where the bus had accepted a frame last.
    assert vcu.counts.faults == 0


def test_a_node_whose_own_socket_is_closed_hears_again_on_a_new_one(
    open_socket: Callable[[], can.BusABC],
) -> None:
    lost, back, heard = Recorder(), Recorder(), Recorder()
    pulled = open_socket()
    with (
        Node(PROTOCOL, "VCU", pulled, reopen=open_socket) as vcu,
        Node(PROTOCOL, "BMU", open_socket()) as bmu,
    ):
        vcu.on(BusLost, lost)
        vcu.on(BusBack, back)
        vcu.on(B2V_ST2, heard)
        bmu.set(B2V_ST2())
        heard.wait()
        pulled.shutdown()
        back.wait()
        heard.wait(len(heard.seen) + 2)
    assert len(lost.seen) == 1
