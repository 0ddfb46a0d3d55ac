"""A value table keeps its name."""

from __future__ import annotations

import re
from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing, SignalPair
from dbcspec.compare.promise import Breaks, Change, Class, Promise, signal_change
from dbcspec.compare.spec_only import both_are_specs
from typedcan.model.protocol import ValueTable

_COUNTED = re.compile(r"_\d+$")


def _check(pairing: Pairing) -> Iterator[Change]:
    seen: set[tuple[str, str]] = set()
    for signal in pairing.signals:
        old, new = signal.old.value_table, signal.new.value_table
        if (
            old is not None
            and new is not None
            and old.name != new.name
            and (old.name, new.name) not in seen
            and _has_same_codes(pairing, old, new)
            and _is_renamed(pairing, signal, old.name, new.name)
        ):
            seen.add((old.name, new.name))
            yield signal_change(signal, "name of value table", old.name, new.name)


def _has_same_codes(pairing: Pairing, old: ValueTable, new: ValueTable) -> bool:
    return len(old.codes) == len(new.codes) and all(
        before.value == after.value and pairing.languages.same_meaning(before, after)
        for before, after in zip(old.codes, new.codes, strict=True)
    )


def _is_renamed(pairing: Pairing, signal: SignalPair, old: str, new: str) -> bool:
    if (old, new) == (signal.old.name, signal.new.name):
        return False  # It only follows the signal.
    if both_are_specs(pairing):
        return True
    # A DBC does not say which of several tables with the same codes a signal has, and codes
    # without a table are called as the first signal that has them.
    old_names, new_names = pairing.table_names
    moved = old in new_names or new in old_names
    derived = any(
        _COUNTED.sub("", name) in names or name in names
        for name, names in zip((old, new), pairing.signal_names, strict=True)
    )
    return not moved and not derived


PROMISE = Promise(
    "value-table-name-same",
    "The codes of a signal are called the same as an enumeration in code.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
)
