"""What the rows of a message say of its checksum and its counter."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence

from dbcspec.matrix.row import Row
from typedcan.model.checksums.registry import canonical_name
from typedcan.model.protection import Checksum, Counter, covered_bytes
from typedcan.model.protocol import Message
from typedcan.model.seal import protection_faults

_NUMBERS = r"(?:0x[\da-f]{1,2}|\d{1,3})(?: (?:0x[\da-f]{1,2}|\d{1,3})){0,63}"
_BYTES = r"\d{1,2}(?:~\d{1,2})?(?: \d{1,2}(?:~\d{1,2})?){0,63}"
_CHECKSUM = re.compile(
    rf"checksum (?P<algorithm>[^,]{{1,200}}), bytes (?P<covered>{_BYTES})"
    rf"(?:, before (?P<before>{_NUMBERS}))?(?:, after (?P<after>{_NUMBERS}))?"
    rf"(?:, data_ids (?P<data_ids>{_NUMBERS}))?(?P<open>, open)?",
    re.IGNORECASE,
)
_COUNTER = re.compile(
    r"counter, modulus (?P<modulus>\d{1,10})"
    r"(?:, first (?P<first>\d{1,10}))?(?:, step (?P<step>-?\d{1,10}))?",
    re.IGNORECASE,
)


def protected(message: Message, rows: Sequence[Row]) -> Message:
    """The message with what its rows say; what is wrong with that is a fault of its row."""
    named: dict[str, Row] = {}
    for row in rows:
        name, text = row.name("signal_name"), row.text("protection")
        other: Checksum | Counter | None = None
        if match := _CHECKSUM.fullmatch(text):
            other = message.checksum
            message = dataclasses.replace(message, checksum=_checksum(name, match))
        elif match := _COUNTER.fullmatch(text):
            other = message.counter
            message = dataclasses.replace(message, counter=_counter(name, match))
        elif text:
            example = "'Checksum xor, bytes 1~7' or 'Counter, modulus 16'"
            row.fault("protection", f"expected {example}, not {text[:40]!r}")
        if other:
            row.fault("protection", f"{message.name} has {other.signal} already for this")
        named[name] = row
    for name, _, text in protection_faults(message):
        named[name].fault("protection", text)
    return message


def _checksum(name: str, found: re.Match[str]) -> Checksum:
    return Checksum(
        signal=name,
        algorithm=canonical_name(found["algorithm"]),
        covered=covered_bytes(found["covered"]),
        before=_numbers(found["before"]),
        after=_numbers(found["after"]),
        data_ids=_numbers(found["data_ids"]),
        is_open=bool(found["open"]),
    )


def _counter(name: str, found: re.Match[str]) -> Counter:
    first, step = int(found["first"] or 0), int(found["step"] or 1)
    return Counter(signal=name, modulus=int(found["modulus"]), first=first, step=step)


def _numbers(text: str | None) -> tuple[int, ...]:
    words = (text or "").lower().split()
    return tuple(int(word, 16 if "x" in word else 10) for word in words)
