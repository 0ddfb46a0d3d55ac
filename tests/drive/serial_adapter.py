"""A CAN adapter on a serial line that speaks slcan, on a pseudo-terminal: what is behind it."""

from __future__ import annotations

import os
import select
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

import can

Spoil = Callable[[bytes], bytes]
"""What the line makes of one that the adapter writes, with its end."""


class Behind(can.BusABC):
    """What a node has that is on the bus behind the adapter; ``spoil`` is what the line does."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._buffer = b""
        self.spoil: Spoil = lambda line: line
        super().__init__(channel="behind")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        line = f"T{msg.arbitration_id:08X}{len(msg.data)}{bytes(msg.data).hex().upper()}\r"
        os.write(self._descriptor, self.spoil(line.encode("ascii")))

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        while select.select([self._descriptor], [], [], 0)[0]:
            self._buffer += os.read(self._descriptor, 4096)
        while b"\r" in self._buffer:
            line, _, self._buffer = self._buffer.partition(b"\r")
            if line.startswith(b"T"):
                data = bytes.fromhex(line[10:].decode("ascii"))
                return can.Message(arbitration_id=int(line[1:9], 16), data=data), False
        return None, False


class Adapter(NamedTuple):
    """A bus, and the options that open the adapter to it."""

    bus: Behind
    options: list[str]


@contextmanager
def adapter() -> Iterator[Adapter]:
    """An adapter on a pseudo-terminal."""
    near, far = os.openpty()
    tty.setraw(far)
    try:
        with Behind(near) as bus:
            # python-can gives an adapter two seconds to wake up.
            options = ["-i", "slcan", "-c", os.ttyname(far)]
            yield Adapter(bus, [*options, "--bus-kwargs", "sleep_after_open=0"])
    finally:
        os.close(near)
        os.close(far)
