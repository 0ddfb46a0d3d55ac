"""How a supplier's signal is scaled otherwise, and how far it goes."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.spec.rows import SignalRow
from typedcan.model.numbers import number
from typedcan.model.protocol import Signal


def scale_keys(ours: Signal, theirs: Signal) -> Iterator[tuple[str, str, str]]:
    """Keys of a row that differ, with both values as YAML."""
    for name in ("factor", "offset"):
        old, new = getattr(ours, name), getattr(theirs, name)
        if old != new and (new or name == "offset"):
            yield name, number(old), number(new)
    same_scale = (ours.factor, ours.offset) == (theirs.factor, theirs.offset)
    low, high = theirs.raw_range
    least, most = theirs.raw_limits
    says_nothing = same_scale and (low, high) == (least, most)
    only_codes = ours.value_table is not None and ours.length < 8 and same_scale
    sound = least <= low < high <= most
    if sound and not says_nothing and not only_codes and ours.raw_range != theirs.raw_range:
        old, new = (f"{number(each.minimum)}~{number(each.maximum)}" for each in (ours, theirs))
        yield "range", old, new


def has_otherwise(row: SignalRow, name: str, _: str, new: str) -> bool:
    """Whether a row prints something else for a key."""
    value = getattr(row, name)
    if value is None or name not in row.places:
        return value is not None
    return ("~".join(map(number, value)) if name == "range" else number(value)) != new
