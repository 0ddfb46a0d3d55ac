"""The model as JSON and back, so that generated packages carry it whole.

Facts that have their default are left out, and value tables stand once: signals name theirs.
Numbers that are not whole are texts, so that no digit is lost. Places in source files are not kept.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Mapping
from decimal import Decimal
from enum import Enum
from typing import Any, get_args, get_origin, get_type_hints

from typedcan.model.errors import ReadError
from typedcan.model.numbers import number
from typedcan.model.protocol import Protocol, ValueTable

FORMAT = 2
"""Of the JSON; a package with another one is to be generated anew."""

Reader = Callable[[Any], Any]
"""Turns what JSON has into a value of the model."""


def to_json(protocol: Protocol) -> str:
    """A protocol as JSON text, a message a line."""
    plain = to_plain(protocol)
    messages = plain.pop("messages", [])
    lines = [_compact(each) for each in messages]
    head = _compact({"format": FORMAT, "digest": protocol.digest, **plain})
    return f'{head[:-1]},"messages":[\n' + ",\n".join(lines) + "\n]}\n"


def to_plain(protocol: Protocol) -> dict[str, Any]:
    """A protocol as dicts, lists, texts and numbers, without its digest."""
    plain: dict[str, Any] = _plain(protocol, {table.name: table for table in protocol.value_tables})
    return plain


def from_plain(plain: Mapping[str, Any], where: str) -> Protocol:
    """The protocol that `to_plain` makes this of; raises `ReadError` where it is none."""
    try:
        protocol: Protocol = _Readers(plain.get("value_tables", ())).of(Protocol)(plain)
    except (ValueError, KeyError, TypeError, AttributeError, ArithmeticError) as error:
        raise ReadError(f"{where}: not the JSON of a protocol: {error!r}") from None
    return protocol


def from_json(text: str, where: str) -> Protocol:
    """The protocol in a JSON text; ``where`` is what errors call it.

    Raises `ReadError`.
    """
    try:
        plain = json.loads(text)
        if plain.pop("format", None) != FORMAT:
            raise ReadError(f"{where}: of another version: run `dbcspec generate` again")
        digest = plain.pop("digest")
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ReadError(f"{where}: not the JSON of a protocol: {error!r}") from None
    protocol = from_plain(plain, where)
    # What it is computed from stands here too: no need to do that at every start.
    protocol.__dict__["digest"] = str(digest)
    return protocol


def _compact(value: object) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))


def _plain(value: Any, tables: Mapping[str, ValueTable]) -> Any:
    """A value of the model as JSON has it."""
    if dataclasses.is_dataclass(value):
        facts: dict[str, Any] = {}
        for part in dataclasses.fields(value):
            fact = getattr(value, part.name)
            if part.name == "where" or fact == part.default:
                continue
            shared = isinstance(fact, ValueTable) and tables.get(fact.name) == fact
            facts[part.name] = fact.name if shared else _plain(fact, tables)
        return facts
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, Decimal):
        return int(value) if value == value.to_integral_value() else number(value)
    if isinstance(value, frozenset):
        return sorted(each.name for each in value)
    return [_plain(each, tables) for each in value] if isinstance(value, tuple) else value


class _Readers:
    """What reads each kind of value, made once for a text."""

    def __init__(self, tables: Any) -> None:
        self._known: dict[Any, Reader] = {
            Decimal: Decimal,
            bool: bool,
            int: int,
            str: str,
        }
        read = self._record(ValueTable)
        shared = {table.name: table for table in map(read, tables)}
        self._known[ValueTable] = lambda plain: shared[plain] if type(plain) is str else read(plain)

    def of(self, hint: Any) -> Reader:
        """What reads values that are annotated so."""
        if hint not in self._known:
            self._known[hint] = self._made(hint)
        return self._known[hint]

    def _made(self, hint: Any) -> Reader:
        inner = [each for each in get_args(hint) if each not in (type(None), Ellipsis)]
        if get_origin(hint) is tuple:
            read = self.of(inner[0])
            return lambda plain: tuple(map(read, plain))
        if get_origin(hint) is frozenset:
            read = self.of(inner[0])
            return lambda plain: frozenset(map(read, plain))
        if inner:  # or None
            return self.of(inner[0])
        if isinstance(hint, type) and issubclass(hint, Enum):
            return lambda plain: hint[plain]
        return self._record(hint)

    def _record(self, kind: type[Any]) -> Reader:
        hints = get_type_hints(kind)
        names = [part.name for part in dataclasses.fields(kind) if part.name != "where"]
        readers = {name: self.of(hints[name]) for name in names}
        return lambda plain: kind(**{name: readers[name](fact) for name, fact in plain.items()})
