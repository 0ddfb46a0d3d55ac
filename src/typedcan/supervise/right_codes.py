"""Which raw values surely say that nothing is wrong: told without decoding them."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

from typedcan.wire.fields import CharacterField, Field, LabelledField, Value

_FEW_BITS = 8
"""The longest signal whose raw values are looked at one by one."""

MOST_BITS = 64
"""The longest whose limits are reckoned with; longer ones are judged each time."""


def right_codes(field: Field, judge: Callable[[Value], object | None]) -> range:
    """Raw values in a row where nothing is wrong; what is beyond needs judging.

    They are the lowest such values, as those of states and errors are high by custom. ``judge``
    gives None for a value where nothing is wrong. Of signed signals they are the bits of values
    that are not negative; the bits of floats are no raw values at all.
    """
    if field.signal.is_float or field.length > MOST_BITS:
        return range(0)
    first, last = 0, field.signal.raw_limits[1]
    if field.length <= _FEW_BITS:
        wrong = [raw for raw in range(last + 1) if judge(_value(field, raw)) is not None]
    elif isinstance(field, LabelledField | CharacterField):
        return range(0)
    else:
        # A measured value: right within its range, but for its states.
        ends = [
            round((end - field.offset) / field.factor) for end in (field.minimum, field.maximum)
        ]
        first, last = max(min(ends), first), min(max(ends), last)
        wrong = sorted(raw for raw in field.states if first <= raw <= last)
    borders = pairwise([first - 1, *wrong, last + 1])
    stretches = (range(before + 1, behind) for before, behind in borders)
    return next(filter(None, stretches), range(0))


def _value(field: Field, raw: int) -> Value:
    """What a raw value is decoded to."""
    if isinstance(field, LabelledField):
        return raw
    if raw in field.states:
        return field.states[raw]
    if isinstance(field, CharacterField):
        return field.labels.get(raw, raw)
    return raw * field.factor + field.offset
