"""A message for the terminal: bit matrix, signals, codes, errata, and where each stands."""

from __future__ import annotations

import difflib
import string
import textwrap
from collections.abc import Iterable, Iterator, Sequence

from typedcan.model.errors import ReadError
from typedcan.model.j1939 import needs_several_frames, pgn
from typedcan.model.layout import bits
from typedcan.model.numbers import number
from typedcan.model.protocol import Message, Protocol, Signal, ValueTable
from typedcan.model.transfers.registry import KINDS
from typedcan.shell.printing import printable

_LETTERS = string.ascii_lowercase + string.ascii_uppercase
_WIDTH = 100


def find_message(protocol: Protocol, name: str) -> Message:
    """The message of that name, or with a signal of that name; raises `ReadError`."""
    for message in protocol.messages:
        if name == message.name or any(name == signal.name for signal in message.signals):
            return message
    names = [message.name for message in protocol.messages]
    names += [signal.name for _, signal in protocol.signals()]
    close = difflib.get_close_matches(name, names, n=3)
    hint = f"; did you mean {', '.join(close)}?" if close else ""
    raise ReadError(f"there is no message or signal {name!r}{hint}")


def show(protocol: Protocol, message: Message) -> str:
    """The message as lines of text."""
    blocks = [
        list(_head(message)),
        list(_matrix(message)),
        list(_signals(message)),
        list(_codes(message)),
        list(_acts(message)),
        list(_transfers(protocol, message)),
        list(_errata(protocol, message)),
    ]
    return "\n\n".join("\n".join(map(printable, block)) for block in blocks if block) + "\n"


def _head(message: Message) -> Iterator[str]:
    route = f"{', '.join(message.senders)} > {', '.join(message.receivers)}"
    when = f"every {message.period} ms" if message.period else "on event"
    yield f"{message.name}  0x{message.frame_id:08X}  {message.length} bytes  {route}  {when}"
    yield from filter(None, (message.english, message.title))
    if message.condition:
        yield f"Sent {message.condition}."
    if message.by_pgn:
        yield f"Found by its PGN 0x{pgn(message.frame_id):04X}, from any source address."
    if needs_several_frames(message):
        yield "Takes several frames, by the transport protocol: no single one is received as it."
    if message.is_fd:
        yield f"{message.frame_kind}."
    if message.checksum:
        yield f"Checksum {message.checksum.signal}: {message.checksum}."
    if message.counter:
        yield f"Counter {message.counter.signal}: {message.counter}."
    yield message.reference


def _matrix(message: Message) -> Iterator[str]:
    owner = {
        bit: letter
        for signal, letter in zip(message.signals, _letters(message), strict=True)
        for bit in bits(signal)
    }
    yield "bit      7  6  5  4  3  2  1  0"
    for byte in range(message.length):
        cells = (owner.get(8 * byte + bit, ".").rjust(2) for bit in range(7, -1, -1))
        yield f"byte {byte:<2} {' '.join(cells)}"


def _letters(message: Message) -> list[str]:
    """One or two letters a signal, enough for any frame."""
    pairs = [first + second for first in _LETTERS for second in _LETTERS]
    return [*_LETTERS, *pairs][: len(message.signals)]


def _signals(message: Message) -> Iterator[str]:
    heading = "signal start bits order factor offset range unit where"
    rows: list[tuple[str, ...]] = [("", *heading.split())]
    rows += [
        (letter, *map(printable, _cells(signal)))
        for signal, letter in zip(message.signals, _letters(message), strict=True)
    ]
    yield from _aligned(rows)


def _cells(signal: Signal) -> tuple[str, ...]:
    return (
        signal.name,
        str(signal.start),
        str(signal.length),
        signal.byte_order.value,
        number(signal.factor),
        number(signal.offset),
        f"{number(signal.minimum)}~{number(signal.maximum)}",
        signal.unit,
        " ".join((signal.reference, *signal.errata)),
    )


def _aligned(rows: Sequence[tuple[str, ...]]) -> Iterator[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        yield "  ".join(cells).rstrip()


def _codes(message: Message) -> Iterator[str]:
    users: dict[ValueTable, list[str]] = {}
    for signal in message.signals:
        if signal.value_table:
            users.setdefault(signal.value_table, []).append(signal.name)
    for table, names in users.items():
        labels = ", ".join(
            f"{code.value} {code.english}"
            + (f" ({code.label})" if code.label != code.english else "")
            for code in table.codes
        )
        yield from _indented(f"{table.name}: {labels}")
        yield from _indented(f"    of {', '.join(names)}")


def _acts(message: Message) -> Iterator[str]:
    """Which codes act, and the one that ends what they begin."""
    for signal in message.signals:
        if acting := signal.acting:
            labels = signal.value_table.labels() if signal.value_table else {}
            what = "says that something is on" if acting.reports else "makes its receiver act"
            codes = ", ".join(f"{code} {labels.get(code, '')}".strip() for code in acting.codes)
            safe = f"{acting.safe} {labels.get(acting.safe, '')}".strip()
            cited = f" ({acting.reference})" if acting.reference else ""
            yield from _indented(f"{signal.name} {what}: {codes}; safe: {safe}{cited}")


def _transfers(protocol: Protocol, message: Message) -> Iterator[str]:
    """What the message carries parts of, and how."""
    names = {message.name, *(signal.name for signal in message.signals)}
    for transfer in protocol.transfers:
        told = (transfer.count_signal, transfer.groups_signal)
        if not names.intersection((*transfer.messages, *told)):
            continue
        kind = KINDS.get(transfer.kind)
        purpose = f", {kind.purpose}" if kind else ""
        yield from _indented(
            f"Transfer {transfer.name}: {transfer.english or transfer.kind}{purpose}"
        )
        for key, value in transfer.given().items():
            if key not in ("name", "english"):
                text = ", ".join(map(str, value)) if isinstance(value, tuple) else str(value)
                yield from _indented(f"    {key}: {text}")


def _errata(protocol: Protocol, message: Message) -> Iterator[str]:
    numbers = {*message.errata, *(mark for signal in message.signals for mark in signal.errata)}
    for erratum in protocol.errata:
        if erratum.id in numbers:
            yield from _indented(f"{erratum.id} ({erratum.kind}) {erratum.place}")
            yield from _indented(f"    printed: {erratum.printed}")
            yield from _indented(f"    read:    {erratum.reading}")


def _indented(text: str) -> Iterable[str]:
    return textwrap.wrap(text, _WIDTH, subsequent_indent="        ", break_long_words=False)
