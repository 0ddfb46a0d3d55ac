"""Values as text that depends on nothing but the value: what digests are made of."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from decimal import Decimal
from enum import Enum

from typedcan.model.numbers import number


def canonical(value: object) -> str:
    """A model or a part of it as text, without what does not count in comparisons."""
    if is_dataclass(value):
        inner = ",".join(
            f"{part.name}={canonical(getattr(value, part.name))}"
            for part in fields(value)
            if part.compare
        )
        return f"{type(value).__name__}({inner})"
    if isinstance(value, tuple):
        return f"({','.join(map(canonical, value))})"
    if isinstance(value, Decimal):
        return number(value)
    return repr(value.name) if isinstance(value, Enum) else repr(value)
