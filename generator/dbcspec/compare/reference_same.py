"""Places in the standard and errata stay."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import (
    Breaks,
    Change,
    Class,
    Promise,
    listed,
    message_change,
    protocol_change,
    signal_change,
)
from dbcspec.compare.spec_only import both_are_specs, both_say_what_acts
from typedcan.model.acting import ActingCodes
from typedcan.model.protocol import Aspect, Message, Protocol, Signal


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        before, after = _reference(message.old), _reference(message.new)
        if before != after:
            yield message_change(message, "reference", before, after)
        for signal in message.signals:
            before, after = _reference(signal.old), _reference(signal.new)
            if both_say_what_acts(pairing) and signal.old.acting and signal.new.acting:
                before = _with_acts(before, signal.old.acting)
                after = _with_acts(after, signal.new.acting)
            if before != after:
                yield signal_change(signal, "reference", before, after)
    if both_are_specs(pairing):
        yield from _of_protocol(pairing)


def _of_protocol(pairing: Pairing) -> Iterator[Change]:
    """What only a spec says: number and edition, and which errata speak of nodes and buses."""
    old, new = pairing.old, pairing.new
    before, after = _edition(old), _edition(new)
    if before != after:
        yield protocol_change("protocol", "standard", before, after)
    marks = [
        *((node.name, was.errata, node.errata) for was, node in pairing.nodes),
        *((bus.name, bus_before.errata, bus.errata) for bus_before, bus in pairing.buses),
    ]
    for subject, was, now in marks:
        if was != now:
            yield protocol_change(subject, "errata", listed(was), listed(now))


def _reference(item: Message | Signal) -> str:
    return f"{item.reference}; {listed(item.errata)}" if item.errata else item.reference


def _with_acts(reference: str, acting: ActingCodes) -> str:
    return f"{reference}; acts by {acting.reference}" if acting.reference else reference


def _edition(protocol: Protocol) -> str:
    return listed(part for part in (protocol.number, protocol.edition) if part)


PROMISE = Promise(
    "reference-same",
    "A message or signal stands at the same place of the standard, read by the same errata.",
    Class.COSMETIC,
    Breaks.NOBODY,
    _check,
    needs=Aspect.REFERENCES,
)
