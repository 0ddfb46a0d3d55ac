"""A virtual bus that fails or hangs when a test wants it to, and what was heard of it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from functools import reduce
from operator import xor
from pathlib import Path
from typing import Any

import can
import cantools
from can.interfaces.virtual import VirtualBus
from cantools.database.can import Database

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import V2B_CMD
from typedcan.model.editions import unsure_codes

PATIENCE = 30.0
"""Seconds for what takes much less on a machine with nothing else to do."""


class OwnError(Exception):
    """Of nobody whom the node could know."""


class OwnInterrupt(BaseException):
    """The same, for what is no `Exception`."""


class Hang:
    """Does not return until it is released."""

    def __init__(self) -> None:
        self._over = threading.Event()
        self.release = self._over.set

    def __call__(self, *_: object) -> None:
        self._over.wait()


class MuteError(Exception):
    """Cannot even be shown."""

    def __str__(self) -> str:
        raise RuntimeError("no text")


def _unicode_error() -> UnicodeDecodeError:
    return UnicodeDecodeError("utf-8", b"\xff", 0, 1, "invalid start byte")


ERRORS: dict[str, Callable[[], Exception]] = {
    "can.CanError": lambda: can.CanError("bus off"),
    "can.CanOperationError": lambda: can.CanOperationError("adapter is gone"),
    "can.CanTimeoutError": can.CanTimeoutError,
    "OSError": lambda: OSError(100, "Network is down"),
    "ValueError": lambda: ValueError("invalid literal for int() with base 16: 't1'"),
    "IndexError": lambda: IndexError("bytearray index out of range"),
    "KeyError": lambda: KeyError("type"),
    "TypeError": lambda: TypeError("'NoneType' object is not subscriptable"),
    "AttributeError": lambda: AttributeError("'NoneType' object has no attribute 'fd'"),
    "RuntimeError": lambda: RuntimeError("dictionary changed size during iteration"),
    "OverflowError": lambda: OverflowError("cannot convert float infinity to integer"),
    "AssertionError": AssertionError,
    "UnicodeDecodeError": _unicode_error,
    "StopIteration": StopIteration,
    "OwnError": OwnError,
    "MuteError": MuteError,
}
"""What drivers, checksums, makers and callbacks raise."""

ENDS: dict[str, Callable[[], BaseException]] = {
    "SystemExit": lambda: SystemExit(3),
    "KeyboardInterrupt": KeyboardInterrupt,
    "GeneratorExit": GeneratorExit,
    "OwnInterrupt": OwnInterrupt,
}
"""What is no `Exception`, and ends a thread."""


def nothing(*_: object) -> None:
    pass


def raising(error: Callable[[], BaseException], times: float = float("inf")) -> Any:
    """A function that raises so many times, and then does nothing."""
    done = 0

    def act(*_: object) -> None:
        nonlocal done
        if done < times:
            done += 1
            raise error()

    return act


class RoughBus(VirtualBus):
    """Does what a test says before it receives and before it sends."""

    before_recv: Callable[[], object]
    before_send: Callable[[can.Message], object]
    tried_to_recv = 0
    tried_to_send = 0

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        self.tried_to_recv += 1
        self.before_recv()
        return super()._recv_internal(timeout)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self.tried_to_send += 1
        self.before_send(msg)
        super().send(msg, timeout)


def made_rough(bus: can.BusABC) -> RoughBus:
    """The same bus, on the channel of its test and closed after it, which does as it is told."""
    assert isinstance(bus, VirtualBus)
    bus.__class__ = RoughBus
    assert isinstance(bus, RoughBus)
    bus.before_recv = bus.before_send = nothing
    return bus


def database() -> Database:
    """The project's DBC as cantools reads it: it knows nothing of this package."""
    path = Path(__file__).parents[2] / "dbc" / "caamtb-swap.dbc"
    database = cantools.database.load_file(path)
    assert isinstance(database, Database)
    return database


_DATABASE = database()

HEAT_LEFT = unsure_codes(PROTOCOL.model).get("V2B_CMD", {}).get("V2B_CMD_Heat_OnOff", 2)
"""How the heating is left: off, as table 14 row 6 has it, or invalid where an edition has not."""

OFF = {"V2B_CMD_HV_OnOff": {2}, "V2B_CMD_HV_ACC_OnOff": {2}, "V2B_CMD_Heat_OnOff": {2, HEAT_LEFT}}
"""Off, as table 14 rows 3, 4 and 6 have it."""


def signals(frame: can.Message) -> dict[str, Any]:
    """The raw values of the signals of a frame, by cantools."""
    message = _DATABASE.get_message_by_frame_id(frame.arbitration_id)
    decoded = message.decode(bytes(frame.data), decode_choices=False, scaling=False)
    assert isinstance(decoded, dict)
    return decoded


def commands(frames: Sequence[can.Message]) -> list[can.Message]:
    """The frames of V2B_CMD."""
    return [frame for frame in frames if frame.arbitration_id == V2B_CMD.FRAME_ID]


def is_on(frame: can.Message) -> bool:
    return bool(signals(frame).get("V2B_CMD_HV_OnOff") == 1)


def is_off(frame: can.Message) -> bool:
    values = signals(frame)
    return all(values.get(name) in codes for name, codes in OFF.items())


def trailing_offs(frames: Sequence[can.Message]) -> list[can.Message]:
    """The commands since the last one with which something would be on.

    Fails where a checksum is wrong, or a counter does not run from the first to the last.
    """
    sent = commands(frames)
    for frame in sent:
        assert frame.data[0] == reduce(xor, frame.data[1:])
    counters = [frame.data[1] & 0x0F for frame in sent]
    assert counters == [(counters[0] + number) % 15 for number in range(len(sent))]
    on = [number for number, frame in enumerate(sent) if not is_off(frame)]
    return sent[on[-1] + 1 if on else 0 :]


def frames_until(
    bus: can.BusABC, fits: Callable[[can.Message], bool], seconds: float = PATIENCE
) -> list[can.Message]:
    """What arrives up to the first frame that fits; fails where none does."""
    heard: list[can.Message] = []
    late = threading.Event()
    timer = threading.Timer(seconds, late.set)
    timer.start()
    try:
        while not late.is_set():
            if frame := bus.recv(0.1):
                heard.append(frame)
                if fits(frame):
                    return heard
    finally:
        timer.cancel()
        timer.join()
    raise AssertionError(f"none of {len(heard)} frames fits")


def rest(bus: can.BusABC) -> list[can.Message]:
    """What has arrived."""
    frames = []
    while frame := bus.recv(0):
        frames.append(frame)
    return frames
