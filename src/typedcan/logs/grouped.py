"""What is measured by group, and the signals that carry it, for those who work on columns."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from typedcan.model.protocol import Protocol
from typedcan.model.transfers.cycle import WINDOW
from typedcan.model.transfers.parts import Part, Parts
from typedcan.model.transfers.readings import ReadingsByGroup
from typedcan.model.transfers.registry import KINDS, problems


@dataclass(frozen=True, slots=True)
class Readings:
    """Readings of one kind, and the signals that carry them.

    Parameters
    ----------
    name
        Of the table.
    item
        What one reading is called, the begin of the names of columns.
    message, period
        The message, and seconds between its cycles.
    group, number
        Signals: the group of a frame, and its number.
    no_group
        Codes that are no group.
    items
        Signals: the readings of a frame in order.
    unit
        Of the readings.
    totals, told
        The message that tells how many there are, and its signals for that, those that there are of
        groups and readings in all; empty where the protocol fixes them.
    word
        What a group is called in metadata.
    parts
        All that the protocol says of the transfer.
    """

    name: str
    item: str
    message: str
    period: float
    group: str
    number: str
    no_group: tuple[int, ...]
    items: tuple[str, ...]
    unit: str
    totals: str
    told: tuple[str, ...]
    word: str
    parts: Parts = field(repr=False, compare=False)

    @property
    def window(self) -> float:
        """Seconds that a reading in a cycle may be old."""
        return self.parts.seconds(WINDOW)

    def column(self, group: int, number: int) -> str:
        """Name of the column of a reading; the number counts from 1."""
        return f"{self.item}_{group}_{number}"


def readings_of(protocol: Protocol) -> tuple[Readings, ...]:
    """What the transfers of a protocol carry by groups; those that do not fit are passed over."""
    return tuple(
        _readings(parts, parts.group, parts.number)
        for parts in (Parts(transfer, protocol) for transfer in protocol.transfers)
        if parts.transfer.kind == ReadingsByGroup.name
        and not problems(parts.transfer, protocol)
        and parts.group
        and parts.number
    )


def values_of(protocol: Protocol) -> tuple[Parts, ...]:
    """The texts and blocks of a protocol; those that do not fit are passed over."""
    return tuple(
        Parts(transfer, protocol)
        for transfer in protocol.transfers
        if not problems(transfer, protocol)
        and KINDS[transfer.kind].columns(Parts(transfer, protocol))
    )


def _readings(parts: Parts, group: Part, number: Part) -> Readings:
    states = (group.signal.invalid_code, group.signal.abnormal_code)
    told = [part for part in (parts.groups, parts.count) if part]
    return Readings(
        name=parts.table,
        item=parts.column,
        message=parts.messages[0].name,
        period=parts.period or 0,
        group=group.signal.name,
        number=number.signal.name,
        no_group=tuple(code for code in states if code is not None),
        items=tuple(part.signal.name for part in parts.items),
        unit=parts.items[0].signal.unit,
        totals=told[0].message.name if told else "",
        told=tuple(part.signal.name for part in told),
        word=re.sub(r"\W+", "_", parts.word.lower()),
        parts=parts,
    )
