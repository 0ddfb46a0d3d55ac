"""Codes that are labelled as no value stay, where only labels tell them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from dbcspec.compare.codes import code_pairs, quoted
from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise
from dbcspec.compare.senses import means_no_value
from dbcspec.compare.spec_only import both_are_specs
from typedcan.model.protocol import Code


def _check(pairing: Pairing) -> Iterator[Change]:
    if both_are_specs(pairing):
        return  # They name invalid codes, which another promise compares.
    for codes in code_pairs(pairing):
        old = _only_here(codes.old, codes.new)
        new = _only_here(codes.new, codes.old)
        if old or new:
            yield codes.change(f"codes for no value {old or 'none'} → {new or 'none'}", old, new)


def _only_here(here: Mapping[int, Code], there: Mapping[int, Code]) -> str:
    return ", ".join(
        f"{value} {quoted(code)}"
        for value, code in here.items()
        if value not in there and means_no_value(code.english or code.label)
    )


PROMISE = Promise(
    "code-no-value-same",
    "The raw values that are labelled invalid or abnormal stay what they are.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
