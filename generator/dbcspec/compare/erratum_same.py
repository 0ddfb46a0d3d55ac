"""An erratum keeps its text."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change
from dbcspec.compare.spec_only import both_are_specs
from typedcan.model.protocol import Aspect, Erratum


def _check(pairing: Pairing) -> Iterator[Change]:
    if not both_are_specs(pairing):
        return
    old = {erratum.id: erratum for erratum in pairing.old.errata}
    new = {erratum.id: erratum for erratum in pairing.new.errata}
    for number in dict.fromkeys((*old, *new)):
        before, after = old.get(number), new.get(number)
        if before != after:
            yield protocol_change(number, "erratum", _text(before, after), _text(after, before))


def _text(erratum: Erratum | None, other: Erratum | None) -> str:
    """What is read, and what else is different from the other."""
    if erratum is None:
        return ""
    parts = [erratum.kind, erratum.place, erratum.printed, erratum.reading, erratum.because]
    if other is None:
        return erratum.reading or erratum.id
    others = [other.kind, other.place, other.printed, other.reading, other.because]
    return "; ".join(mine for mine, its in zip(parts, others, strict=True) if mine != its)


PROMISE = Promise(
    "erratum-same",
    "The errata are the same, and say the same.",
    Class.COSMETIC,
    Breaks.NOBODY,
    _check,
    needs=Aspect.REFERENCES,
)
