"""Bytes and lists as text, for formats that hold neither."""

from __future__ import annotations

import json
from typing import Any

import pyarrow as pa


def is_plain(kind: pa.DataType) -> bool:
    """Whether values of a type need no text in their place."""
    return not (pa.types.is_binary(kind) or pa.types.is_list(kind))


def text_array(array: Any) -> pa.Array[Any]:
    """Bytes in hexadecimal, and lists as JSON has them."""
    texts = [None if value is None else _text(value) for value in array.to_pylist()]
    return pa.array(texts, pa.string())


def _text(value: bytes | list[float | None]) -> str:
    return value.hex() if isinstance(value, bytes) else json.dumps(value)
