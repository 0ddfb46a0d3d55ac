"""A signal keeps the codes that say it has no value."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing, SignalPair
from dbcspec.compare.promise import Breaks, Change, Class, Promise, signal_change
from dbcspec.compare.spec_only import SPEC_ONLY


def _check(pairing: Pairing) -> Iterator[Change]:
    for signal in pairing.signals:
        old, new = signal.old, signal.new
        changes = {  # the same change of both is said once
            (old.abnormal_code, new.abnormal_code): "abnormal code",
            (old.invalid_code, new.invalid_code): "invalid code",
        }
        if old.other_invalid_codes != new.other_invalid_codes:
            was, now = (", ".join(map(str, each.other_invalid_codes)) for each in (old, new))
            yield signal_change(signal, "other invalid codes", was, now)
        for (before, after), word in reversed(changes.items()):
            if before != after and not _is_relabelled(pairing, signal, (before, after)):
                yield signal_change(signal, word, _text(before), _text(after))


def _is_relabelled(pairing: Pairing, signal: SignalPair, values: tuple[int | None, ...]) -> bool:
    """Whether one of the codes means something else by now, which another promise tells."""
    old, new = (
        {code.value: code for code in table.codes} if table else {}
        for table in (signal.old.value_table, signal.new.value_table)
    )
    return any(
        value in old and value in new and not pairing.languages.same_meaning(old[value], new[value])
        for value in values
        if value is not None
    )


def _text(code: int | None) -> str:
    return "" if code is None else str(code)


PROMISE = Promise(
    "signal-invalid-code-same",
    "The raw values that mean invalid or abnormal stay what they are.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
    needs=SPEC_ONLY,
)
