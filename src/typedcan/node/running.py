"""What starts, turns and stops a node."""

from __future__ import annotations

import asyncio
import time
from types import TracebackType
from typing import Self

from typedcan.node.engine import Engine
from typedcan.node.errors import StillActingError
from typedcan.node.leaving import raise_or_note
from typedcan.node.transmit import Sends
from typedcan.wire.message import Message


class Running:
    """The life of a node, be it in threads or driven by hand."""

    name: str
    _engine: Engine

    def start(self) -> None:
        """Begin to send and to receive, in two threads."""
        self._engine.start()

    def stop(self) -> None:
        """End what the node began; does nothing where there is nothing to end.

        Requests under way end with `RequestError`. The bus stays open. What acts is ended first,
        see ``leave``; raises `StillActingError` where the bus did not take the safe codes.
        """
        self._engine.stop()

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._stop_after(error)

    async def __aenter__(self) -> Self:
        self.start()
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._engine.ask_to_stop()
        end = time.monotonic() + self._engine.patience
        try:
            while self._engine.runs and time.monotonic() < end:
                await asyncio.sleep(0.005)
        finally:
            self._stop_after(error, max(end - time.monotonic(), 0.0))

    def _stop_after(self, error: BaseException | None, patience: float | None = None) -> None:
        """Stop; what is wrong with that is told beside the error that a block was left with."""
        try:
            self._engine.stop(patience)
        except StillActingError as failure:
            raise_or_note(self.name, failure, error)

    @property
    def acting(self) -> tuple[Message, ...]:
        """The messages that were sent last with a code that acts, such as high voltage on."""
        return self._engine.acting

    def send_safe_codes(self) -> Exception | None:
        """Send now, without receiving first, the safe codes of what was commanded.

        What is sent cyclically goes on as it was set. Returns what the bus raised, if it did.
        """
        return self._engine.send_safe_codes()

    # Driven by hand

    @property
    def sends(self) -> Sends:
        """What is sent: all, what does not act, or nothing; safe codes always are."""
        return self._engine.sends

    @sends.setter
    def sends(self, sends: Sends) -> None:
        self._engine.sends = sends

    @property
    def next_due(self) -> float:
        """When `turn` has something to do if nothing arrives; `math.inf` for never."""
        return self._engine.next_due

    def turn(self) -> None:
        """Take what has arrived, let time pass up to the clock's, and send what is due.

        For a node that is not started.
        """
        self._engine.turn()
