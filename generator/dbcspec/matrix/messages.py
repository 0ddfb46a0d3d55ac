"""The rows of the matrix to messages: one row for a message, or its facts on every signal's row."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from dbcspec.matrix.grid import CellValue
from dbcspec.matrix.headings import normal
from dbcspec.matrix.protection import protected
from dbcspec.matrix.row import Row, Sheet
from dbcspec.matrix.signal import SharedTables, SignalDraft
from dbcspec.matrix.values import CellError, identifier_of, names_of, text_of, whole_of
from typedcan.model.protocol import Message, SendType, Signal

_MESSAGE_KEYS = ("frame_format", "send_type", "period", "condition", "msg_length", "msg_title")
_SHARED_KEYS = ("title", "english", "reference", "errata")
_LONGEST_PERIOD = 10**9
_LONGEST_MESSAGE = 65_535
_SEND_TYPES = {
    **dict.fromkeys(
        ("cyclic", "cycle", "periodic", "周期", "周期型", "ce", "周期事件", "周期事件型", "混合"),
        SendType.CYCLIC,
    ),
    **dict.fromkeys(("ifactive", "cyclicifactive", "条件周期", "使能周期"), SendType.IF_ACTIVE),
    **dict.fromkeys(
        ("event", "onevent", "spontaneous", "事件", "事件型", "nomsgsendtype", "e"), SendType.EVENT
    ),
}


@dataclass(slots=True)
class _MessageDraft:
    """What the rows say of one message, until all of them are read."""

    row: Row
    name: str
    frame_id: int
    facts: dict[str, Row] = field(default_factory=dict[str, Row])
    senders: dict[str, None] = field(default_factory=dict[str, None])
    receivers: dict[str, None] = field(default_factory=dict[str, None])
    signals: list[SignalDraft] = field(default_factory=list[SignalDraft])


def read_messages(sheet: Sheet, tables: SharedTables) -> list[Message]:
    """All messages of a sheet, in order of appearance; faults are left in the sheet."""
    drafts = _Drafts(sheet)
    for row in sheet.rows():
        drafts.take(row)
    _check_start_bytes(drafts.all)
    return [_message(draft, tables) for draft in drafts.all]


class _Drafts:
    """Sorts rows to messages by name and identifier, so that a sorted sheet reads the same."""

    def __init__(self, sheet: Sheet) -> None:
        self._sheet = sheet
        self.all: list[_MessageDraft] = []
        self._current: _MessageDraft | None = None
        self._signal: SignalDraft | None = None

    def take(self, row: Row) -> None:
        signal_name = row.name("signal_name")
        name, cell = row.name("msg_name"), row.cell("msg_id")
        if not (signal_name or name or not cell.is_blank):
            self._continue(row)
            return
        draft = self._find(row, name)
        if draft is None:
            return
        self._current = draft
        self._facts(draft, row, _MESSAGE_KEYS)
        senders, receivers = row.roles()
        senders += names_of(row.text("sender"))
        draft.senders |= dict.fromkeys(senders)
        if signal_name:
            self._signal = SignalDraft(row, senders, receivers)
            if any(each.row.name("signal_name") == signal_name for each in draft.signals):
                row.fault("signal_name", f"{draft.name} has two signals {signal_name}")
            draft.signals.append(self._signal)
            return
        self._signal = None
        if not row.cell("start_bit").is_blank:
            row.fault("signal_name", "a signal without a name")
        draft.receivers |= dict.fromkeys(receivers)
        self._facts(draft, row, _SHARED_KEYS)

    def _continue(self, row: Row) -> None:
        """A row without names goes on with the codes above it, or says nothing of signals."""
        has_codes = not (row.cell("codes").is_blank and row.cell("english_codes").is_blank)
        if has_codes and self._signal:
            self._signal.more.append(row)
        elif not row.cell("start_bit").is_blank:
            row.fault("signal_name", "a signal without a name")

    def _find(self, row: Row, name: str) -> _MessageDraft | None:
        """The message that a row belongs to, a new one where there is none yet."""
        before = len(self._sheet.faults)
        hexadecimal = row.is_hex("msg_id")
        frame_id = row.read(
            "msg_id", lambda cell: identifier_of(cell, hexadecimal=hexadecimal), None
        )
        if not name and frame_id is None:
            if self._current is None:
                row.fault("msg_name", "this signal belongs to no message")
            return self._current
        for draft in self._candidates():
            if name in ("", draft.name) and frame_id in (None, draft.frame_id):
                return draft
        if len(self._sheet.faults) > before:
            return None
        if not name or frame_id is None:
            missing = "name" if not name else "identifier"
            row.fault("msg_id" if name else "msg_name", f"this message has no {missing}")
            return None
        self.all.append(_MessageDraft(row, name, frame_id))
        return self.all[-1]

    def _candidates(self) -> Iterator[_MessageDraft]:
        if self._current:
            yield self._current
        yield from self.all

    def _facts(self, draft: _MessageDraft, row: Row, keys: Iterable[str]) -> None:
        """Remember the row that states a fact; a second one must state the same."""
        for key in keys:
            if not row.cell(key).text:
                continue
            first = draft.facts.setdefault(key, row)
            if normal(first.cell(key).text) != normal(row.cell(key).text):
                text = f"{draft.name}: differs from row {first.index + 1}"
                row.fault(key, f"{text}, which says {first.cell(key).text!r}")


def _message(draft: _MessageDraft, tables: SharedTables) -> Message:
    signals = _demultiplexed(
        draft, [_received(draft, each).signal(tables) for each in draft.signals]
    )

    def fact(key: str) -> Row:
        return draft.facts.get(key, draft.row)

    def text(key: str) -> str:
        return fact(key).text(key) if key in draft.facts else ""

    extended = fact("frame_format").read("frame_format", _extended, None)
    is_fd, switched = _fd(text("frame_format"))
    if extended is False and draft.frame_id > 0x7FF:
        fact("frame_format").fault("frame_format", f"0x{draft.frame_id:X} is no 11-bit identifier")
    period = fact("period").read("period", lambda cell: whole_of(cell, 0, _LONGEST_PERIOD), None)
    send_type = fact("send_type").read("send_type", _send_type, None)
    message = Message(
        name=draft.name,
        title=text("title") or text("msg_title"),
        english=text("english"),
        frame_id=draft.frame_id,
        extended=draft.frame_id > 0x7FF if extended is None else extended,
        length=_length(draft, fact("msg_length")),
        is_fd=is_fd,
        bit_rate_switch=is_fd and switched,
        by_pgn=not is_fd and "j1939" in text("frame_format").lower(),
        sender=next(iter(draft.senders), ""),
        other_senders=tuple(draft.senders)[1:],
        period=period or None,
        send_type=send_type or (SendType.CYCLIC if period else SendType.EVENT),
        condition=text("condition"),
        signals=tuple(signals),
        reference=text("reference"),
        errata=names_of(text("errata")),
        where=draft.row.where,
    )
    return protected(message, [each.row for each in draft.signals])


def _received(draft: _MessageDraft, signal: SignalDraft) -> SignalDraft:
    """Where only the message's row says who receives, all its signals are received there."""
    if any(each.receivers for each in draft.signals):
        return signal
    return dataclasses.replace(signal, receivers=list(draft.receivers))


def _length(draft: _MessageDraft, row: Row) -> int:
    if not row.sheet.has("msg_length"):
        return 8
    before = len(row.sheet.faults)
    length = row.read("msg_length", lambda cell: whole_of(cell, 0, _LONGEST_MESSAGE), None)
    if length is None and len(row.sheet.faults) == before:
        draft.row.fault("msg_length", f"message {draft.name} has no length")
    return length or 0


def _demultiplexed(draft: _MessageDraft, signals: list[Signal]) -> Iterator[Signal]:
    """The signals; one that names no selector belongs to the only one of its message."""
    selectors = [signal.name for signal in signals if signal.is_selector]
    for signal, each in zip(signals, draft.signals, strict=True):
        if not signal.selectors:
            yield signal
            continue
        others = [name for name in selectors if name != signal.name]
        multiplexer = signal.multiplexer or (others[0] if len(others) == 1 else "")
        if multiplexer not in others:
            text = f"{draft.name} has no selector (M) {multiplexer}".rstrip()
            if not multiplexer and others:
                text = f"{draft.name} has several selectors: write m0 @{others[0]}"
            each.row.fault("multiplexing", text)
        yield dataclasses.replace(signal, multiplexer=multiplexer)


def _fd(frame_format: str) -> tuple[bool, bool]:
    """Whether a frame format is one of CAN FD, and whether it switches the bit rate."""
    words = re.findall(r"[a-z]+", frame_format.lower())
    return any(word.endswith("fd") for word in words), "no" not in words


def _extended(cell: CellValue) -> bool | None:
    text = normal(text_of(cell)).lower()
    if any(word in text for word in ("ext", "扩展", "j1939", "29")):
        return True
    if any(word in text for word in ("std", "standard", "标准", "11")):
        return False
    if text:
        raise CellError(f"expected Extended or Standard, not {text[:40]!r}")
    return None


def _send_type(cell: CellValue) -> SendType | None:
    text = re.sub(r"[\W_]+", "", normal(text_of(cell)).lower())
    if text and text not in _SEND_TYPES:
        raise CellError(f"expected Cyclic, IfActive or Event, not {cell.text[:40]!r}")
    return _SEND_TYPES.get(text)


def _check_start_bytes(drafts: Iterable[_MessageDraft]) -> None:
    """A start byte must hold the start bit; bytes are counted from 0 or, as some do, from 1."""
    printed: list[tuple[Row, int, int]] = []
    for row in (each.row for draft in drafts for each in draft.signals):
        try:
            byte = whole_of(row.cell("start_byte"), 0, _LONGEST_MESSAGE)
            bit = whole_of(row.cell("start_bit"), 0, 8 * _LONGEST_MESSAGE)
        except CellError as error:
            if row.cell("start_byte").kind:
                row.fault("start_byte", str(error))
            continue
        if byte is not None and bit is not None:
            printed.append((row, byte, bit // 8))
    first = max((0, 1), key=lambda base: sum(byte - base == real for _, byte, real in printed))
    for row, byte, real in printed:
        if byte - first != real:
            text = f"byte {byte} does not hold the start bit: that is in byte {real + first}"
            row.fault("start_byte", text)
