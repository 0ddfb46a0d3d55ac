"""What is measured by group of sensors (CSC), and the signals that carry it."""

from __future__ import annotations

from dataclasses import dataclass

from typedcan.model.protocol import Protocol
from typedcan.model.transfer import Numbering
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.readings import ReadingsByGroup
from typedcan.model.transfers.registry import problems

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


def readings_of(protocol: Protocol) -> tuple[Readings, ...]:
    """What the transfers of a protocol carry by groups."""
    found = (Parts(transfer, protocol) for transfer in protocol.transfers)
    return tuple(_readings(parts) for parts in found if _is_by_group(parts))


def _is_by_group(parts: Parts) -> bool:
    """Whether each group numbers its frames, and another message tells how many there are."""
    return (
        parts.transfer.kind == ReadingsByGroup.name
        and parts.transfer.numbering is Numbering.WITHIN_GROUP
        and not problems(parts.transfer, parts.protocol)
        and bool(parts.totals and parts.groups and parts.count)
        and all(part.signal.length <= KEY_BITS for part in (parts.group, parts.number) if part)
    )


def _readings(parts: Parts) -> Readings:
    if not (parts.group and parts.number and parts.groups and parts.count):
        raise LookupError(f"{parts.transfer.name} are no readings by group")
    group = parts.group.signal
    states = (group.invalid_code, group.abnormal_code)
    return Readings(
        name=parts.table,
        item=parts.column,
        message=parts.messages[0].name,
        period=parts.period or 0,
        csc=group.name,
        number=parts.number.signal.name,
        no_csc=tuple(code for code in states if code is not None),
        items=tuple(part.signal.name for part in parts.items),
        unit=parts.items[0].signal.unit,
        totals=parts.totals,
        groups=parts.groups.signal.name,
        count=parts.count.signal.name,
    )
