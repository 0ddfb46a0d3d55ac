"""All kinds of transfers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from typedcan.model.protocol import Protocol
from typedcan.model.transfer import Transfer
from typedcan.model.transfers.blocks import NumberedBlocks
from typedcan.model.transfers.kind import Kind, Unfit
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.readings import ReadingsByGroup
from typedcan.model.transfers.text import TextOverFrames, TextOverMessages

KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        kind.name: kind
        for kind in (TextOverFrames(), TextOverMessages(), ReadingsByGroup(), NumberedBlocks())
    }
)
"""By their names in a spec."""


def usual_kind(*, group: str, frame_number: str) -> str:
    """The kind that a spec means which names none: readings where it names groups, else a text."""
    if group:
        return ReadingsByGroup.name
    return TextOverFrames.name if frame_number else TextOverMessages.name


def problems(transfer: Transfer, protocol: Protocol) -> Sequence[Unfit]:
    """What does not fit a transfer of a protocol; nothing where it can be put together."""
    kind = KINDS.get(transfer.kind)
    if kind is None:
        known = ", ".join(KINDS)
        return [Unfit("kind", f"{transfer.kind!r} is none of the kinds {known}")]
    return [*kind.problems(Parts(transfer, protocol))]
