"""Located nodes to typed records: what a key may hold, said once for reader and JSON Schema."""

from __future__ import annotations

import dataclasses
import difflib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from enum import Enum
from typing import Any, ClassVar, Self, TypeVar, cast

from dbcspec.errors import Fault, SpecError
from dbcspec.spec.source import Items, Node, Scalar, Table
from typedcan.model.errors import Location

_METADATA = "dbcspec"


@dataclass(frozen=True, slots=True)
class Kind:
    """What a value may be: how it is read and how JSON Schema says it."""

    name: str
    read: Callable[[Node], Any]
    schema: Mapping[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Record:
    """A mapping of the spec as a typed value.

    ``where`` is its place, ``places`` that of each key, ``marks`` the numbers of the errata that
    changed or confirmed it. ``IDENTITY`` names the field that errata address it by,
    ``MAIN`` the list that an address falls through to.
    """

    IDENTITY: ClassVar[str] = "name"
    MAIN: ClassVar[str] = ""

    where: Location = field(compare=False)
    places: Mapping[str, Location] = field(compare=False, default_factory=dict[str, Location])
    marks: tuple[str, ...] = ()

    @property
    def identity(self) -> str:
        """The text by which errata address this record."""
        return str(getattr(self, self.IDENTITY, ""))

    def where_is(self, key: str) -> Location:
        """Where the value of ``key`` stands, or the record itself where it is absent."""
        return self.places.get(key, self.where)

    @classmethod
    def read(cls, node: Node) -> Self:
        """Build the record from a node; raises `SpecError` with every fault in it."""
        return _read_record(cls, node)


RecordT = TypeVar("RecordT", bound=Record)


@dataclass(frozen=True, slots=True)
class Key:
    """One key of a record: its kind, its meaning, and whether it must be there."""

    kind: Kind
    help: str
    required: bool


def key(kind: Kind, help: str, *, required: bool = False, default: Any = None) -> Any:
    """Declare a key of a record, as ``dataclasses.field`` does a field."""
    spec = Key(kind, help, required)
    if required:
        return field(metadata={_METADATA: spec})
    if isinstance(default, dict):
        return field(default_factory=dict[Any, Any], metadata={_METADATA: spec})
    return field(default=default, metadata={_METADATA: spec})


def keys_of(record: type[Record]) -> dict[str, Key]:
    """The keys of a record class, by name, in order."""
    return {
        spec_field.name: spec_field.metadata[_METADATA]
        for spec_field in dataclasses.fields(record)
        if _METADATA in spec_field.metadata
    }


def _read_record(record: type[RecordT], node: Node) -> RecordT:
    table = expect_table(node)
    keys = keys_of(record)
    faults: list[Fault] = []
    values: dict[str, Any] = {}
    places: dict[str, Location] = {}
    for name, value in table.entries:
        if name.text not in keys:
            faults.append(Fault(name.where, f"unknown key {name.text!r}{_hint(name.text, keys)}"))
            continue
        places[name.text] = value.where
        try:
            values[name.text] = keys[name.text].kind.read(value)
        except SpecError as error:
            faults.extend(error.faults)
    given = {name.text for name, _ in table.entries}
    faults.extend(
        Fault(table.where, f"key {name!r} is missing")
        for name, spec in keys.items()
        if spec.required and name not in given
    )
    if faults:
        raise SpecError(faults)
    return record(where=table.where, places=places, **values)


def _hint(word: str, keys: Mapping[str, Key]) -> str:
    close = difflib.get_close_matches(word, keys, n=1)
    return f"; did you mean {close[0]!r}?" if close else f"; known: {', '.join(keys)}"


def expect_table(node: Node) -> Table:
    """The node as a mapping, or a `SpecError` that names its place."""
    if not isinstance(node, Table):
        raise SpecError.at(node.where, "expected a mapping (key: value)")
    return node


def expect_text(node: Node) -> str:
    """The node as text, or a `SpecError` that names its place."""
    if not isinstance(node, Scalar):
        raise SpecError.at(node.where, "expected a single value, not a list or mapping")
    return node.text


def pattern(name: str, expression: str, convert: Callable[[str], Any]) -> Kind:
    """A value whose text a regular expression matches whole."""
    compiled = re.compile(expression)

    def read(node: Node) -> Any:
        text = expect_text(node)
        if not compiled.fullmatch(text):
            raise SpecError.at(node.where, f"expected {name}, not {text!r}")
        return convert(text)

    return Kind(name, read, {"type": ["string", "number"], "pattern": f"^(?:{expression})$"})


def _whole_number(text: str) -> int:
    return int(text, 0) if text[1:2] in ("x", "X") else int(text)


_NUMBER = r"-?\d{1,400}(?:\.\d{1,400})?"

TEXT = Kind("text", expect_text, {"type": ["string", "number", "boolean", "null"]})
INTEGER = pattern("a whole number", r"-?\d{1,20}|0[xX][0-9A-Fa-f]{1,8}", _whole_number)
DECIMAL = pattern("a plain decimal number", _NUMBER, Decimal)
NAME = pattern("a name (letters, digits, underscore)", r"[A-Za-z_][A-Za-z0-9_]*", str)
SIGNAL = pattern(
    "a signal, or message.signal", r"[A-Za-z_][A-Za-z0-9_]*(?:\.[A-Za-z_][A-Za-z0-9_]*)?", str
)
RANGE = pattern(
    "a range such as 0~255",
    rf"{_NUMBER}~{_NUMBER}",
    lambda text: tuple(Decimal(part) for part in text.split("~")),
)


def _split_route(text: str) -> tuple[str, tuple[str, ...]]:
    """Sender and receivers; ``-`` stands for nobody."""
    sender, receivers = text.split(">")
    return sender.strip("-"), tuple(name for name in receivers.split(",") if name != "-")


ROUTE = pattern(
    "a route such as ECU1>ECU2, with - for nobody",
    r"(?:[A-Za-z0-9_]+|-)>(?:[A-Za-z0-9_]+(?:,[A-Za-z0-9_]+)*|-)",
    _split_route,
)


def whole_number(low: int, high: int) -> Kind:
    """A whole number from low to high."""

    def read(node: Node) -> int:
        value: int = INTEGER.read(node)
        if not low <= value <= high:
            raise SpecError.at(node.where, f"{value} is out of range; allowed are {low} to {high}")
        return value

    schema = {"type": "integer", "minimum": low, "maximum": high}
    return Kind(f"a whole number from {low} to {high}", read, schema)


def one_of(*words: str) -> Kind:
    """A value that is one of a few words."""

    def read(node: Node) -> str:
        text = expect_text(node)
        if text not in words:
            raise SpecError.at(node.where, f"expected one of {', '.join(words)}, not {text!r}")
        return text

    return Kind(f"one of {', '.join(words)}", read, {"enum": list(words)})


def word_of(words: type[Enum]) -> Kind:
    """A value that is one of a few words, read as the member that has it."""
    kind = one_of(*(member.value for member in words))
    return Kind(kind.name, lambda node: words(kind.read(node)), kind.schema)


def list_of(kind: Kind) -> Kind:
    """A list; every faulty item is reported."""

    def read(node: Node) -> tuple[Any, ...]:
        if not isinstance(node, Items):
            raise SpecError.at(node.where, "expected a list")
        values: list[Any] = []
        faults: list[Fault] = []
        for item in node.nodes:
            try:
                values.append(kind.read(item))
            except SpecError as error:
                faults.extend(error.faults)
        if faults:
            raise SpecError(faults)
        return tuple(values)

    return Kind(f"a list of {kind.name}", read, {"type": "array", "items": kind.schema})


def map_of(key_kind: Kind, value_kind: Kind) -> Kind:
    """A mapping from scalar keys to values; becomes a dict in the order of the file."""

    def read(node: Node) -> dict[Any, Any]:
        pairs: dict[Any, Any] = {}
        faults: list[Fault] = []
        for name, value in expect_table(node).entries:
            try:
                key_value = key_kind.read(name)
                if key_value in pairs:
                    faults.append(Fault(name.where, f"key {name.text} stands here twice"))
                pairs[key_value] = value_kind.read(value)
            except SpecError as error:
                faults.extend(error.faults)
        if faults:
            raise SpecError(faults)
        return pairs

    schema = {"type": "object", "additionalProperties": value_kind.schema}
    return Kind(f"a mapping to {value_kind.name}", read, schema)


def nested(record: type[Record]) -> Kind:
    """A value that is itself a record."""
    return Kind(record.__name__, record.read, json_schema(record))


def raw() -> Kind:
    """A value that is kept as nodes and read later, when its target is known."""
    return Kind("anything", lambda node: cast("object", node), {})


def json_schema(record: type[Record]) -> dict[str, Any]:
    """The JSON Schema of a record class, for editors."""
    keys = keys_of(record)
    schema: dict[str, Any] = {
        "type": "object",
        "additionalProperties": False,
        "properties": {
            name: {"description": spec.help, **spec.kind.schema} for name, spec in keys.items()
        },
    }
    required = [name for name, spec in keys.items() if spec.required]
    return schema | ({"required": required} if required else {})
