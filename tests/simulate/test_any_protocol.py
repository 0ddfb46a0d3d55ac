"""Simulated buses, worlds and faults of frames serve protocols of others, of 11 bits too."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import can
import cantools
import pytest
from simulate.crane import (
    BEACON,
    BRAKE,
    CODEC,
    CRANE,
    LIFT,
    STATE,
    STOP,
    UP,
    Panel,
    Winch,
    crc8,
    lift_bytes,
    state_frame,
)

from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.node.clock import SimulatedClock
from typedcan.node.node import Node
from typedcan.simulate.faults import FaultKind, Faults
from typedcan.simulate.faulty_bus import FaultyBus
from typedcan.simulate.participant import Participant
from typedcan.simulate.simulated_bus import SimulatedBus, SimulatedWire
from typedcan.simulate.times import PlanError
from typedcan.simulate.world import World
from typedcan.wire.link import Link
from typedcan.wire.message import Message

BOTH = Path(__file__).parents[1] / "fixtures" / "databases" / "both.dbc"
JAM = FaultKind("jammed", "the winch jams", ("WINCH",))


class Rig:
    """A panel and a winch on a wire, on which somebody listens; the panel's bus can have faults."""

    def __init__(self, stack: ExitStack) -> None:
        self.clock = SimulatedClock()
        wire = SimulatedWire(self.clock)
        self.bus = stack.enter_context(FaultyBus(SimulatedBus(wire), CRANE, clock=self.clock))
        self.listener = stack.enter_context(SimulatedBus(wire))
        self.panel = Panel(self.bus, self.clock)
        self.winch = Winch(stack.enter_context(SimulatedBus(wire)), self.clock)
        self.world = World(self.panel, self.winch, clock=self.clock, wires=(wire,))

    def heard(self, number: int) -> list[can.Message]:
        """What came with an identifier since this was asked last."""
        frames = []
        while frame := self.listener.recv(0):
            frames.append(frame)
        return [frame for frame in frames if frame.arbitration_id == number]


@pytest.fixture
def rig() -> Iterator[Rig]:
    with ExitStack() as stack:
        yield Rig(stack)


def test_a_panel_and_a_winch_of_11_bits_live_in_a_world(rig: Rig) -> None:
    rig.world.at(1.0, lambda: setattr(rig.panel, "wanted", UP))
    rig.world.run(2.05)
    assert rig.winch.moves
    frames = rig.heard(0x101)
    assert not any(frame.is_extended_id for frame in frames)
    assert [frame.data[1] for frame in frames] == [1 + number % 15 for number in range(len(frames))]
    assert {frame.data[2] for frame in frames if frame.timestamp < 1.0} == {STOP}
    assert {frame.data[2] for frame in frames if frame.timestamp > 1.1} == {UP}
    assert all(frame.data[0] == crc8(bytes(frame.data[1:])) for frame in frames)
    gaps = [b.timestamp - a.timestamp for a, b in itertools.pairwise(frames)]
    assert gaps == pytest.approx([0.1] * len(gaps), abs=1e-9)
    assert len(frames) in (20, 21)


def test_a_physical_fault_is_the_participants(rig: Rig) -> None:
    rig.panel.wanted = UP
    rig.world.run(1.0)
    assert rig.winch.moves
    rig.winch.inject("jammed")
    rig.world.run(1.0)
    assert {frame.data[0] for frame in rig.heard(0x181)[-5:]} == {0}


def test_a_stuck_counter_keeps_its_value_under_a_right_checksum(rig: Rig) -> None:
    rig.world.run(0.35)
    before = rig.heard(0x101)[-1].data[1]
    rig.bus.inject("stuck_counter", LIFT)
    rig.panel.wanted = UP
    rig.world.run(0.5)
    stuck = before % 15 + 1
    frames = rig.heard(0x101)
    assert {bytes(frame.data) for frame in frames} == {lift_bytes(UP, stuck)}
    assert len(frames) == 5


def test_a_wrong_checksum_is_that_of_one_frame_in_four_and_nothing_else_of_it(rig: Rig) -> None:
    rig.bus.inject("wrong_checksum")
    rig.world.run(0.85)
    frames = rig.heard(0x101)
    wrong = [
        number for number, each in enumerate(frames) if each.data[0] != crc8(bytes(each.data[1:]))
    ]
    assert wrong == [0, 4, 8][: len(wrong)]
    assert len(wrong) >= 2
    assert {bytes(frame.data[2:]) for frame in frames} == {bytes((STOP, 7))}


@pytest.fixture
def ends() -> Iterator[tuple[FaultyBus, SimulatedBus]]:
    """A bus with faults, and the other end."""
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with FaultyBus(SimulatedBus(wire), CRANE, clock=clock) as one, SimulatedBus(wire) as two:
        yield one, two


def sent(ends: tuple[FaultyBus, SimulatedBus], *messages: Message) -> list[tuple[int, bool]]:
    """Numbers and widths of what of these messages gets through."""
    link = Link(ends[0], CODEC)
    for message in messages:
        link.send(message)
    arrived = []
    while frame := ends[1].recv(0):
        arrived.append((frame.arbitration_id, frame.is_extended_id))
    return arrived


def test_one_number_in_both_widths_is_two_messages(
    ends: tuple[FaultyBus, SimulatedBus],
) -> None:
    lift, beacon = LIFT(motion=STOP), BEACON()  # type: ignore[call-arg]
    ends[0].inject("bus_silence", LIFT)
    assert sent(ends, lift, beacon) == [(0x101, True)]
    ends[0].heal("bus_silence")
    ends[0].inject("lost_frame", every=2)
    assert sent(ends, lift, beacon, lift, beacon) == [(0x101, False), (0x101, True)]
    ends[0].heal("lost_frame")
    ends[0].inject("late_frame", LIFT, every=1)
    assert sent(ends, lift, beacon) == [(0x101, True)]


def test_a_can_fd_frame_that_is_filled_up_is_known_and_stays_as_long(
    ends: tuple[FaultyBus, SimulatedBus],
) -> None:
    brake = BRAKE(hold=0, force=9)  # type: ignore[call-arg]
    Link(ends[0], CODEC).send(brake)
    arrived = ends[1].recv(0)
    assert arrived
    assert (arrived.is_fd, bytes(arrived.data)) == (True, bytes(9) + b"\x09\x00\x00")
    ends[0].inject("bus_silence", BRAKE)
    assert sent(ends, brake) == []


def test_faults_are_planned_by_the_names_of_the_protocol() -> None:
    faults = Faults(CRANE, [JAM])
    assert set(faults.kinds) == {
        *("lost_frame", "late_frame", "stuck_counter", "wrong_checksum", "bus_silence"),
        "jammed",
    }
    assert faults.able_nodes("stuck_counter") == ("PANEL",)
    assert faults.able_nodes("bus_silence") == ("PANEL", "WINCH", "LAMP")
    jam = faults.planned("jammed@2s+1s")
    assert (jam.nodes, jam.messages, jam.start, jam.end) == (("WINCH",), (), 2.0, 3.0)
    lost = faults.planned("State.lost_frame@500ms")
    assert (lost.nodes, lost.messages, str(lost)) == (("WINCH",), (STATE,), "State.lost_frame@0.5s")
    assert faults.planned("PANEL.late_frame@1s").nodes == ("PANEL",)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("jammed", "expected NAME@TIME, such as bus_silence@30s, not 'jammed'"),
        ("PANEL.jammed@1s", "PANEL cannot have jammed; it is for WINCH"),
        ("Beacon.stuck_counter@1s", "the frames of Beacon cannot have stuck_counter"),
        ("Boom.lost_frame@1s", "there is no node or message 'Boom'"),
    ],
)
def test_a_fault_that_nobody_there_can_have_is_refused(text: str, reason: str) -> None:
    with pytest.raises(PlanError, match=f"^{reason}"):
        Faults(CRANE, [JAM]).planned(text)


class Sender(Participant):
    """Sends both messages of a database."""

    name = "AA"

    def __init__(self, node: Node) -> None:
        super().__init__(node)
        for kind in node.protocol.sent_by(self.name):
            (field,) = kind.FIELDS
            node.set(kind(**{field: 5 if kind.EXTENDED else 3}), period=0.2)

    def step(self, now: float) -> None:
        pass


def test_a_world_of_a_database_has_both_widths_as_cantools_reads_them() -> None:
    database = cantools.database.load_file(BOTH)
    protocol = typed_protocol(read_dbc(BOTH))
    clock = SimulatedClock()
    wire = SimulatedWire(clock)
    with SimulatedBus(wire) as bus, SimulatedBus(wire) as listener:
        World(Sender(Node(protocol, "AA", bus, clock=clock)), clock=clock, wires=(wire,)).run(0.5)
        heard = set()
        while frame := listener.recv(0):
            (kind,) = (
                each
                for each in database.messages  # type: ignore[union-attr]
                if (each.frame_id, each.is_extended_frame)
                == (frame.arbitration_id, frame.is_extended_id)
            )
            decoded = kind.decode(bytes(frame.data))
            assert isinstance(decoded, dict)
            heard.add((kind.name, *decoded.items()))
    assert heard == {("SHORTID", ("Left", 3)), ("LONGID", ("Right", 5))}


def test_what_a_winch_says_is_what_was_put_together_by_hand() -> None:
    assert CODEC.frame(STATE(moving=1)).equals(state_frame(1))  # type: ignore[call-arg]
