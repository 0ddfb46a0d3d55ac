"""The checksums and counters of behaviour.yaml to those of a message."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator
from typing import TypeVar

from dbcspec.errors import Fault
from dbcspec.spec.behaviour_rows import ChecksumRow, CounterRow
from dbcspec.spec.rows import Spec
from typedcan.model.checksums.registry import canonical_name, is_known
from typedcan.model.e2e import PROFILES, e2e_checksum
from typedcan.model.layout import bits
from typedcan.model.protection import Checksum, Counter, covered_bytes
from typedcan.model.protocol import Message
from typedcan.model.seal import protection_faults

RowT = TypeVar("RowT", ChecksumRow, CounterRow)

_LONGEST = 64
"""Bytes of the longest frame."""


def filled_in(spec: Spec) -> dict[str, int]:
    """By signal, or ``message.signal``, the start value of what carries a checksum or a counter."""
    behaviour = spec.behaviour
    counters = {row.signal: int(row.range[0]) if row.range else 0 for row in behaviour.counters}
    return counters | {row.signal: 0 for row in behaviour.checksums}


def protected(message: Message, spec: Spec, faults: list[Fault]) -> Message:
    """The message with its checksum and its counter; what is wrong with them is a fault."""
    behaviour, before = spec.behaviour, len(faults)
    counting = _row_of(message, behaviour.counters, faults)
    checked = _row_of(message, behaviour.checksums, faults)
    if counting:
        counter = _counter(*counting, faults)
        message = dataclasses.replace(message, counter=counter)
    if checked:
        checksum = _checksum(message, *checked, faults)
        message = dataclasses.replace(message, checksum=checksum)
    if len(faults) == before:
        rows = [each[1] for each in (checked, counting) if each]
        for name, key, text in protection_faults(message):
            row = next(each for each in rows if each.signal.rpartition(".")[2] == name)
            faults.append(Fault(row.where_is(key), text))
    return message


def _row_of(message: Message, rows: Iterable[RowT], faults: list[Fault]) -> tuple[str, RowT] | None:
    """The signal of a message that a row speaks of, and the row; another one is a fault."""
    names = {signal.name for signal in message.signals}
    found: tuple[str, RowT] | None = None
    for row in rows:
        where, _, name = row.signal.rpartition(".")
        if name not in names or where not in ("", message.name):
            continue
        if found:
            text = f"{row.signal}: {message.name} has {found[0]} already for this"
            faults.append(Fault(row.where_is("signal"), text))
        found = found or (name, row)
    return found


def _missing(row: ChecksumRow | CounterRow, key: str) -> Fault:
    text = f"{row.identity}: {key} is missing, and no erratum gives it"
    return Fault(row.where_is(key), text)


def _counter(name: str, row: CounterRow, faults: list[Fault]) -> Counter:
    if row.range is None:
        if row.modulus is None:
            faults.append(_missing(row, "modulus"))
        return Counter(signal=name, modulus=row.modulus or 1)
    first, last = map(int, row.range)
    if [first, last] != [*row.range] or not row.step or (last - first) % row.step:
        text = f"{name}: steps of {row.step} do not lead from {row.range[0]} to {row.range[1]}"
        faults.append(Fault(row.where_is("range"), text))
        return Counter(signal=name, modulus=1)
    return Counter(signal=name, first=first, step=row.step, modulus=(last - first) // row.step + 1)


def _checksum(
    message: Message, name: str, row: ChecksumRow, faults: list[Fault]
) -> Checksum | None:
    if row.algorithm is None:
        faults.append(_missing(row, "algorithm"))
        return None
    others = tuple(_others(message, name))
    if row.algorithm in PROFILES:
        covered = others if row.bytes in (None, "others") else covered_bytes(row.bytes or "")
        if len(row.data_ids) != PROFILES[row.algorithm]:
            text = f"{name}: {row.algorithm} has {PROFILES[row.algorithm]} data_ids"
            faults.append(Fault(row.where_is("data_ids"), text))
            return None
        return e2e_checksum(row.algorithm, name, covered, row.data_ids)
    if row.bytes is None:
        faults.append(_missing(row, "bytes"))
        return None
    algorithm = canonical_name(row.algorithm)
    if row.open and is_known(algorithm):
        text = f"{name}: {algorithm} is known, so that nothing is left open"
        faults.append(Fault(row.where_is("open"), text))
    return Checksum(
        signal=name,
        algorithm=algorithm,
        covered=others if row.bytes == "others" else covered_bytes(row.bytes),
        before=tuple(_beside(message, row.before)),
        after=tuple(_beside(message, row.after)),
        data_ids=row.data_ids,
        is_open=row.open == "yes",
    )


def _others(message: Message, name: str) -> Iterator[int]:
    """The bytes that a signal does not take whole."""
    own = set(bits(message.signal(name)))
    for byte in range(min(message.length, _LONGEST)):
        if not own.issuperset(range(8 * byte, 8 * byte + 8)):
            yield byte


def _beside(message: Message, parts: Iterable[str]) -> Iterator[int]:
    short = not message.extended and message.frame_id < 1 << 16
    identifier = message.frame_id.to_bytes(2 if short else 4)
    for part in parts:
        if part == "length":
            yield message.length
        elif part.startswith("identifier"):
            yield from identifier if part == "identifier" else reversed(identifier)
        else:
            yield int(part, 16 if part[:2] in ("0x", "0X") else 10)
