"""Transfers before and after, once for all promises that speak of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields
from enum import Enum

from dbcspec.compare.pairing import Pairing
from typedcan.model.transfer import Transfer


def transfer_pairs(pairing: Pairing) -> Iterator[tuple[Transfer | None, Transfer | None]]:
    """Transfers that continue each other by name, else by their messages; then what is left."""
    waiting = {transfer.name: transfer for transfer in pairing.new.transfers}
    rest: list[Transfer] = []
    for old in pairing.old.transfers:
        if old.name in waiting:
            yield old, waiting.pop(old.name)
        else:
            rest.append(old)
    for old in rest:
        messages = tuple(pairing.names.get(name, name) for name in old.messages)
        same = next((new for new in waiting.values() if new.messages == messages), None)
        yield old, waiting.pop(same.name) if same else None
    for new in waiting.values():
        yield None, new


CALLED = ("name", "table", "column")
"""What programs call a transfer and its tables."""

RECEIVED = ("timeout", "rounds")
"""What a receiver goes by, whatever is sent."""

_SAID_ELSEWHERE = (*CALLED, *RECEIVED, "english")


def layout(transfer: Transfer | None, names: Mapping[str, str]) -> dict[str, str]:
    """What lays a transfer out, by the words for it; ``names`` are those of renamed things."""
    if transfer is None:
        return {}
    return {
        part.name.replace("_", " "): _text(getattr(transfer, part.name), names)
        for part in fields(transfer)
        if part.name not in _SAID_ELSEWHERE
    }


def _text(value: object, names: Mapping[str, str]) -> str:
    if isinstance(value, tuple):
        return ", ".join(_text(each, names) for each in value)
    if isinstance(value, Enum):
        return str(value.value)
    return "" if value is None else names.get(str(value), str(value))


def follows(pairing: Pairing, old: Transfer | None, new: Transfer | None) -> bool:
    """Whether its messages themselves are all gone or all new, which other promises tell."""
    if old is None:
        return new is not None and pairing.fresh.issuperset(new.messages)
    return new is None and pairing.gone.issuperset(old.messages)
