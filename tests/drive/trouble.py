"""What may go wrong while a pack is driven: any exception, of any part, once or for good."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Callable, Collection
from dataclasses import replace
from enum import Enum

import can
from drive.quick_pack import command_in
from scenarios.lines import values
from scenarios.rig import Bench

# Tests replace the scenarios: what a command imports when it is chosen is to know the real ones.
from swapcan.commands import conform_driving  # noqa: F401
from swapcan.messages import V2B_CMD, BmsState, HvCommand, RelayState
from swapcan.nodes.plan import plan_of
from swapcan.scenarios.scenario import Scenario
from swapcan.scenarios.stage import Stage
from typedcan.report.language import Text


class DriverError(Exception):
    """What no interface should raise."""


class UnprintableError(Exception):
    """One that cannot even be shown."""

    def __str__(self) -> str:
        raise ValueError("no text")


EXCEPTIONS: tuple[Callable[[], Exception], ...] = (
    lambda: can.CanError("gone"),
    lambda: can.CanOperationError("gone", 5),
    lambda: can.CanInitializationError("gone"),
    lambda: can.CanTimeoutError("gone"),
    lambda: OSError(5, "gone"),
    lambda: BrokenPipeError(32, "gone"),
    lambda: ValueError("gone"),
    lambda: IndexError("list index out of range"),
    lambda: KeyError("gone"),
    lambda: TypeError("gone"),
    lambda: AttributeError("gone"),
    lambda: RuntimeError("gone"),
    lambda: OverflowError("gone"),
    AssertionError,
    lambda: struct.error("gone"),
    lambda: UnicodeDecodeError("ascii", b"\xff", 0, 1, "gone"),
    StopIteration,
    MemoryError,
    lambda: RecursionError("gone"),
    lambda: DriverError("gone"),
    UnprintableError,
)
"""What is trouble: it is reported, and the run goes on where that makes sense."""

OTHERS: tuple[Callable[[], BaseException], ...] = (
    KeyboardInterrupt,
    lambda: SystemExit(0),
    lambda: SystemExit("gone"),
    GeneratorExit,
    asyncio.CancelledError,
)
"""What means that the program is to end."""

SCENARIO = Scenario(
    name="on-off",
    title=Text("high voltage on and off", "高压通断"),
    plays=("VCU",),
    plan=plan_of("hv_on@300ms, hv_off@2s"),
    seconds=3.5,
    rules=(),
)
"""High voltage on and off, in less time than the one that is judged."""

QUICK = replace(SCENARIO, plan=plan_of("hv_on@200ms, hv_off@1s"), seconds=1.3)
"""The same in real time, for a pack that does at once as it is told."""


class Phase(Enum):
    """How far switching on and off is."""

    OFF = "off"
    REPORTED = "contactors of the truck reported closed"
    COMMANDED = "commanded on, still open"
    PRECHARGE = "precharging"
    CLOSED = "closed"
    SWITCHING_OFF = "commanded off again"


class Progress:
    """Looks how far a pack and who drives it are, by the bytes on the wire and by its relays."""

    def __init__(self, rig: Bench) -> None:
        self._rig = rig
        self._was_closed = False
        self._last: dict[str, object] | None = None
        self.commands: list[HvCommand] = []

    def look(self, coming: can.Message | None = None) -> Phase | None:
        """The phase once a frame is sent that is about to be; None before the first command."""
        last = self._last
        while frame := self._rig.listener.recv(0):
            if frame.arbitration_id == V2B_CMD.FRAME_ID:
                last = self._last = values(frame)
                self.commands.append(command_in(frame))
        if coming is not None and coming.arbitration_id == V2B_CMD.FRAME_ID:
            last = values(coming)
        if last is None:
            return None
        state = self._rig.pack.pack.high_voltage.state
        self._was_closed |= state is BmsState.HV_CLOSED
        if last["V2B_CMD_HV_OnOff"] == HvCommand.HV_OFF:
            if self._was_closed:
                return Phase.SWITCHING_OFF
            is_reported = last["V2B_CMD_MainMotorConST"] == RelayState.CLOSED
            return Phase.REPORTED if is_reported else Phase.OFF
        return {BmsState.PRECHARGE: Phase.PRECHARGE, BmsState.HV_CLOSED: Phase.CLOSED}.get(
            state, Phase.COMMANDED
        )


class Trouble:
    """Raises from a moment on, once or for good."""

    def __init__(
        self,
        error: Callable[[], BaseException],
        begins: Callable[[can.Message | None], bool],
        *,
        for_good: bool,
    ) -> None:
        self._error, self._begins, self._for_good = error, begins, for_good
        self.raised = 0

    def __call__(self, *given: object) -> None:
        """Raise, if it is time."""
        if self.raised and not self._for_good:
            return
        coming = next((each for each in given if isinstance(each, can.Message)), None)
        if self.raised or self._begins(coming):
            self.raised += 1
            raise self._error()


def nothing(*_: object) -> None:
    """Raise nothing."""


class TroubledBus(can.BusABC):
    """A bus that may raise before or after it does what it is asked to."""

    def __init__(
        self,
        bus: can.BusABC,
        *,
        send: Callable[[can.Message], object] = nothing,
        sent: Callable[[], object] = nothing,
        recv: Callable[[], object] = nothing,
    ) -> None:
        self._bus, self._before_send, self._after_send, self._before_recv = bus, send, sent, recv
        super().__init__(channel="troubled")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self._before_send(msg)
        self._bus.send(msg, timeout)
        self._after_send()

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self._before_recv()
        return self._bus.recv(timeout), False


PLACES = ("recv", "send", "sent", "note", "watch", "is_over")
"""Who raises: the bus, before it does something or although it has, or what is called back."""


def play(
    rig: Bench,
    trouble: Trouble,
    place: str,
    scenario: Scenario = SCENARIO,
    nodes: Collection[str] = ("VCU",),
) -> tuple[Stage, BaseException | None]:
    """Play a scenario with trouble in one place; the stage, and what came of it."""
    at = {each: trouble if each == place else nothing for each in PLACES}

    def is_over() -> bool:
        at["is_over"]()
        return False

    with TroubledBus(rig.tester, send=at["send"], sent=at["sent"], recv=at["recv"]) as bus:
        stage = Stage(bus, clock=rig.clock, wires=(rig.wire,), is_over=is_over, watch=at["watch"])
        try:
            stage.play(scenario, tuple(nodes), at["note"])
        except BaseException as error:  # noqa: BLE001 - is what the tests are about
            return stage, error
    return stage, None
