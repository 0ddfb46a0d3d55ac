"""How a text is split into the frames of its transfer."""

from __future__ import annotations

from typing import Any

from typedcan.transfer.layout import characters, text_slots
from typedcan.wire.errors import TransferError
from typedcan.wire.protocol import Transfer


def text_frames(transfer: Transfer, text: str) -> list[dict[str, Any]]:
    """The fields of each frame of a text; those beyond its end hold the fill.

    Raises `TransferError` for a character that the transfer has not.
    """
    allowed = characters(transfer)
    for position, letter in enumerate(text, 1):
        if letter not in allowed:
            problem = f"character {position}, {letter!r}, is none of {''.join(sorted(allowed))}"
            raise TransferError(transfer.name, problem)
    frames: list[dict[str, Any]] = []
    rest = text
    for slot in text_slots(transfer):
        fields = slot.used + slot.unused
        part, rest = rest[: len(fields)], rest[len(fields) :]
        values: dict[str, Any] = dict.fromkeys(fields, transfer.fill)
        values.update(zip(fields, part, strict=False))
        if transfer.frame_number:
            values[transfer.frame_number.field] = slot.number
        frames.append(values)
    return frames
