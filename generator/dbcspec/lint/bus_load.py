"""Rule bus-load: the periodic messages of a bus leave room on it.

Each counts once per period with its longest frame, all stuff bits in. A message that sends several
frames per period counts once all the same: how many there are is not in the model. Frames of
more than 8 bytes are left out, they run at two bit rates.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.errors import Location
from typedcan.model.frame_time import frame_bits
from typedcan.model.protocol import NOWHERE, Bus, Message, Protocol

_CLASSIC_BYTES = 8


def _check(subject: Subject) -> Iterator[Found]:
    for bus in subject.protocol.buses:
        if bus.bit_rate <= 0:
            continue
        periodic = [each for each in _on(bus, subject.protocol) if each.period]
        load = sum(100_000 * _bits(m) / (m.period or 1) for m in periodic) / bus.bit_rate
        most = subject.settings.bus_load
        if load > most:
            text = (
                f"{len(periodic)} periodic messages take up to {load:.1f} % of the {bus.bit_rate} "
                f"bit/s of the bus {bus.name}, more than {most:g} %: lengthen periods, or set "
                f"bus_load"
            )
            yield Found(_place(subject, bus), bus.name, text)


def _bits(message: Message) -> int:
    return frame_bits(message.length, extended=message.extended, stuffed=True)


def _on(bus: Bus, protocol: Protocol) -> Iterator[Message]:
    """The messages on a bus: sent by one of its nodes and, where somebody hears them, to one."""
    nodes = set(bus.nodes)
    for message in protocol.messages:
        sent = not nodes or not message.sender or message.sender in nodes
        heard = not nodes or not message.receivers or not nodes.isdisjoint(message.receivers)
        if sent and heard and message.length <= _CLASSIC_BYTES:
            yield message


def _place(subject: Subject, bus: Bus) -> Location:
    rows = subject.spec.standard.buses if subject.spec else ()
    return next((row.where_is("bit_rate") for row in rows if row.name == bus.name), NOWHERE)


RULE = Rule("bus-load", "the periodic messages of a bus leave room on it", _check, level="warning")
