"""What converting needs to know of a protocol: its messages, periods, reserved codes, citations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from typedcan.logs.columns import State
from typedcan.logs.plan import Reserved
from typedcan.logs.transfers.readings import Readings, readings_of, values_of
from typedcan.model import protocol as model
from typedcan.model.j1939 import needs_several_frames
from typedcan.model.layout import readable
from typedcan.model.soundness import with_unique_names
from typedcan.model.transfers.parts import Parts


@dataclass(frozen=True, slots=True, eq=False)
class Protocol:
    """The messages that frames are decoded by.

    Parameters
    ----------
    name, digest
        Of the protocol; the digest is empty where a database carries none.
    messages
        Of the model, with their signals in the order of their bits.
    reserved
        Raw codes that are no value; empty for a database, whose labels may mean anything.
    references
        Where in the standard a signal stands, by names of message and signal.
    periods
        Seconds between two frames of a message that is sent periodically.
    conditional
        The names of those that are sent only while a condition holds: when they end is no gap.
    checked
        The messages by name, with all that is known of length, checksum and alive counter.
    formats_known
        Whether it is known which messages come in frames of CAN FD.
    readings
        What comes in groups over several frames, and becomes columns of its own.
    values
        Texts and blocks that come over several frames, and become rows of their own.
    """

    name: str
    digest: str
    messages: Sequence[model.Message]
    reserved: Reserved
    references: Mapping[tuple[str, str], str]
    periods: Mapping[str, float]
    conditional: frozenset[str]
    checked: Mapping[str, model.Message]
    formats_known: bool
    readings: tuple[Readings, ...]
    values: tuple[Parts, ...]

    @property
    def hidden(self) -> dict[str, str]:
        """Messages that no frame is, since a later one, named here, has their identifier."""
        last = {(each.frame_id, each.extended): each.name for each in self.messages}
        pairs = ((each.name, last[each.frame_id, each.extended]) for each in self.messages)
        return {name: later for name, later in pairs if name != later}

    @property
    def in_several_frames(self) -> tuple[str, ...]:
        """Messages that SAE J1939 transfers in several frames, which are not put together here."""
        return tuple(each.name for each in self.messages if needs_several_frames(each))


def known(protocol: model.Protocol) -> Protocol:
    """A protocol of which all is known."""
    return replace(
        read(protocol, protocol.name),
        digest=protocol.digest,
        reserved=_reserved(protocol),
        references={
            (message.name, signal.name): signal.reference for message, signal in protocol.signals()
        },
        conditional=frozenset(
            message.name
            for message in protocol.messages
            if message.period and message.send_type is model.SendType.IF_ACTIVE
        ),
        readings=readings_of(protocol),
        values=values_of(protocol),
    )


def read(protocol: model.Protocol, name: str) -> Protocol:
    """A protocol as a database says it, under a name of its own."""
    messages = with_unique_names(protocol).messages
    return Protocol(
        name=name,
        digest=protocol.made_from,
        messages=[_readable(message) for message in messages],
        reserved={},
        references={},
        periods={each.name: each.period / 1000 for each in protocol.messages if each.period},
        conditional=frozenset(),
        checked={each.name: each for each in messages},
        formats_known=model.Aspect.FRAME_FORMATS in protocol.carries,
        readings=(),
        values=(),
    )


def same(database: Protocol, own: Protocol) -> Protocol:
    """What is known of a protocol, with the messages, units and labels of a database of it."""
    return replace(own, messages=database.messages, checked={**database.checked, **own.checked})


def _readable(message: model.Message) -> model.Message:
    return replace(message, signals=tuple(readable(message)))


def _reserved(protocol: model.Protocol) -> Reserved:
    """By names of message and signal, the raw codes that are no value."""
    found: dict[tuple[str, str], dict[int, State]] = {}
    for message, signal in protocol.signals():
        codes = {code: State[state.name] for code, state in signal.states.items()}
        if codes and not signal.is_float:
            found[message.name, signal.name] = codes
    return found
