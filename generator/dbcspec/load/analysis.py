"""The load of one bus in a scenario: per message, per node, and what still fits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from dbcspec.load.response import Response, Time, worst_case_responses
from dbcspec.load.traffic import Scenario, Size, bus_messages, frames_of, streams
from typedcan.model.protocol import Bus, Message, Protocol

_MOST_FRAMES = 255
"""Of one group: frame numbers have eight bits."""


@dataclass(frozen=True, slots=True)
class MessageLoad:
    """A message: its part of the bus without stuff bits and with the most, and its longest wait."""

    message: Message
    frames: int
    bare: Fraction
    stuffed: Fraction
    response: Response


@dataclass(frozen=True, slots=True)
class BusLoad:
    """A bus in a scenario; ``messages`` as they win arbitration.

    ``silent`` are the messages that the scenario leaves out, ``fitting`` how many items of each
    transfer the bus could carry with every message in time, all else being as it is.
    """

    bus: Bus
    messages: tuple[MessageLoad, ...]
    silent: tuple[Message, ...]
    fitting: Mapping[str, int]

    @property
    def bare(self) -> Fraction:
        """The part of the time that the bus is busy, without stuff bits."""
        return sum((each.bare for each in self.messages), Fraction(0))

    @property
    def stuffed(self) -> Fraction:
        """The same with the most stuff bits."""
        return sum((each.stuffed for each in self.messages), Fraction(0))

    @property
    def late(self) -> tuple[MessageLoad, ...]:
        """The messages that can miss their period."""
        return tuple(each for each in self.messages if not each.response.in_time)

    def by_node(self) -> dict[str, tuple[Fraction, Fraction]]:
        """What each node takes of the bus, without stuff bits and with the most."""
        nodes = dict.fromkeys(self.bus.nodes, (Fraction(0), Fraction(0)))
        for each in self.messages:
            sender = each.message.sender or "nobody"
            bare, stuffed = nodes.get(sender, (Fraction(0), Fraction(0)))
            nodes[sender] = (bare + each.bare, stuffed + each.stuffed)
        return nodes


def analyse(protocol: Protocol, bus: Bus, scenario: Scenario) -> BusLoad:
    """What a bus carries in a scenario."""
    stuffed = streams(protocol, bus, scenario)
    bare = {each.name: each for each in streams(protocol, bus, scenario, stuffed=False)}
    loads = tuple(
        MessageLoad(
            message=protocol.message(response.stream.name),
            frames=response.stream.frames,
            bare=bare[response.stream.name].utilisation,
            stuffed=response.stream.utilisation,
            response=response,
        )
        for response in worst_case_responses(stuffed, Time(1, bus.bit_rate))
    )
    return BusLoad(
        bus=bus,
        messages=loads,
        silent=tuple(
            message for message in bus_messages(protocol, bus) if message.name not in bare
        ),
        fitting={
            name: _most_items(protocol, bus, scenario, name)
            for name in _growing(protocol, {each.message.name for each in loads})
        },
    )


def _growing(protocol: Protocol, names: set[str]) -> list[str]:
    """The transfers on the bus whose number of items is the pack's."""
    return [
        transfer.name
        for transfer in protocol.transfers
        if transfer.frame_number and not (transfer.count or transfer.counts)
        if names & set(transfer.messages)
    ]


def _most_items(protocol: Protocol, bus: Bus, scenario: Scenario, name: str) -> int:
    """The most items of a transfer with every message in time, 0 where there is none."""
    transfer = next(each for each in protocol.transfers if each.name == name)
    size = scenario.sizes.get(name, Size())
    low, high = 0, size.groups * _MOST_FRAMES * len(transfer.items)
    while low < high:
        middle = (low + high + 1) // 2
        tried = {**scenario.sizes, name: replace(size, items=middle)}
        enough = frames_of(transfer, tried[name]) > 0 and _in_time(
            protocol, bus, replace(scenario, sizes=tried)
        )
        low, high = (middle, high) if enough else (low, middle - 1)
    return low


def _in_time(protocol: Protocol, bus: Bus, scenario: Scenario) -> bool:
    found = streams(protocol, bus, scenario)
    if sum(each.utilisation for each in found) >= 1:
        return False
    return all(each.in_time for each in worst_case_responses(found, Time(1, bus.bit_rate)))
