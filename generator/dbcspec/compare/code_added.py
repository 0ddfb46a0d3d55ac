"""No code is new."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.codes import code_pairs, one_sided, quoted, shortened
from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise


def _check(pairing: Pairing) -> Iterator[Change]:
    for codes in code_pairs(pairing):
        added = [
            f"{code.value} {quoted(code)}" for code in one_sided(codes, pairing, removed=False)
        ]
        if added:
            yield codes.change(f"code {shortened(added)} added", "", "; ".join(added))


PROMISE = Promise(
    "code-added",
    "A raw value that has a meaning had one before.",
    Class.ADDITIVE,
    Breaks.RECEIVER,
    _check,
)
