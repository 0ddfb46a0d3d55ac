"""A message compiled: what to read, how to scale it, and when a signal is there."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from enum import Enum

from typedcan.logs.columns import SignalInfo, State
from typedcan.logs.lanes import lane_of
from typedcan.logs.multiplexing import Multiplexing, multiplexing_of
from typedcan.logs.scaling import Scaling, raw_dtype, scaling_of
from typedcan.logs.stacks import ByteLoad, Part, Stack, stacks_of
from typedcan.logs.wide import Wide
from typedcan.model.errors import TypedcanError
from typedcan.model.layout import readable
from typedcan.model.protocol import Message, Signal
from typedcan.model.scaling import python_number, to_physical

SHORT, LONG = 8, 64
"""Bytes of a payload row, of CAN and of CAN FD."""

Reserved = Mapping[tuple[str, str], Mapping[int, State]]
"""By names of message and signal, the raw codes that are no value."""


class Mode(Enum):
    """What the columns hold.

    ``PHYSICAL``: float64 where a signal is scaled or a float, else the smallest integer type;
    reserved codes are null and have a state. ``RAW``: what is on the wire, in the smallest type.
    ``LABELS``: raw codes for the signals whose values have labels (and no scaling), to be shown by
    them; everything else as ``PHYSICAL``.
    """

    PHYSICAL = "physical"
    RAW = "raw"
    LABELS = "labels"


class SelectionError(TypedcanError, LookupError):
    """A message or signal that was asked for is not in the database."""


class ReservedCodeError(TypedcanError, ValueError):
    """A reserved code is none that the signal can have."""


@dataclass(frozen=True, slots=True)
class MessagePlan:
    """How the frames of one message are decoded.

    Parameters
    ----------
    name, frame_id, is_extended, length, by_pgn
        The message's; the length in bytes.
    columns
        The signals asked for that can occur, in the order of the database.
    loads, stacks, wide
        What decodes them, and the multiplexers beside.
    multiplexing
        Which branches there are.
    selecting
        By name of the multiplexer, what its raw values are called among what is decoded.
    """

    name: str
    frame_id: int
    is_extended: bool
    length: int
    columns: tuple[SignalInfo, ...]
    loads: tuple[ByteLoad, ...]
    stacks: tuple[Stack, ...]
    wide: tuple[Wide, ...]
    multiplexing: Multiplexing
    selecting: Mapping[str, str]
    by_pgn: bool


def plan_of(
    message: Message,
    mode: Mode = Mode.PHYSICAL,
    reserved: Reserved | None = None,
    wanted: Collection[str] | None = None,
) -> MessagePlan:
    """Compile a message.

    Parameters
    ----------
    mode
        What the columns hold.
    reserved
        Raw codes that are no value; those of other messages do not matter.
    wanted
        Names of the signals to decode, None for all.

    Raises
    ------
    SelectionError
        A wanted signal is not in the message.
    ReservedCodeError
        A reserved code is none that the signal can have.
    """
    columns = columns_of(message, mode, reserved, wanted)
    signals = readable(message)
    above = {signal.multiplexer for signal in signals}
    selecting = {each.name: f"{each.name} (raw)" for each in signals if each.name in above}
    parts: list[Part | Wide] = []
    if message.length <= LONG:  # else no frame has all its bytes
        parts = _parts(message, columns, reserved or {}, selecting)
    loads, stacks = stacks_of(part for part in parts if isinstance(part, Part))
    return MessagePlan(
        message.name,
        message.frame_id,
        message.extended,
        message.length,
        columns,
        loads,
        stacks,
        tuple(part for part in parts if isinstance(part, Wide)),
        multiplexing_of(signals),
        selecting,
        message.by_pgn,
    )


def columns_of(
    message: Message,
    mode: Mode = Mode.PHYSICAL,
    reserved: Reserved | None = None,
    wanted: Collection[str] | None = None,
) -> tuple[SignalInfo, ...]:
    """The signals asked for that can occur, in the order of the database; raises as `plan_of`."""
    names = {signal.name for signal in readable(message)}
    for name in wanted or ():
        if name not in names:
            known = [signal.name for signal in message.signals if signal.name in names]
            raise SelectionError(f"{message.name} has no signal {name!r}; it has {known}")
    there = [signal for signal in message.signals if signal.name in names]
    codes = {signal.name: _codes(message, signal, reserved or {}) for signal in there}
    return tuple(
        _info(signal, mode, codes[signal.name])
        for signal in there
        if wanted is None or signal.name in wanted
    )


def _parts(
    message: Message,
    infos: Iterable[SignalInfo],
    reserved: Reserved,
    selecting: Mapping[str, str],
) -> list[Part | Wide]:
    """What decodes the columns, and the raw values of the multiplexers."""
    by_name = {signal.name: signal for signal in message.signals}
    parts: list[Part | Wide] = []
    for info in infos:
        signal = by_name[info.name]
        codes = _codes(message, signal, reserved) if info.scaled else {}
        parts.append(_part(message, signal, info, codes))
    for name, raw in selecting.items():
        signal = by_name[name]
        info = replace(_info(signal, Mode.RAW, {}), name=raw)
        parts.append(_part(message, signal, info, {}))
    return parts


def _codes(message: Message, signal: Signal, reserved: Reserved) -> Mapping[int, State]:
    codes = reserved.get((message.name, signal.name), {})
    if codes and not signal.is_float:
        low, high = signal.raw_limits
        for code in codes:
            if not low <= code <= high:
                raise ReservedCodeError(
                    f"{message.name}.{signal.name}: raw value {code} is given as reserved, "
                    f"the signal has {low} to {high}"
                )
    return codes


def _info(signal: Signal, mode: Mode, reserved: Mapping[int, State]) -> SignalInfo:
    labels = signal.value_table.labels() if signal.value_table else {}
    factor, offset = python_number(signal.factor), python_number(signal.offset)
    plain = factor == 1 and offset == 0 and not signal.is_float
    encoded = mode is Mode.LABELS and plain and not labels.keys() <= reserved.keys()
    return SignalInfo(
        name=signal.name,
        unit=signal.unit,
        factor=factor,
        offset=offset,
        scaled=mode is not Mode.RAW and not encoded,
        labels=labels,
        encoded=encoded,
    )


def _part(
    message: Message, signal: Signal, info: SignalInfo, reserved: Mapping[int, State]
) -> Part | Wide:
    scaling = scaling_of(signal) if info.scaled else Scaling(raw_dtype(signal))
    raw = raw_dtype(signal)
    lane = lane_of(signal, SHORT if message.length <= SHORT else LONG)
    if lane is None or not scaling.vector or raw.kind == "O":
        factor_and_offset = to_physical(signal) if info.scaled else None
        return Wide(info.name, signal, message.length, scaling.dtype, factor_and_offset, reserved)
    signed = signal.signed and not signal.is_float
    return Part(info.name, lane, signed, raw, scaling, reserved)
