"""What generic rules have to know of a protocol beyond its model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple


class OpenCodes(NamedTuple):
    """Codes that no value table has, and that some send all the same for a reason."""

    codes: tuple[int, ...]
    errata: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Scope:
    """Where rules that are made from the model would ask for too much, or for too little.

    Parameters
    ----------
    examples
        Signals whose value tables only name examples: other codes have a meaning too.
    from_one
        Signals that number something from 1, beside those of transfers.
    reserved_used
        Signals for which the standard leaves nothing but a reserved code at times.
    without_value
        Signals that may have no value for as long as they like.
    may_sleep
        Nodes that may be silent while others send.
    open_codes
        By names of signals, such codes: to send one breaks no demand.
    open_ends
        Counters of which it is not said where they begin anew.
    transfers
        What transfers are called in the ids of their rules, by their names; one without is called
        as it is.
    """

    examples: frozenset[str] = frozenset()
    from_one: tuple[str, ...] = ()
    reserved_used: frozenset[str] = frozenset()
    without_value: frozenset[str] = frozenset()
    may_sleep: frozenset[str] = frozenset()
    open_codes: Mapping[str, OpenCodes] = field(default_factory=dict[str, OpenCodes])
    open_ends: frozenset[str] = frozenset()
    transfers: Mapping[str, str] = field(default_factory=dict[str, str])
