"""A protocol of somebody else's in which codes act: a panel moves a winch, by frames of 11 bits.

`Lift` has an alive counter from 1 to 15 and a CRC-8; `Beacon` has its number with 29 bits and
commands nothing; `Brake` is a CAN FD frame of 10 bytes, which fills 12; `Valve` is known by its
PGN, and goes to a receiver with an address. Their bytes here are put together by hand.
"""

from __future__ import annotations

from decimal import Decimal
from typing import Any, ClassVar

import can
from emit.other_protocol import signal

from typedcan.dynamic import typed_protocol
from typedcan.model.acting import ActingCodes
from typedcan.model.protection import Checksum, Counter
from typedcan.model.protocol import Code, Message, Node, Protocol, SendType, ValueTable
from typedcan.node.clock import Clock
from typedcan.node.node import Node as LiveNode
from typedcan.simulate.participant import Participant
from typedcan.wire.codec import Codec
from typedcan.wire.link import Received
from typedcan.wire.message import Message as Message_

STOP, UP, DOWN = 0, 1, 2
RELEASED, HELD = 1, 0


def _table(name: str, *labels: str) -> ValueTable:
    return ValueTable(name, tuple(Code(code, label, label) for code, label in enumerate(labels)))


_MOTION = _table("Motion", "Stop", "Up", "Down")
_BRAKE = _table("Hold", "Held", "Released")
_VALVE = _table("Opens", "Shut", "Open")
_STATE = _table("Moving", "Stands", "Moves")

MODEL = Protocol(
    name="crane",
    nodes=(Node(name="PANEL"), Node(name="WINCH"), Node(name="LAMP")),
    messages=(
        Message(
            name="Lift",
            frame_id=0x101,
            extended=False,
            length=4,
            sender="PANEL",
            period=100,
            send_type=SendType.CYCLIC,
            signals=(
                signal("Check", 0, 8),
                signal("Alive", 8, 4, minimum=Decimal(1)),
                signal(
                    "Motion",
                    16,
                    2,
                    value_table=_MOTION,
                    receivers=("WINCH",),
                    acting=ActingCodes(codes=(UP, DOWN), safe=STOP),
                ),
                signal("Load", 24, 8, receivers=("WINCH",)),
            ),
            checksum=Checksum(signal="Check", algorithm="crc8_sae_j1850", covered=(1, 2, 3)),
            counter=Counter(signal="Alive", modulus=15, first=1),
        ),
        Message(
            name="Beacon",
            frame_id=0x101,
            length=1,
            sender="LAMP",
            period=1000,
            send_type=SendType.CYCLIC,
            signals=(signal("Lit", 0, 8, receivers=("PANEL",)),),
        ),
        Message(
            name="Brake",
            frame_id=0x102,
            extended=False,
            length=10,
            is_fd=True,
            bit_rate_switch=True,
            sender="PANEL",
            period=5000,
            send_type=SendType.CYCLIC,
            signals=(
                signal(
                    "Hold",
                    0,
                    1,
                    value_table=_BRAKE,
                    receivers=("WINCH",),
                    acting=ActingCodes(codes=(RELEASED,), safe=HELD),
                ),
                signal("Force", 72, 8, receivers=("WINCH",)),
            ),
        ),
        Message(
            name="Valve",
            frame_id=0x0CEF00FE,
            length=8,
            by_pgn=True,
            sender="PANEL",
            signals=(
                signal(
                    "Opens",
                    0,
                    2,
                    value_table=_VALVE,
                    receivers=("WINCH",),
                    acting=ActingCodes(codes=(1,), safe=0),
                ),
            ),
        ),
        Message(
            name="State",
            frame_id=0x181,
            extended=False,
            length=1,
            sender="WINCH",
            period=100,
            send_type=SendType.CYCLIC,
            signals=(
                signal(
                    "Moving",
                    0,
                    1,
                    value_table=_STATE,
                    receivers=("PANEL",),
                    acting=ActingCodes(codes=(1,), safe=0, reports=True),
                ),
            ),
        ),
    ),
)
CRANE = typed_protocol(MODEL)
CODEC = Codec(CRANE)
LIFT, BEACON, BRAKE, VALVE, STATE = CRANE.messages


def crc8(data: bytes) -> int:
    """SAE J1850 bit by bit: polynomial 0x1D, begun with ones, inverted."""
    value = 0xFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = (value << 1 ^ 0x1D if value & 0x80 else value << 1) & 0xFF
    return value ^ 0xFF


def lift_bytes(motion: int, alive: int, load: int = 7) -> bytes:
    """The payload of `Lift`."""
    rest = bytes((alive, motion, load))
    return bytes((crc8(rest), *rest))


def lift_frame(motion: int, alive: int = 1) -> can.Message:
    """A frame of `Lift`."""
    data = lift_bytes(motion, alive)
    return can.Message(arbitration_id=0x101, is_extended_id=False, data=data, is_rx=False)


def state_frame(moving: int) -> can.Message:
    """A frame of `State`."""
    return can.Message(arbitration_id=0x181, is_extended_id=False, data=[moving], is_rx=False)


class Panel(Participant):
    """Commands what it is told to; ``wanted`` is the motion."""

    name = "PANEL"

    def __init__(self, bus: can.BusABC, clock: Clock) -> None:
        self.node = LiveNode(CRANE, self.name, bus, clock=clock)
        super().__init__(self.node)
        self.wanted = STOP
        self.node.supply(LIFT, self.lifts)

    def lifts(self) -> list[Message_]:
        """What it sends of `Lift`."""
        return [LIFT(motion=self.wanted, load=7)]  # type: ignore[call-arg]

    def step(self, now: float) -> None:
        """Nothing changes by itself."""


class Winch(Participant):
    """Moves as it was told last, and says so; it stands still once it is jammed."""

    name = "WINCH"
    faults: ClassVar[frozenset[str]] = frozenset({"jammed"})

    def __init__(self, bus: can.BusABC, clock: Clock) -> None:
        self.node = LiveNode(CRANE, self.name, bus, clock=clock)
        super().__init__(self.node)
        self.moves = False
        self.node.on(LIFT, self._obey)
        self.node.supply(STATE, lambda: [STATE(moving=int(self.moves))])  # type: ignore[call-arg]

    def step(self, now: float) -> None:
        """A jam is noticed at once."""
        self.moves = self.moves and not self.has("jammed")

    def _obey(self, received: Received[Any]) -> None:
        self.moves = received.message.motion != STOP
