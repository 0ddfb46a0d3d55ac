"""A signal is there under the same condition."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, listed, signal_change
from typedcan.model.protocol import Signal


def _check(pairing: Pairing) -> Iterator[Change]:
    for signal in pairing.signals:
        old, new = signal.old, signal.new
        multiplexer = signal.renamed.get(old.multiplexer, old.multiplexer)
        before = (old.is_selector, multiplexer, frozenset(old.selectors))
        after = (new.is_selector, new.multiplexer, frozenset(new.selectors))
        if before != after:
            yield signal_change(signal, "multiplexing", _text(old), _text(new))


def _text(signal: Signal) -> str:
    parts = ["selector"] if signal.is_selector else []
    if signal.multiplexer or signal.selectors:
        parts.append(f"{signal.multiplexer} = {listed(map(str, signal.selectors))}")
    return ", ".join(parts)


PROMISE = Promise(
    "signal-multiplexing-same",
    "A signal is in the frame under the same condition, and selects the same signals.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
