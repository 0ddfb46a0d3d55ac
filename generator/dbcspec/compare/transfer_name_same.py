"""A transfer keeps its name."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change
from dbcspec.compare.transfers import transfer_pairs
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for old, new in transfer_pairs(pairing):
        if old and new and old.name != new.name:
            yield protocol_change(new.name, "name of transfer", old.name, new.name)


PROMISE = Promise(
    "transfer-name-same",
    "A transfer over the same messages is called the same in code.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
    needs=Aspect.TRANSFERS,
)
