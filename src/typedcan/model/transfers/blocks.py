"""Numbered blocks: data in numbered frames of one message, such as a parameter set or a key."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, ClassVar

from typedcan.model.signal_state import SignalState
from typedcan.model.transfers.kind import (
    Frame,
    Kind,
    Unfit,
    in_frames,
    one_count,
    one_message,
    whole_numbers,
)
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.set_frames import split_items
from typedcan.model.transfers.sets import SetRules

Item = float | SignalState | None
"""What a signal of a block holds; None where a branch has not the signal."""


@dataclass(frozen=True, slots=True)
class Blocks:
    """Data that arrived complete.

    Parameters
    ----------
    transfer
        The name of its transfer.
    values
        What the items of all blocks hold, in order, in the units of their signals.
    details
        What belongs to it, by the names of fields.
    at
        When it was complete, in seconds.
    """

    transfer: str
    values: tuple[Item, ...]
    details: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    at: float = 0.0

    def __bytes__(self) -> bytes:
        """The data where each item is a byte; raises `ValueError` where one is something else."""
        items: list[Any] = list(self.values)
        if not all(isinstance(item, int) and 0 <= item < 256 for item in items):
            raise ValueError(f"{self.transfer}: not all of its items are bytes")
        return bytes(items)

    def __len__(self) -> int:
        return len(self.values)


class NumberedBlocks(Kind):
    """Data in numbered frames."""

    name = "numbered_blocks"
    purpose = "data in numbered frames of one message"
    value = Blocks
    takes: ClassVar[frozenset[str]] = frozenset(
        {
            *("frame_number", "first_number", "count", "count_signal", "counted"),
            *("length_signal", "fill", "details", "rounds"),
        }
    )
    needs = ("frame_number",)

    def own_problems(self, parts: Parts) -> Iterator[Unfit]:
        """What does not fit."""
        transfer = parts.transfer
        yield from one_message(parts)
        yield from whole_numbers(parts, "frame_number", "count_signal", "length_signal")
        yield from one_count(transfer, "count", "count_signal")
        if not parts.items:
            yield Unfit("items", "missing")
        if transfer.count and not transfer.count_signal:
            yield from in_frames(parts, transfer.count)

    def rules(
        self, parts: Parts, timeout: float | None = None, rounds: int | None = None
    ) -> SetRules[Blocks]:
        """What puts the data together."""

        def make(items: Sequence[Any], details: Mapping[str, Any], at: float) -> Blocks:
            facts = MappingProxyType(dict(details))
            return Blocks(parts.transfer.name, tuple(items), facts, at)

        return SetRules(parts, make, ("data", "items"), timeout, rounds)

    def split(self, parts: Parts, value: Any) -> list[Frame]:
        """The frames of bytes, of values, or of `Blocks` with their details."""
        if isinstance(value, Blocks):
            return split_items(parts, value.values, value.details)
        return split_items(parts, tuple(value), {})

    def columns(self, parts: Parts) -> Mapping[str, type]:
        """The bytes, where each item is one, else a list of numbers."""
        return {"data": bytes} if _are_bytes(parts) else {"values": list}

    def cells(self, parts: Parts, value: Any) -> tuple[Any, ...]:
        """The bytes, or the numbers, None where there is none."""
        if _are_bytes(parts):
            return (bytes(value),)
        return ([item if isinstance(item, int | float) else None for item in value.values],)


def _are_bytes(parts: Parts) -> bool:
    """Whether each item is a byte, whatever it is."""
    return all(
        part.is_whole_number
        and not part.signal.unit
        and part.signal.length <= 8
        and not part.signal.states
        for part in parts.items
    )
