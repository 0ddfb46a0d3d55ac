"""Lets simulated nodes live on a real bus: looks out for others first, and leaves it safe.

However that ends, by an exception of any part or by a signal, the safe codes of what acts are
sent first, without receiving or recording before. What no program can do is to send where its
process is killed (SIGKILL) or crashes, the machine stops or the driver hangs: then what is
commanded holds until the timeout of who receives it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from enum import Enum
from functools import partial

from typedcan.drive.departure import Departure
from typedcan.drive.noting_bus import NotingBus
from typedcan.drive.watchdog import Watchdog
from typedcan.model.errors import TypedcanError
from typedcan.node.clock import Clock
from typedcan.simulate.participant import Participant
from typedcan.simulate.simulated_bus import SimulatedWire
from typedcan.simulate.world import World
from typedcan.wire.message import Message

LOOK_OUT = 2.0
"""Seconds at least in which nobody else may send what is to be sent."""

_LOOK_OUT_PERIODS = 2
"""The same in periods of what each sender sends most often."""

LEAVING = 5.0
"""Seconds at most in which others are told to switch off before nothing is sent any more."""

_LEAVING_AT_LEAST = 0.5
"""Enough for some commands to switch off and for some reports, where their periods are short."""

_SLICE = 0.05
"""Seconds between two looks at whether to go on."""

_MOMENT = 1e-6
"""Seconds that are too few to let them pass."""

_TROUBLE = 1.0
"""Seconds for which a bus may refuse to work before driving is given up."""

_MANY = 1000
"""Frames that are taken in one go: more than come in a slice, and not without end."""

_ATTEMPTS = 100
"""How often leaving begins anew where something breaks into it."""


def look_out_time(played: Iterable[type[Message]]) -> float:
    """Seconds in which nobody else may send any of those messages."""
    shortest: dict[str, float] = {}
    for kind in played:
        if kind.PERIOD:
            shortest[kind.SENDER] = min(kind.PERIOD, shortest.get(kind.SENDER, math.inf))
    return max([LOOK_OUT, *(_LOOK_OUT_PERIODS * period for period in shortest.values())])


class BusyBusError(TypedcanError):
    """Somebody else sends a message that is to be sent here; ``message`` is its class."""

    def __init__(self, message: type[Message]) -> None:
        self.message = message
        number = f"0x{message.FRAME_ID:0{8 if message.EXTENDED else 3}X}"
        super().__init__(
            f"another {message.SENDER} is on the bus: {message.NAME} ({number}) comes from"
            " somebody else; nothing is sent beside it"
        )


class Left(Enum):
    """How those who act on commands were left."""

    SAFE = "they have reported that they are off"
    UNKNOWN = "they have not reported that they are off"
    UNTOUCHED = "nothing was sent"


class Driving:
    """Some nodes' life on buses that are lent.

    Parameters
    ----------
    buses
        On which they live.
    clock, wires
        As `World` has them.
    is_over
        Is asked again and again whether to end before the time.
    watch
        Is told how many seconds have passed, and of how many.
    warn
        Is told, in a thread of its own, that the program hangs and what acts was ended.

    ``interrupted`` is what broke into the leaving, such as `KeyboardInterrupt`, if anything did.
    """

    def __init__(
        self,
        buses: Sequence[NotingBus],
        *,
        clock: Clock,
        wires: tuple[SimulatedWire, ...] = (),
        is_over: Callable[[], bool] = lambda: False,
        watch: Callable[[float, float], object] = lambda _passed, _all: None,
        warn: Callable[[], object] = lambda: None,
    ) -> None:
        self._buses = buses
        self._clock = clock
        self._wires = wires
        self._is_over = is_over
        self._watch = watch
        self._watchdog = Watchdog(buses, clock, warn)
        self.interrupted: BaseException | None = None

    @property
    def hangs(self) -> bool:
        """Whether nothing has gone on for too long."""
        return self._watchdog.is_late

    def look_out(self, seconds: float | None = None) -> None:
        """See that nobody else sends what is to be sent, for `look_out_time` unless it is said.

        Raises `BusyBusError`, `OtherEditionError`, and as `live`.
        """
        played = [kind for bus in self._buses for kind in bus.played]
        self.live(self._hearing(), look_out_time(played) if seconds is None else seconds)

    def live(self, world: World, seconds: float) -> None:
        """Let time pass, unless it is to end, or cannot go on.

        Raises `BusyBusError`, `OtherEditionError`, `HungError`, what a bus has raised for a second,
        what a recorder has raised, and what the world and the callbacks raise.
        """
        with self._watchdog:
            while (left := seconds - world.elapsed) > _MOMENT and not self._is_over():
                world.run(min(left, _SLICE))
                self._watchdog.check()
                self._watchdog.beat()
                self._watch(world.elapsed, seconds)
                for bus in self._buses:
                    self._check(bus)

    def leave(self, departure: Departure) -> Left:
        """Send the safe codes, and go on until those who act report that they are off.

        Nothing cuts that short: neither an exception of any kind nor ``is_over``. No code that
        acts is sent any more, whatever the nodes want.
        """
        begin = self._clock.now()
        for _ in range(_ATTEMPTS):
            try:
                with self._watchdog:
                    return self._leave(departure, begin)
            except BaseException as error:  # noqa: BLE001 - is raised once all is off
                self.interrupted = self.interrupted or error
        return Left.UNKNOWN

    def _leave(self, departure: Departure, begin: float) -> Left:
        for bus in self._buses:
            bus.has_ended = True
        for heal in departure.heal:
            self._try(heal)
        everybody = (*departure.stand_still, *departure.live_on)
        self._send_safe_codes(everybody)
        for withdraw in departure.withdraw:
            self._try(withdraw)
        # What is still planned is for the other world.
        world = World(*departure.live_on, clock=self._clock, wires=self._wires)
        while (passed := self._clock.now() - begin) < LEAVING - _MOMENT:
            self._let_pass(world)
            self._try(self._hear)  # who lives on may be on none of the buses
            self._watchdog.beat()
            if self._acts or (passed < _LEAVING_AT_LEAST and self._is_quiet):
                self._send_safe_codes(everybody)
            elif passed < _LEAVING_AT_LEAST:
                self._send_those_of(departure.stand_still)
            is_enough = passed + _SLICE >= _LEAVING_AT_LEAST - _MOMENT
            if is_enough and not self._acts and departure.are_off():
                return Left.SAFE
        return Left.UNKNOWN

    @property
    def _acts(self) -> bool:
        return any(bus.acting for bus in self._buses)

    @property
    def _is_quiet(self) -> bool:
        """Whether nobody commands anything, be it that something is wrong with the nodes."""
        last = max(bus.commanded_at for bus in self._buses)
        return self._clock.now() - last > 1.5 * _SLICE

    def _check(self, bus: NotingBus) -> None:
        if bus.intruder:
            raise BusyBusError(bus.intruder)
        if bus.other_edition and (bus.played or bus.has_acted):
            raise bus.other_edition
        if bus.failure:
            raise bus.failure
        if self._lasting_trouble(bus):
            with suppress(Exception):  # nodes try less often: it may be back
                bus.recv(0)
            if trouble := self._lasting_trouble(bus):
                raise trouble

    def _lasting_trouble(self, bus: NotingBus) -> Exception | None:
        """What a bus has raised for too long, if anything."""
        if bus.trouble is None or self._clock.now() - bus.trouble[0] < _TROUBLE:
            return None
        return bus.trouble[1]

    def _hearing(self) -> World:
        """A world in which the buses are heard, and nobody lives."""
        world = World(clock=self._clock, wires=self._wires)
        world.after_each_step(self._hear)
        return world

    def _hear(self) -> None:
        """Take what nobody has taken yet."""
        for bus in self._buses:
            with suppress(Exception):  # the bus keeps it as its trouble
                for _ in range(_MANY):
                    if bus.recv(0) is None:
                        break

    def _send_safe_codes(self, participants: Sequence[Participant]) -> None:
        """By the nodes, whose counters go on, and where that fails on the bare buses."""
        self._send_those_of(participants)
        for bus in self._buses:
            if bus.acting:
                self._note(bus.send_safe_codes())

    def _send_those_of(self, participants: Sequence[Participant]) -> None:
        for participant in participants:
            for node in participant.nodes:
                self._try(node.send_safe_codes)

    def _let_pass(self, world: World) -> None:
        """Let a slice of time pass, whatever is wrong with those who live in it."""
        begin = self._clock.now()
        self._try(lambda: world.run(_SLICE))
        for other in (self._hearing(), World(clock=self._clock, wires=self._wires)):
            left = begin + _SLICE - self._clock.now()
            if left > _MOMENT:
                self._try(partial(other.run, left))

    def _try(self, action: Callable[[], object]) -> None:
        try:
            action()
        except BaseException as error:  # noqa: BLE001 - what is left to do does not depend on it
            self._note(error)

    def _note(self, error: BaseException | None) -> None:
        """Keep what is raised once all is off: what is no Exception was meant to end more."""
        if error and not isinstance(error, Exception):
            self.interrupted = self.interrupted or error
