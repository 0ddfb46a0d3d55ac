"""When a checksum or counter only follows what became of its signal."""

from __future__ import annotations

import dataclasses

from dbcspec.compare.pairing import MessagePair
from typedcan.model.protection import Checksum, Counter


def protection_follows(
    message: MessagePair, old: Checksum | Counter | None, new: Checksum | Counter | None
) -> bool:
    """Whether the signal was renamed, or is gone and its checksum or counter with it."""
    if old is None:
        return False
    if new is None:
        return any(signal.name == old.signal for signal in message.removed)
    renamed = message.renamed.get(old.signal, old.signal)
    return dataclasses.replace(old, signal=renamed) == new
