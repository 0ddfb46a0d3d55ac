"""Live nodes: `Node` sends, receives, supervises and asks; what it tells are its events."""

from swapcan.node.answers import BatteryInfo, Event
from swapcan.node.node import Node
from typedcan.node.errors import StillActingError
from typedcan.node.events import BusBack, BusLost, NodeFailed, Overrun, ReceiveFailed, SendFailed
from typedcan.node.request import Pending
from typedcan.wire.errors import SendingError

__all__ = [
    "BatteryInfo",
    "BusBack",
    "BusLost",
    "Event",
    "Node",
    "NodeFailed",
    "Overrun",
    "Pending",
    "ReceiveFailed",
    "SendFailed",
    "SendingError",
    "StillActingError",
]
