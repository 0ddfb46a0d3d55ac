"""What is measured by group of sensors (CSC), and the signals that carry it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from typedcan.model.protocol import Message, Protocol, Signal, Transfer

KEY_BITS = 8
"""Frame numbers have one byte; a key is the CSC above it."""


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
    csc, number
        Signals: the CSC of a frame, and its number there from 1.
    no_csc
        Codes that are no CSC.
    items
        Signals: the readings of a frame in order.
    unit
        Of the readings.
    totals, groups, count
        The message that tells how many there are, and its signals: CSCs, and readings in all.
    """

    name: str
    item: str
    message: str
    period: float
    csc: str
    number: str
    no_csc: tuple[int, ...]
    items: tuple[str, ...]
    unit: str
    totals: str
    groups: str
    count: str

    def column(self, csc: int, number: int) -> str:
        """Name of the column of a reading; both count from 1."""
        return f"{self.item}_{csc}_{number}"


def readings_of(protocol: Protocol, names: Mapping[str, tuple[str, str]]) -> tuple[Readings, ...]:
    """What the transfers of a protocol carry by groups.

    Parameters
    ----------
    names
        By name of the transfer, those of the table and of one reading; one without has its own.
    """
    homes = {signal.name: (message, signal) for message, signal in protocol.signals()}
    return tuple(
        _readings(transfer, homes, *names.get(transfer.name, (transfer.name, transfer.name)))
        for transfer in protocol.transfers
        if _is_by_group(transfer, homes)
    )


def _is_by_group(transfer: Transfer, homes: Mapping[str, tuple[Message, Signal]]) -> bool:
    """Whether each group numbers its frames, and another message tells how many there are."""
    places = (transfer.group, transfer.frame_number)
    totals = (transfer.groups_signal, transfer.count_signal)
    return (
        transfer.numbered_within_group
        and all((*places, *totals))
        and len(transfer.messages) == 1
        and len({homes[name][0].name for name in totals}) == 1
        and all(homes[name][1].length <= KEY_BITS for name in places)
    )


def _readings(
    transfer: Transfer, homes: Mapping[str, tuple[Message, Signal]], name: str, item: str
) -> Readings:
    message, group = homes[transfer.group]
    states = (group.invalid_code, group.abnormal_code)
    return Readings(
        name=name,
        item=item,
        message=message.name,
        period=(message.period or 0) / 1000,
        csc=group.name,
        number=transfer.frame_number,
        no_csc=tuple(code for code in states if code is not None),
        items=transfer.items,
        unit=homes[transfer.items[0]][1].unit,
        totals=homes[transfer.count_signal][0].name,
        groups=transfer.groups_signal,
        count=transfer.count_signal,
    )
