"""What two other readers see in a DBC file, in terms of the model; they share no code with it."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

import canmatrix.formats
import cantools.database
from cantools.database.can import Database
from cantools.database.can import Signal as CantoolsSignal

from typedcan.model.protocol import ByteOrder, Message, Protocol, Signal


@dataclass(frozen=True)
class SignalView:
    """The bits, scaling, codes and receivers of a signal, and when it is there."""

    start: int
    length: int
    intel: bool
    signed: bool
    is_float: bool
    factor: Decimal
    offset: Decimal
    limits: tuple[Decimal, Decimal] | None
    unit: str
    codes: tuple[tuple[int, str], ...]
    receivers: frozenset[str]
    selector: bool
    selected_by: tuple[str, tuple[int, ...]] | None


@dataclass(frozen=True)
class MessageView:
    """A message without its signals."""

    identifier: int
    extended: bool
    length: int
    sender: str
    period: int


Views = tuple[dict[str, MessageView], dict[tuple[str, str], SignalView]]
"""Messages by name, signals by the names of message and signal."""


def of_model(protocol: Protocol, *, open_limits: Views) -> Views:
    """The model's own view; limits are left out where ``open_limits`` has none."""
    return (
        {message.name: _message_of_model(message) for message in protocol.messages},
        {
            (message.name, signal.name): _signal_of_model(
                signal, open_limits[1][message.name, signal.name].limits is None
            )
            for message, signal in protocol.signals()
        },
    )


def _message_of_model(message: Message) -> MessageView:
    return MessageView(
        message.frame_id, message.extended, message.length, message.sender, message.period or 0
    )


def _signal_of_model(signal: Signal, is_open: object) -> SignalView:
    codes = signal.value_table.codes if signal.value_table else ()
    return SignalView(
        start=signal.start,
        length=signal.length,
        intel=signal.byte_order is ByteOrder.INTEL,
        signed=signal.signed,
        is_float=signal.is_float,
        factor=signal.factor,
        offset=signal.offset,
        limits=None if is_open else (signal.minimum, signal.maximum),
        unit=signal.unit,
        codes=tuple((code.value, code.english) for code in codes),
        receivers=frozenset(signal.receivers),
        selector=signal.is_selector,
        selected_by=(signal.multiplexer, signal.selectors) if signal.multiplexer else None,
    )


def by_cantools(path: Path, encoding: str) -> Views:
    """The file as cantools reads it."""
    database = cantools.database.load_file(path, encoding=encoding, strict=False)
    assert isinstance(database, Database)
    messages = {
        message.name: MessageView(
            message.frame_id,
            message.is_extended_frame,
            message.length,
            message.senders[0] if message.senders else "",
            message.cycle_time or 0,
        )
        for message in database.messages
    }
    signals = {
        (message.name, signal.name): _signal_by_cantools(signal)
        for message in database.messages
        for signal in message.signals
    }
    return messages, signals


def _signal_by_cantools(signal: CantoolsSignal) -> SignalView:
    limits = None
    if signal.minimum is not None and signal.maximum is not None:
        limits = Decimal(repr(signal.minimum)), Decimal(repr(signal.maximum))
    selected = signal.multiplexer_signal and signal.multiplexer_ids
    return SignalView(
        start=signal.start,
        length=signal.length,
        intel=signal.byte_order == "little_endian",
        signed=signal.is_signed,
        is_float=signal.is_float,
        factor=Decimal(repr(signal.scale)),
        offset=Decimal(repr(signal.offset)),
        limits=limits,
        unit=signal.unit or "",
        codes=tuple(sorted((code, str(text)) for code, text in (signal.choices or {}).items())),
        receivers=frozenset(signal.receivers) - {"Vector__XXX"},
        selector=signal.is_multiplexer,
        selected_by=(
            (str(signal.multiplexer_signal), tuple(sorted(signal.multiplexer_ids or ())))
            if selected
            else None
        ),
    )


def by_canmatrix(path: Path, encoding: str) -> Views:
    """The file as canmatrix reads it."""
    options = {"dbcImportEncoding": encoding, "dbcImportCommentEncoding": encoding}
    matrix: Any = canmatrix.formats.loadp_flat(str(path), **options)
    messages: dict[str, MessageView] = {}
    signals: dict[tuple[str, str], SignalView] = {}
    for frame in matrix.frames:
        if frame.name == "VECTOR__INDEPENDENT_SIG_MSG":
            continue
        messages[frame.name] = MessageView(
            frame.arbitration_id.id,
            bool(frame.arbitration_id.extended),
            frame.size,
            next((name for name in frame.transmitters if name != "Vector__XXX"), ""),
            int(frame.cycle_time or 0),
        )
        for signal in frame.signals:
            signals[frame.name, signal.name] = _signal_by_canmatrix(frame, signal)
    return messages, signals


def _signal_by_canmatrix(frame: Any, signal: Any) -> SignalView:
    ids: list[int] = []
    if signal.mux_val_grp:
        for low, high in signal.mux_val_grp:
            ids.extend(range(int(low), int(high) + 1))
    elif signal.mux_val is not None:
        ids = [int(signal.mux_val)]
    selector = signal.muxer_for_signal or next(
        (each.name for each in frame.signals if each.multiplex == "Multiplexor"), ""
    )
    return SignalView(
        start=signal.get_startbit(bit_numbering=1),
        length=signal.size,
        intel=signal.is_little_endian,
        signed=signal.is_signed,
        is_float=signal.is_float,
        factor=Decimal(signal.factor),
        offset=Decimal(signal.offset),
        limits=(Decimal(signal.min), Decimal(signal.max)),
        unit=signal.unit,
        codes=tuple(sorted((int(code), text) for code, text in signal.values.items())),
        receivers=frozenset(signal.receivers) - {"Vector__XXX"},
        selector=bool(signal.is_multiplexer),
        selected_by=(selector, tuple(sorted(ids))) if ids else None,
    )
