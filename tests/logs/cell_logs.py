"""Frames of cells and probes, made by the typed messages, decoded to columns."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import swapcan
from swapcan.log_protocol import OWN
from swapcan.messages import B2V_BattInfo2, B2V_Temp, B2V_Ucell
from typedcan.logs.columns import DecodedBlock
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.plan import Mode
from typedcan.logs.transfers import CycleTable, ReadingColumns
from typedcan.model.signal_state import SignalState
from typedcan.wire.message import Message

INVALID = SignalState.INVALID
Reading = float | SignalState


@dataclass(frozen=True)
class Sent:
    """A message, when it was sent, and on which channel (0 or 1)."""

    time: float
    message: Message
    channel: int = 0


def totals(csc: int, cells: int, probes: int = 0) -> B2V_BattInfo2:
    return B2V_BattInfo2(tot_csc_num=csc, tot_cell_num=cells, tot_temp_num=probes)


def ucell(csc: int, number: int, *values: Reading) -> B2V_Ucell:
    first, second, third = (*values, INVALID, INVALID, INVALID)[:3]
    return B2V_Ucell(
        csc_no=csc,
        frame_no=number,
        csc_no_ucell_n=first,
        csc_no_ucell_n1=second,
        csc_no_ucell_n2=third,
    )


def temp(csc: int, number: int, *values: Reading) -> B2V_Temp:
    a, b, c, d, e, f = (*values, *[INVALID] * 6)[:6]
    return B2V_Temp(
        csc_no=csc,
        frame_no=number,
        csc_no_temp_n=a,
        csc_no_temp_n1=b,
        csc_no_temp_n2=c,
        csc_no_temp_n3=d,
        csc_no_temp_n4=e,
        csc_no_temp_n5=f,
    )


def cycle(
    start: float, cells: Mapping[int, Sequence[Reading]], *, channel: int = 0
) -> Iterator[Sent]:
    """The frames of one cycle, 2 ms apart, from the voltages of each CSC."""
    time = start
    for csc, values in cells.items():
        for place in range(0, len(values), 3):
            message = ucell(csc, place // 3 + 1, *values[place : place + 3])
            yield Sent(round(time, 6), message, channel)
            time += 0.002


def block_of(sent: Sequence[Sent]) -> FrameBlock:
    """The frames as columns."""
    data = np.zeros((len(sent), 8), np.uint8)
    for row, each in enumerate(sent):
        data[row] = list(swapcan.encode(each.message))
    return FrameBlock(
        timestamp=np.array([each.time for each in sent]),
        frame_id=np.array([each.message.FRAME_ID for each in sent], np.uint32),
        flags=np.full(len(sent), int(FrameFlag.EXTENDED), np.uint8),
        channel=np.array([each.channel for each in sent], np.int16),
        length=np.full(len(sent), 8, np.uint8),
        data=data,
        channels=("can0", "can1"),
    )


def decoder(mode: Mode = Mode.PHYSICAL) -> Decoder:
    return Decoder(OWN.messages, mode=mode, reserved=OWN.reserved)


def decoded(sent: Sequence[Sent], mode: Mode = Mode.PHYSICAL) -> DecodedBlock:
    return decoder(mode).decode(block_of(sent))


def put_together(
    sent: Sequence[Sent], columns: ReadingColumns, borders: Sequence[int] = ()
) -> list[CycleTable]:
    """All tables of a log whose blocks end at these places."""
    tables: list[CycleTable] = []
    decode = decoder()
    edges = [0, *sorted(borders), len(sent)]
    for begin, end in pairwise(edges):
        if begin < end:
            tables += columns.add(decode.decode(block_of(sent[begin:end])).messages)
    return tables + columns.finish()


Row = tuple[str, str | int | None, float, dict[str, float | None]]


def rows_of(tables: Sequence[CycleTable]) -> list[Row]:
    """Name of the table, channel, time and readings of each row; rounded to a millivolt."""
    rows: list[Row] = []
    for table in tables:
        for time, values in zip(table.timestamp.tolist(), table.values.tolist(), strict=True):
            readings = {
                name: None if value != value else round(value, 3)
                for name, value in zip(table.columns, values, strict=True)
            }
            rows.append((table.name, table.channel, time, readings))
    return rows
