"""Values as text that depends on nothing but the value: what digests are made of."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from decimal import Decimal
from enum import Enum

from typedcan.model.numbers import number


def canonical(value: object) -> str:
    """A model or a part of it as text, without what does not count in comparisons.

    Facts that have their default are left out: a kind of fact that a later version knows besides
    changes no text, and no digest, of a protocol that has none of it.
    """
    if is_dataclass(value):
        inner = ",".join(
            f"{part.name}={canonical(fact)}"
            for part in fields(value)
            if part.compare and (fact := getattr(value, part.name)) != part.default
        )
        return f"{type(value).__name__}({inner})"
    if isinstance(value, tuple):
        return f"({','.join(map(canonical, value))})"
    if isinstance(value, Decimal):
        return number(value)
    return repr(value.name) if isinstance(value, Enum) else repr(value)
