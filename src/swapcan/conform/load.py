"""How busy each bus was, beside what the standard asks for."""

from __future__ import annotations

from dataclasses import dataclass

from swapcan.conform.chunk import Chunk

BIT_RATE = 250_000
"""Bit/s, 4.2.2."""

_HEAD, _EXTENDED_HEAD, _TAIL = 34, 54, 13
"""Bits of a frame apart from its payload: those that are stuffed, and those behind."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """The load of one bus, as shares of its bit rate.

    Parameters
    ----------
    channel
        As python-can gives it.
    measured, measured_stuffed
        By all frames on it, without stuff bits and with the most there can be.
    own, own_stuffed
        The part of it that messages of the protocol have.
    expected, expected_stuffed
        What the messages seen on it make at their printed periods, for the pack's numbers.
    """

    channel: str
    measured: float
    measured_stuffed: float
    own: float
    own_stuffed: float
    expected: float
    expected_stuffed: float


class LoadMeter:
    """Counts the bits of one log."""

    def take(self, chunk: Chunk) -> None:
        """Count the next frames."""

    def finish(self, end: float) -> tuple[Load, ...]:
        """The load of each channel, in the order in which they came."""
        return ()
