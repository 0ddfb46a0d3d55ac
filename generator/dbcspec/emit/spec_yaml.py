"""YAML as a generated spec writes it: lists of mappings, and scalars that read back the same."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from decimal import Decimal

from typedcan.model.numbers import number

_PLAIN = re.compile(r"[A-Za-z0-9_一-鿿](?:[A-Za-z0-9_./%()一-鿿-]| (?=[^ ]))*")
_UNPRINTED = re.compile("[\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff]")

Pairs = Iterable[tuple[str, object]]
"""Keys and values; None leaves the key out."""


def list_lines(key: str, rows: Iterable[Pairs]) -> Iterator[str]:
    """A key with a list of mappings, nothing where there are none."""
    lines = [f"  - {{{flow_entries(pairs)}}}" for pairs in rows]
    if lines:
        yield f"{key}:"
        yield from lines


def mapping_lines(indent: int, pairs: Pairs) -> Iterator[str]:
    """The entries of a mapping, one a line."""
    for key, value in pairs:
        if value is not None:
            yield f"{' ' * indent}{key}: {_value(value)}"


def flow_entries(pairs: Pairs) -> str:
    """The entries of a mapping in one line, without its braces."""
    return ", ".join(f"{key}: {_value(value)}" for key, value in pairs if value is not None)


def _value(value: object) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, Mapping):
        inner = ", ".join(f"{key}: {scalar(str(label))}" for key, label in value.items())
        return f"{{{inner}}}"
    if isinstance(value, Decimal):
        return number(value)
    return scalar(value) if isinstance(value, str) else str(value)


def scalar(text: str) -> str:
    """A scalar that YAML reads as this very text."""
    if _PLAIN.fullmatch(text):
        return text
    return _UNPRINTED.sub(
        lambda match: f"\\u{ord(match[0]):04x}", json.dumps(text, ensure_ascii=False)
    )
