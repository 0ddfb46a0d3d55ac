"""Multiplexed messages: which branches the database gives, and which of them each frame has."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.model.layout import first_bit
from typedcan.model.protocol import ByteOrder, Message, Signal

_FEW = 4
"""Up to so many codes, a comparison for each is faster than a search."""


@dataclass(frozen=True, slots=True)
class Branch:
    """Present where the multiplexer, itself present, has one of these values."""

    multiplexer: str
    values: frozenset[int]


@dataclass(frozen=True, slots=True)
class Multiplexing:
    """The signals that a message can carry, and when.

    Parameters
    ----------
    decodable
        False where the signals that are always there overlap or exceed the message; cantools
        then refuses every frame.
    branches
        By name of the signal, multiplexers before what they select; None: always there.
    known
        By name of the multiplexer, all its values that select a branch.
    """

    decodable: bool
    branches: Mapping[str, Branch | None]
    known: Mapping[str, Branch]


def multiplexing_of(message: Message) -> Multiplexing:
    """Follow the multiplexers from the signals that are always there."""
    children: dict[str, list[Signal]] = {}
    for signal in message.signals:
        children.setdefault(signal.multiplexer, []).append(signal)
    roots = children.get("", [])
    branches: dict[str, Branch | None] = {}
    known: dict[str, Branch] = {}
    pending: list[tuple[Signal, Branch | None]] = [(signal, None) for signal in roots]
    for signal, branch in pending:
        branches[signal.name] = branch
        below = children.get(signal.name, [])
        values = _values(signal, below)
        if values:
            sound = frozenset(value for value in values if _fits(_chosen(below, value), message))
            known[signal.name] = Branch(signal.name, sound)
            for child in below:
                own = sound.intersection(child.selectors)
                if own:
                    pending.append((child, Branch(signal.name, own)))
    return Multiplexing(_fits(roots, message), branches, known)


def _values(signal: Signal, below: Iterable[Signal]) -> set[int]:
    """What selects a branch; a labelled value does so even where no signal is in the branch."""
    if not signal.is_selector:
        return set()
    values = {value for child in below for value in child.selectors}
    codes = signal.value_table.codes if signal.value_table else ()
    return values | {code.value for code in codes}


def _chosen(signals: Iterable[Signal], value: int) -> list[Signal]:
    return [signal for signal in signals if value in signal.selectors]


def _fits(signals: Sequence[Signal], message: Message) -> bool:
    """Whether cantools can unpack signals together: it reads them one behind the other."""
    big = sorted((s for s in signals if s.byte_order is ByteOrder.MOTOROLA), key=first_bit)
    little = [s for s in signals if s.byte_order is ByteOrder.INTEL]
    for ordered in (big, little):
        end = 0
        for signal in ordered:
            if first_bit(signal) < end:
                return False
            end = first_bit(signal) + signal.length
        if end > 8 * message.length:
            return False
    return True


class Presence:
    """Which branches the frames of one message have.

    Parameters
    ----------
    plan
        The branches of the message.
    values
        By name of the multiplexer, what cantools compares: the values of its column.
    """

    def __init__(self, plan: Multiplexing, values: Mapping[str, NDArray[Any]]) -> None:
        self._plan = plan
        self._values = values
        self._masks: dict[Branch, NDArray[np.bool_]] = {}

    def of(self, signal: str) -> NDArray[np.bool_] | None:
        """Where the signal is there; None: everywhere."""
        branch = self._plan.branches[signal]
        return None if branch is None else self._mask(branch)

    def decodable(self) -> NDArray[np.bool_] | None:
        """Where every multiplexer that is there selects a branch; None: everywhere."""
        sound: NDArray[np.bool_] | None = None
        for name, branch in self._plan.known.items():
            found = _one_of(self._values[name], branch.values)
            there = self.of(name)
            if there is not None:
                found |= ~there
            sound = found if sound is None else sound & found
        return None if sound is None or sound.all() else sound

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
    """Where a value, cut to a whole number, is one of those."""
    if values.dtype == object:
        found = [int(value) in wanted for value in values]
        return np.array(found, np.bool_)
    if values.dtype.kind == "f":
        values = np.trunc(values)
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
