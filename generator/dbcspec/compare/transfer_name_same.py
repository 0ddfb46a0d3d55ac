"""A transfer keeps its name, and its tables and columns keep theirs."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change
from dbcspec.compare.transfers import CALLED, transfer_pairs
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for old, new in transfer_pairs(pairing):
        if old and new:
            for key in CALLED:
                before, after = getattr(old, key), getattr(new, key)
                if before != after:
                    yield protocol_change(new.name, f"{key} of transfer", before, after)


PROMISE = Promise(
    "transfer-name-same",
    "A transfer over the same messages is called the same, and so are its tables.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
    needs=Aspect.TRANSFERS,
)
