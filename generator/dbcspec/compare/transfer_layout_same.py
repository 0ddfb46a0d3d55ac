"""A transfer keeps its layout."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change
from dbcspec.compare.transfers import follows, layout, transfer_pairs
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for old, new in transfer_pairs(pairing):
        before, after = layout(old, pairing.names), layout(new, {})
        if before != after and not follows(pairing, old, new):
            keys = [key for key in {**before, **after} if before.get(key) != after.get(key)]
            name = new.name if new else old.name if old else ""
            yield protocol_change(name, "transfer", _text(before, keys), _text(after, keys))


def _text(parts: Mapping[str, str], keys: list[str]) -> str:
    return "; ".join(f"{key} {parts[key] or 'none'}" for key in keys if key in parts)


PROMISE = Promise(
    "transfer-layout-same",
    "A value of several frames is split over the same messages and signals in the same way.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
    needs=Aspect.TRANSFERS,
)
