"""A pack that needs next to no time: it does at once as it is told, and says so."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import can
from scenarios.lines import database

from swapcan.messages import V2B_CMD, BmsState, HvCommand

ENOUGH = 30.0
"""Seconds after which a test has failed, on a busy machine too."""

_STEP = 0.01
_PERIOD = 0.1


def command_in(frame: can.Message) -> HvCommand:
    """What V2B_CMD commands: HV_OnOff is bits 4 and 5 of byte 1 (A.1)."""
    return HvCommand(frame.data[1] >> 4 & 3)


class QuickPack:
    """Closes and opens its contactors as V2B_CMD has it; its bytes are cantools'.

    Parameters
    ----------
    bus
        Is lent.
    obeys
        Whether it does; one that does not stays closed once it was.

    ``commands`` are those for high voltage that came; while ``skips`` is True its counter jumps.
    """

    def __init__(self, bus: can.BusABC, *, obeys: bool = True) -> None:
        self._bus = bus
        self._obeys = obeys
        self._changed = threading.Condition()
        self._due = 0.0
        self._count = 0
        self.skips = False
        self.commands: list[HvCommand] = []
        self.state = BmsState.HV_OPEN

    def turn(self) -> None:
        """Take what has arrived, and say what is due."""
        while frame := self._bus.recv(0):
            if frame.arbitration_id == V2B_CMD.FRAME_ID:
                self._take(command_in(frame))
        if time.monotonic() >= self._due:
            self._due = time.monotonic() + _PERIOD
            self._say("B2V_ST0")
            self._say("B2V_ST1", B2V_ST1_BMS=self.state, B2V_ST1_ALIV=self._count % 15)
            self._count += 4 if self.skips else 1

    def wait_for(self, condition: Callable[[], bool]) -> None:
        """Wait until what it has heard makes something so."""
        with self._changed:
            assert self._changed.wait_for(condition, ENOUGH), self.commands[-20:]

    @property
    def is_closed(self) -> bool:
        """Whether it has high voltage on its terminals."""
        return self.state is BmsState.HV_CLOSED

    @property
    def since_on(self) -> list[HvCommand]:
        """The commands after the last one for on."""
        last = max(i for i, each in enumerate(self.commands) if each is HvCommand.HV_ON)
        return self.commands[last + 1 :]

    def _take(self, command: HvCommand) -> None:
        with self._changed:
            self.commands.append(command)
            if command is HvCommand.HV_ON:
                self.state = BmsState.HV_CLOSED
            elif self._obeys:
                self.state = BmsState.HV_OPEN
            self._changed.notify_all()

    def _say(self, name: str, **signals: float) -> None:
        message = database().get_message_by_name(name)
        given = {signal.name: float(signal.offset) for signal in message.signals} | signals
        data = bytearray(message.encode(given, strict=False))
        if any(signal.name.endswith("_Checksum") for signal in message.signals):
            data[0] = 0
            for byte in data[1:]:
                data[0] ^= byte
        self._bus.send(can.Message(arbitration_id=message.frame_id, data=data))


@contextmanager
def living(*packs: QuickPack) -> Iterator[None]:
    """Let packs live, in one thread."""
    stopping = threading.Event()

    def live() -> None:
        while not stopping.wait(_STEP):
            for pack in packs:
                pack.turn()

    thread = threading.Thread(target=live)
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join()
