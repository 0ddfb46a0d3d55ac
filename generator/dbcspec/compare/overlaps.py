"""Whether a new signal lies on bits that another one keeps."""

from __future__ import annotations

from dbcspec.compare.pairing import MessagePair
from typedcan.model.layout import bits
from typedcan.model.protocol import Signal


def taken_by(signal: Signal, message: MessagePair) -> Signal | None:
    """The signal that was in the message before, still is, and shares a bit with the new one.

    Bits of a signal that is gone are free, and so are those of one that is there for other
    values of the same multiplexer.
    """
    added = {each.name for each in message.added}
    wanted = set(bits(signal))
    for other in message.new.signals:
        if (
            other.name not in added
            and not wanted.isdisjoint(bits(other))
            and not _never_together(signal, other)
        ):
            return other
    return None


def _never_together(one: Signal, other: Signal) -> bool:
    return one.multiplexer == other.multiplexer != "" and set(one.selectors).isdisjoint(
        other.selectors
    )
