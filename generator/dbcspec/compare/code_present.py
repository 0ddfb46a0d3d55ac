"""A code stays."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.codes import code_pairs, one_sided, quoted, shortened
from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise


def _check(pairing: Pairing) -> Iterator[Change]:
    for codes in code_pairs(pairing):
        removed = [
            f"{code.value} {quoted(code)}" for code in one_sided(codes, pairing, removed=True)
        ]
        if removed:
            yield codes.change(f"code {shortened(removed)} removed", "; ".join(removed), "")


PROMISE = Promise(
    "code-present",
    "A raw value that had a meaning still has one.",
    Class.WIRE,
    Breaks.SENDER,
    _check,
)
