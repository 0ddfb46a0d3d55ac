"""Codes do not change places."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.codes import code_pairs, quoted, reversed_codes
from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, signal_change


def _check(pairing: Pairing) -> Iterator[Change]:
    for codes in code_pairs(pairing):
        if values := sorted(reversed_codes(pairing, codes)):
            old, new = (
                ", ".join(f"{value} {quoted(side[value])}" for value in values)
                for side in (codes.old, codes.new)
            )
            # Each signal by itself: whoever has to turn round a command wants to know every one.
            for signal in (codes.signal, *codes.others):
                yield signal_change(signal, "codes", old, new)


PROMISE = Promise(
    "code-meaning-not-reversed",
    "Two raw values of a signal have not changed their meanings with each other.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
