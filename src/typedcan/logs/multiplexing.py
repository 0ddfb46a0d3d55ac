"""Multiplexed messages: which branches there are, and which of them each frame has."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.model.protocol import Signal

_FEW = 4
"""Up to so many codes, a comparison for each is faster than a search."""


@dataclass(frozen=True, slots=True)
class Branch:
    """Present where the multiplexer, itself present, has one of these raw values."""

    multiplexer: str
    values: frozenset[int]


@dataclass(frozen=True, slots=True)
class Multiplexing:
    """The signals that a message can carry, and when.

    Parameters
    ----------
    branches
        By name of the signal, multiplexers before what they select; None: always there.
    known
        By name of the multiplexer, all its raw values that mean something: those with a branch,
        and those with a label.
    """

    branches: Mapping[str, Branch | None]
    known: Mapping[str, Branch]


def multiplexing_of(signals: Sequence[Signal]) -> Multiplexing:
    """The branches of a message that has these signals."""
    by_name = {signal.name: signal for signal in signals}
    branches: dict[str, Branch | None] = {}
    values: dict[str, set[int]] = {}
    for signal in signals:
        above = by_name.get(signal.multiplexer)
        branches[signal.name] = Branch(above.name, frozenset(signal.selectors)) if above else None
        if above:
            labelled = above.value_table.labels() if above.value_table else ()
            values.setdefault(above.name, {*labelled}).update(signal.selectors)
    known = {name: Branch(name, frozenset(found)) for name, found in values.items()}
    return Multiplexing(branches, known)


class Presence:
    """Which branches the frames of one message have.

    Parameters
    ----------
    plan
        The branches of the message.
    values
        By name of the multiplexer, its raw values.
    """

    def __init__(self, plan: Multiplexing, values: Mapping[str, NDArray[Any]]) -> None:
        self._plan = plan
        self._values = values
        self._masks: dict[Branch, NDArray[np.bool_]] = {}

    def of(self, signal: str) -> NDArray[np.bool_] | None:
        """Where the signal is there; None: everywhere."""
        branch = self._plan.branches[signal]
        return None if branch is None else self._mask(branch)

    def without_branch(self) -> int:
        """How many frames have a multiplexer whose value means nothing."""
        lost: NDArray[np.bool_] | None = None
        for name, branch in self._plan.known.items():
            unknown = ~_one_of(self._values[name], branch.values)
            there = self.of(name)
            if there is not None:
                unknown &= there
            lost = unknown if lost is None else lost | unknown
        return 0 if lost is None else int(np.count_nonzero(lost))

    def _mask(self, branch: Branch) -> NDArray[np.bool_]:
        mask = self._masks.get(branch)
        if mask is None:
            mask = _one_of(self._values[branch.multiplexer], branch.values)
            there = self.of(branch.multiplexer)
            if there is not None:
                mask &= there
            self._masks[branch] = mask
        return mask


def _one_of(values: NDArray[Any], wanted: frozenset[int]) -> NDArray[np.bool_]:
    """Where a value is one of those."""
    if values.dtype == object:
        return np.array([value in wanted for value in values], np.bool_)
    codes = _codes(wanted, values.dtype)
    if len(codes) > _FEW:
        return np.isin(values, codes)
    mask = np.zeros(len(values), np.bool_)
    for code in codes:
        mask |= values == code
    return mask


@lru_cache(maxsize=4096)
def _codes(wanted: frozenset[int], dtype: np.dtype[Any]) -> NDArray[Any]:
    """The wanted values that a number of that type can be."""
    if dtype.kind == "f":
        # Compared in float64: a float32 code that is rounded would match its neighbour.
        held = [value for value in wanted if float(value) == value]
        return np.array(held, np.float64)
    limits = np.iinfo(dtype)
    return np.array([v for v in wanted if limits.min <= v <= limits.max], dtype)
