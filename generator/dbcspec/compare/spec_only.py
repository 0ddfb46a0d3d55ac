"""What only a spec can say of a protocol: invalid and abnormal codes, buses."""

from __future__ import annotations

from dbcspec.compare.pairing import Pairing, SignalPair
from dbcspec.model import Aspect, Signal

SPEC_ONLY = Aspect.PROTECTION
"""A DBC has labels only; which of them mean invalid is said where checksums are said."""


def both_are_specs(pairing: Pairing) -> bool:
    """Whether both sides say what no DBC does, and so are silent on purpose."""
    return SPEC_ONLY in pairing.old.carries & pairing.new.carries


def states(signal: Signal) -> set[int]:
    """The codes of a signal that mean invalid or abnormal."""
    return {code for code in (signal.invalid_code, signal.abnormal_code) if code is not None}


def start_follows_invalid(pairing: Pairing, signal: SignalPair) -> bool:
    """Whether the start value changed only because it is the invalid code, and that changed."""
    old, new = signal.old, signal.new
    if old.invalid_code == new.invalid_code or not both_are_specs(pairing):
        return False
    return all(side.start_value == (side.invalid_code or 0) for side in (old, new))
