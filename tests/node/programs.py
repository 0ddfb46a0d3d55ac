"""Small programs with a node, as processes of their own, on a bus that the test hears."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import can
from commands.running import environment
from node.rough_bus import PATIENCE, frames_until, is_on, rest

_BEGIN = """
import json, os, signal, sys, threading, time
import can
from swapcan import PROTOCOL, Node, SendingError
from swapcan.messages import V2B_CMD, HvCommand
if hasattr(signal, "SIGQUIT"):
    import resource
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
# As in a terminal, also where the tests run in the background.
signal.signal(signal.SIGINT, signal.default_int_handler)
bus = can.Bus(ignore_config=True, **json.loads(sys.argv[1]))
ON = V2B_CMD(hv_on_off=HvCommand.HV_ON)
wait = threading.Event().wait
"""


class Program:
    """A program that runs, and what it sends."""

    def __init__(self, process: subprocess.Popen[str], bus: can.BusABC) -> None:
        self.process = process
        self._bus = bus
        self.heard: list[can.Message] = []

    def wait_until_on(self) -> None:
        """Wait until it has commanded high voltage on."""
        self.heard += frames_until(self._bus, is_on)

    def wait_for_line(self, text: str) -> None:
        """Wait until it prints a line."""
        assert self.process.stdout
        assert self.process.stdout.readline().strip() == text

    def end_its_input(self) -> None:
        """Let it read to the end."""
        assert self.process.stdin
        self.process.stdin.close()
        self.process.stdin = None

    def hear(self) -> list[can.Message]:
        """All that it has sent so far."""
        self.heard += rest(self._bus)
        return self.heard

    def end(self, signal: int | None = None) -> int:
        """Wait for its end, after a signal; its exit status, negative for one of a signal."""
        if signal is not None:
            self.process.send_signal(signal)
        done = threading.Event()
        with_bus = threading.Thread(target=self._keep_hearing, args=(done,))
        with_bus.start()  # else what is sent meanwhile might not fit in the buffer of a socket
        try:
            return self.process.wait(PATIENCE)
        finally:
            done.set()
            with_bus.join()
            self.hear()

    def errors(self) -> str:
        """What it has said in the end."""
        assert self.process.stderr
        return self.process.stderr.read()

    def _keep_hearing(self, done: threading.Event) -> None:
        while not done.is_set():
            if frame := self._bus.recv(0.05):
                self.heard.append(frame)


@contextmanager
def running(text: str, options: dict[str, Any], bus: can.BusABC, folder: Path) -> Iterator[Program]:
    """A program that begins with `bus`, `Node`, `ON` and `wait`; it does not outlive the block."""
    process = subprocess.Popen(
        [sys.executable, "-c", _BEGIN + text, json.dumps(options)],
        env=environment(),
        cwd=folder,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        # A group of its own in this session: else nothing might stop it.
        process_group=None if sys.platform == "win32" else 0,
    )
    try:
        yield Program(process, bus)
    finally:
        process.kill()
        process.communicate()
