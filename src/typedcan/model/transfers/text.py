"""Texts: characters in numbered frames of one message, or in several messages."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import takewhile
from types import MappingProxyType
from typing import Any, ClassVar, Literal

from typedcan.model.codes import value_codes
from typedcan.model.protocol import ByteOrder, Signal
from typedcan.model.transfer import Ending
from typedcan.model.transfers.kind import (
    Frame,
    Kind,
    SplitError,
    Unfit,
    in_frames,
    one_count,
    one_message,
    whole_numbers,
)
from typedcan.model.transfers.parts import Parts
from typedcan.model.transfers.set_frames import split_items
from typedcan.model.transfers.sets import SetRules, Wrong

ENCODINGS = (
    *("ascii", "latin-1", "cp1252", "utf-8", "utf-16-le", "utf-16-be"),
    *("gb2312", "gbk", "gb18030", "big5", "shift_jis", "euc_kr"),
)
"""What the bytes of a text can be."""

_LISTED = 64
"""Characters that are named one by one."""


@dataclass(frozen=True, slots=True)
class Text:
    """A text that arrived complete.

    Parameters
    ----------
    transfer
        The name of its transfer.
    text
        Its characters.
    details
        What belongs to it, by the names of fields.
    at
        When it was complete, in seconds.
    """

    transfer: str
    text: str
    details: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    at: float = 0.0

    def __str__(self) -> str:
        return self.text


class TextKind(Kind):
    """What both kinds of texts have in common."""

    value = Text
    takes: ClassVar[frozenset[str]] = frozenset(
        {"count", "length", "length_signal", "fill", "encoding", "details", "rounds"}
    )

    def own_problems(self, parts: Parts) -> Iterator[Unfit]:
        """What does not fit: items that are no characters, and where the text ends."""
        transfer = parts.transfer
        yield from whole_numbers(parts, "length_signal")
        yield from _bad_items(parts)
        if transfer.encoding and transfer.encoding not in ENCODINGS:
            yield Unfit("encoding", f"{transfer.encoding!r} is none of {', '.join(ENCODINGS)}")
        if transfer.length is Ending.TO_FILL:
            if transfer.fill is None:
                yield Unfit("fill", "missing, the text ends at the first one")
            if transfer.length_signal:
                yield Unfit("length", "`length_signal` tells it already")
        if transfer.count and not transfer.count_signal:
            yield from in_frames(parts, transfer.count)

    def rules(
        self, parts: Parts, timeout: float | None = None, rounds: int | None = None
    ) -> SetRules[Text]:
        """What puts the text together."""
        return SetRules(parts, _Maker(parts), ("text", "characters"), timeout, rounds)

    def split(self, parts: Parts, value: Any) -> list[Frame]:
        """The frames of a text, or of a `Text` with its details."""
        given = value if isinstance(value, Text) else Text(parts.transfer.name, str(value))
        return split_items(parts, _codes(parts, given.text), given.details)

    def columns(self, parts: Parts) -> Mapping[str, type]:
        """The text."""
        del parts
        return {"text": str}

    def cells(self, parts: Parts, value: Any) -> tuple[Any, ...]:
        """The text."""
        del parts
        return (str(value),)


class TextOverFrames(TextKind):
    """Characters in numbered frames of one message."""

    name = "text_over_frames"
    purpose = "a text in numbered frames of one message"
    takes = TextKind.takes | {"frame_number", "first_number", "count_signal", "counted"}
    needs = ("frame_number",)

    def own_problems(self, parts: Parts) -> Iterator[Unfit]:
        """What does not fit."""
        yield from one_message(parts)
        yield from whole_numbers(parts, "frame_number", "count_signal")
        yield from one_count(parts.transfer, "count", "count_signal")
        yield from super().own_problems(parts)


class TextOverMessages(TextKind):
    """Characters in several messages."""

    name = "text_over_messages"
    purpose = "a text in several messages"

    def own_problems(self, parts: Parts) -> Iterator[Unfit]:
        """What does not fit."""
        order = [part.message.name for part in parts.items]
        for message in parts.messages:
            if message.name not in order:
                yield Unfit("messages", f"{message.name} has no item of the text")
        if tuple(dict.fromkeys(order)) != tuple(message.name for message in parts.messages):
            yield Unfit("items", "not in the order of the messages")
        yield from super().own_problems(parts)


class _Maker:
    """Makes the text of its items."""

    def __init__(self, parts: Parts) -> None:
        self._transfer = parts.transfer
        self._items = parts.items
        self._tables = [] if parts.transfer.encoding else _tables(parts)
        self._encoding = parts.transfer.encoding or "ascii"
        fill = parts.transfer.fill if parts.transfer.length is Ending.TO_FILL else None
        self._ends = () if fill is None else tuple(part.value_of(fill) for part in parts.items)

    def __call__(self, items: Sequence[Any], details: Mapping[str, Any], at: float) -> Text | Wrong:
        """The text, or what is wrong with it."""
        if self._ends:
            items = [*takewhile(lambda item: item not in self._ends, items)]
        text = self._labelled(items) if self._tables else self._decoded(items)
        if isinstance(text, tuple):
            return text
        return Text(self._transfer.name, text, MappingProxyType(dict(details)), at)

    def _labelled(self, items: Sequence[Any]) -> str | Wrong:
        letters: list[str] = []
        for position, code in enumerate(items):
            table = self._tables[position % len(self._tables)]
            if code not in table:
                return _no_character(position, code, f"none of {_listed(table.values())}")
            letters.append(table[code])
        return "".join(letters)

    def _decoded(self, items: Sequence[Any]) -> str | Wrong:
        raw = bytearray()
        for position, code in enumerate(items):
            if not isinstance(code, int):
                return _no_character(position, code, f"no {self._encoding}")
            raw += _bytes_of(self._items[position % len(self._items)].signal, code)
        try:
            text = raw.decode(self._encoding)
        except UnicodeDecodeError as error:
            wrong = raw[error.start]
            return "character", f"byte {error.start + 1} is 0x{wrong:02X}: no {self._encoding}"
        for position, letter in enumerate(text, 1):
            if not letter.isprintable():
                return "character", f"character {position} is {letter!a}, which is not printable"
        return text


def characters(parts: Parts) -> frozenset[str]:
    """The characters that every item can hold; empty where no tables name them."""
    tables = _tables(parts)
    return frozenset.intersection(*map(frozenset, (table.values() for table in tables)))


def _listed(letters: Iterable[str]) -> str:
    """Characters for people."""
    listed = "".join(sorted(letters))
    return listed if len(listed) <= _LISTED else f"{listed[:_LISTED]}..."


def _tables(parts: Parts) -> list[dict[int, str]]:
    """The characters of each item by their codes; none where not all items have some."""
    found: list[dict[int, str]] = []
    for part in parts.items:
        codes = {code.value: code.english for code in value_codes(part.signal)}
        found.append({code: label for code, label in codes.items() if len(label) == 1})
    return found if all(found) else []


def _codes(parts: Parts, text: str) -> list[int]:
    """The codes of a text, one an item; raises `SplitError`."""
    tables = [] if parts.transfer.encoding else _tables(parts)
    if tables:
        codes: list[int] = []
        for position, letter in enumerate(text):
            table = tables[position % len(tables)]
            code = next((code for code, label in table.items() if label == letter), None)
            if code is None:
                listed = _listed(table.values())
                raise SplitError(f"character {position + 1}, {letter!r}, is none of {listed}")
            codes.append(code)
        return codes
    encoding = parts.transfer.encoding or "ascii"
    try:
        raw = text.encode(encoding)
    except UnicodeEncodeError as error:
        letter = text[error.start]
        raise SplitError(f"character {error.start + 1}, {letter!r}, is no {encoding}") from None
    signal = parts.items[0].signal
    width = -(signal.length // -8)
    order: Literal["little", "big"] = "little" if signal.byte_order is ByteOrder.INTEL else "big"
    return [int.from_bytes(raw[at : at + width], order) for at in range(0, len(raw), width)]


def _bytes_of(signal: Signal, code: int) -> bytes:
    """The bytes of an item in the order of the frame."""
    order: Literal["little", "big"] = "little" if signal.byte_order is ByteOrder.INTEL else "big"
    return code.to_bytes(-(signal.length // -8), order)


def _bad_items(parts: Parts) -> Iterator[Unfit]:
    if not parts.items:
        yield Unfit("items", "missing")
    lengths = {part.signal.length for part in parts.items}
    for part in parts.items:
        signal = part.signal
        if not part.is_whole_number:
            yield Unfit("items", f"{signal.name} holds no characters: it has a sign or a scale")
        elif signal.length > 8 and signal.length % 8:
            yield Unfit("items", f"{signal.name} has {signal.length} bits: no whole bytes")
    if len(lengths) > 1:
        yield Unfit("items", "of different numbers of bits")
    fill = parts.transfer.fill
    if fill is not None and lengths and not 0 <= fill < 1 << min(lengths):
        yield Unfit("fill", f"{fill} has no room in {min(lengths)} bits")


def _no_character(position: int, code: Any, which: str) -> Wrong:
    shown = f"0x{code:02X}" if isinstance(code, int) else str(code)
    return "character", f"character {position + 1} is {shown}, which is {which}"
