"""A transfer counts as received after the same time and number of sets."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change
from dbcspec.compare.transfers import RECEIVED, transfer_pairs
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for old, new in transfer_pairs(pairing):
        if old and new:
            for key in RECEIVED:
                before, after = (getattr(side, key) for side in (old, new))
                if before != after:
                    texts = ("" if value is None else str(value) for value in (before, after))
                    yield protocol_change(new.name, f"{key} of transfer", *texts)


PROMISE = Promise(
    "transfer-reception-same",
    "A value of several frames counts as received after the same time and number of sets.",
    Class.SOURCE,
    Breaks.RECEIVER,
    _check,
    needs=Aspect.TRANSFERS,
)
