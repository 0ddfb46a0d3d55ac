"""Those who listen in the benchmarks of live nodes: nodes of swapcan, and their peers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

import can
import cantools
from cantools.database.can import Database

import swapcan
from swapcan import Message, Received
from swapcan._generated.protocol import PROTOCOL
from swapcan.node import Node

Listen = Callable[[can.BusABC, Callable[[can.Message], None]], AbstractContextManager[object]]
"""Calls back with each frame of a bus while it is entered."""

PEER = "can.Notifier, cantools"


@contextmanager
def _empty(bus: can.BusABC, callback: Callable[[can.Message], None]) -> Iterator[None]:
    with can.Notifier(bus, [callback], timeout=0.1):
        yield


@contextmanager
def bare_cantools(bus: can.BusABC, callback: Callable[[can.Message], None]) -> Iterator[None]:
    """python-can's Notifier, whose listener decodes with cantools."""
    database = cantools.database.load_string(swapcan.dbc_text(), "dbc")
    assert isinstance(database, Database)

    def decode(frame: can.Message) -> None:
        database.decode_message(frame.arbitration_id, bytes(frame.data))
        callback(frame)

    with can.Notifier(bus, [decode], timeout=0.1):
        yield


@contextmanager
def _unread(bus: can.BusABC, callback: Callable[[can.Message], None]) -> Iterator[None]:
    node = Node(PROTOCOL, "VCU", bus)
    node.on(Received, lambda received: callback(received.frame))
    with node:
        yield


@contextmanager
def _read(bus: can.BusABC, callback: Callable[[can.Message], None]) -> Iterator[None]:
    def read(received: Received[Message]) -> None:
        assert received.message
        callback(received.frame)

    node = Node(PROTOCOL, "VCU", bus)
    node.on(Received, read)
    with node:
        yield


LISTENERS: dict[str, Listen] = {
    "can.Notifier, empty": _empty,
    PEER: bare_cantools,
    "Node, every message read": _read,
    "Node, messages not read": _unread,
}
