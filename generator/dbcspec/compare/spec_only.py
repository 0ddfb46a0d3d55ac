"""What only a spec can say of a protocol: invalid and abnormal codes, codes that act, buses."""

from __future__ import annotations

from dbcspec.compare.pairing import Pairing, SignalPair
from typedcan.model.acting import usual_start
from typedcan.model.protocol import Aspect, Signal

SPEC_ONLY = Aspect.PROTECTION
"""A DBC has labels only; which of them mean invalid is said where checksums are said."""


def both_are_specs(pairing: Pairing) -> bool:
    """Whether both sides say what no DBC does, and so are silent on purpose."""
    return SPEC_ONLY in pairing.old.carries & pairing.new.carries


def both_say_what_acts(pairing: Pairing) -> bool:
    """Whether both sides say which codes act."""
    return Aspect.ACTS in pairing.old.carries & pairing.new.carries


def states(signal: Signal) -> set[int]:
    """The codes of a signal that mean invalid or abnormal."""
    return set(signal.states)


def start_follows(pairing: Pairing, signal: SignalPair) -> bool:
    """Whether the start value is the usual one, and changed only with what makes it that.

    That is the invalid code, and the codes that act; other promises tell of both.
    """
    old, new = signal.old, signal.new
    told = both_are_specs(pairing) and old.invalid_code != new.invalid_code
    told |= both_say_what_acts(pairing) and old.acting != new.acting
    return told and all(side.start_value == _usual_start(side) for side in (old, new))


def _usual_start(signal: Signal) -> int:
    return usual_start(signal.invalid_code, signal.acting)
