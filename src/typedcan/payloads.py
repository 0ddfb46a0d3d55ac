"""Payloads to try a message with: of all 0, of all 1, random ones, and some of each branch."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping

from typedcan.model import layout
from typedcan.model.protocol import Signal
from typedcan.wire.message import Message

_PAYLOADS = 6
"""Random payloads that each message is tried with, beside those of all 0 and all 1."""
_BRANCHES = 100
"""Signals of branches that are tried, of a message."""


def payloads(kind: type[Message]) -> Iterator[bytes]:
    """Payloads of all 0, of all 1, random ones, and some for each branch."""
    length = kind.LENGTH
    yield bytes(length)
    yield b"\xff" * length
    source = random.Random(kind.NAME)
    for _ in range(_PAYLOADS if length else 0):
        yield source.randbytes(length)
    for selected in _branches(kind):
        yield _with_codes(source.randbytes(length), selected)


def _branches(kind: type[Message]) -> Iterator[dict[Signal, int]]:
    """Values of the selectors with which each branch is there, others at one that they know."""
    by_name = {field.dbc_name: field.signal for field in kind.FIELDS.values()}
    within = [each for each in by_name.values() if each.multiplexer]
    usual = {by_name[each.multiplexer]: each.selectors[0] for each in reversed(within)}
    for signal in within[:_BRANCHES]:
        selected, inner = dict(usual), signal
        while inner.multiplexer:
            selected[by_name[inner.multiplexer]] = inner.selectors[0]
            inner = by_name[inner.multiplexer]
        yield selected


def _with_codes(data: bytes, codes: Mapping[Signal, int]) -> bytes:
    """A payload with other raw values of some signals."""
    number = int.from_bytes(data, "little")
    for signal, code in codes.items():
        for place, bit in enumerate(layout.bits(signal)):
            number = number & ~(1 << bit) | (code >> place & 1) << bit
    return number.to_bytes(len(data), "little")
