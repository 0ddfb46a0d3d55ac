"""The messages of one bus as streams of frames, for a given number of groups and items."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from dbcspec.load.response import Stream, Time
from typedcan.model.frame_time import frame_bits
from typedcan.model.protocol import Bus, Message, Protocol, SendType
from typedcan.model.transfer import Counted, Transfer


@dataclass(frozen=True, slots=True)
class Size:
    """What a transfer carries on the bus at hand: ``groups`` of them, ``items`` in all."""

    groups: int = 1
    items: int = 1

    def of_group(self, group: int) -> int:
        """The items of a group, counted from 0; the first ones take what does not divide."""
        return self.items // self.groups + (group < self.items % self.groups)


@dataclass(frozen=True, slots=True)
class Scenario:
    """What is on the bus.

    Parameters
    ----------
    sizes
        Of each transfer, by its name; one group with one item where it is missing.
    conditional
        Whether messages that are sent while a condition holds are there.
    event_interval
        Shortest time in s from one event message to its next; None leaves them out.
    """

    sizes: Mapping[str, Size] = field(default_factory=dict[str, Size])
    conditional: bool = True
    event_interval: Time | None = None


def bus_messages(protocol: Protocol, bus: Bus) -> list[Message]:
    """The messages that one node of a bus sends to another one of it.

    All of them where the bus lists no nodes: the file has one bus, whoever is on it.
    """
    here = set(bus.nodes)
    return [
        message
        for message in protocol.messages
        if not here or (message.sender in here and here.intersection(message.receivers))
    ]


def frames_of(transfer: Transfer, size: Size) -> int:
    """How many frames one cycle of a transfer has on each of its identifiers.

    What the spec fixes counts, else what ``size`` has.
    """
    if not transfer.frame_number:
        return 1
    items = len(transfer.items)
    if transfer.counts:
        return sum(-(count // -items) for count in transfer.counts)
    if transfer.counted is Counted.FRAMES:
        return transfer.count or size.items
    count = size.items if transfer.count is None else transfer.count
    if not transfer.group:
        return -(count // -items)
    own = Size(transfer.groups or size.groups, count)
    return sum(-(own.of_group(group) // -items) for group in range(own.groups))


def streams(
    protocol: Protocol, bus: Bus, scenario: Scenario, *, stuffed: bool = True
) -> list[Stream]:
    """What the bus carries in a scenario, with the stuff bits of the worst case or none."""
    carried = {
        name: (transfer, frames_of(transfer, scenario.sizes.get(transfer.name, Size())))
        for transfer in protocol.transfers
        for name in transfer.messages
    }
    found: list[Stream] = []
    for message in bus_messages(protocol, bus):
        period = _period(message, scenario)
        if period is not None:
            bits = frame_bits(message.length, extended=message.extended, stuffed=stuffed)
            found.append(
                Stream(
                    name=message.name,
                    priority=_priority(message),
                    time=Time(bits, bus.bit_rate),
                    period=period,
                    frames=_frames_a_period(message, *carried.get(message.name, (None, 1))),
                )
            )
    return found


def _frames_a_period(message: Message, transfer: Transfer | None, frames: int) -> int:
    """How many frames a message has in its period; a transfer may take several of them."""
    if transfer is None or not (transfer.period and message.period):
        return frames
    return -(frames * message.period // -transfer.period)


def _period(message: Message, scenario: Scenario) -> Time | None:
    if not message.period:
        return scenario.event_interval
    if message.send_type is SendType.IF_ACTIVE and not scenario.conditional:
        return None
    return Time(message.period, 1000)


def _priority(message: Message) -> int:
    """As the bus arbitrates: base identifier first, then standard before extended frames."""
    if message.extended:
        base, extension = divmod(message.frame_id, 1 << 18)
        return (base << 19) | (1 << 18) | extension
    return message.frame_id << 19
