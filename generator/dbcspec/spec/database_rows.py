"""The rows of database.yaml: what a database says beside messages, for tools of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from dbcspec.spec.schema import (
    INTEGER,
    NAME,
    TEXT,
    Record,
    key,
    list_of,
    map_of,
    nested,
    one_of,
)

_RELATIONS = ("BU_SG_REL_", "BU_BO_REL_", "BU_EV_REL_")


@dataclass(frozen=True, slots=True, kw_only=True)
class DefinitionRow(Record):
    """An attribute that the database defines."""

    name: str = key(TEXT, "its name", required=True)
    of: str = key(
        one_of("", "BU_", "BO_", "SG_", "EV_", *_RELATIONS),
        "what has it, as DBC files write it; nothing for the database itself",
        default="",
    )
    type: str = key(TEXT, "as DBC files write it, such as INT 0 100", required=True)
    default: str | None = key(TEXT, "its value where none is given; of an enumeration the word")


@dataclass(frozen=True, slots=True, kw_only=True)
class AttributeRow(Record):
    """The value of an attribute: of the database, or of what it names.

    With a node and a message it is what the node has for the message, or for its signal.
    """

    name: str = key(TEXT, "the attribute", required=True)
    value: str = key(TEXT, "its value; of an enumeration the index", required=True)
    node: str = key(NAME, "the node that has it", default="")
    message: str = key(NAME, "the message that has it", default="")
    signal: str = key(NAME, "the signal of the message that has it", default="")
    variable: str = key(NAME, "the environment variable that has it", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class GroupRow(Record):
    """A group of signals of one message."""

    name: str = key(NAME, "its name", required=True)
    message: str = key(NAME, "the message", required=True)
    repetitions: int = key(INTEGER, "how often it is repeated", default=1)
    signals: tuple[str, ...] = key(list_of(NAME), "the signals", required=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class VariableRow(Record):
    """An environment variable."""

    name: str = key(NAME, "its name", required=True)
    kind: int = key(INTEGER, "0 a whole number, 1 any number, 2 text", default=0)
    minimum: str = key(TEXT, "smallest value", default="0")
    maximum: str = key(TEXT, "largest value", default="0")
    unit: str = key(TEXT, "unit", default="")
    initial: str = key(TEXT, "first value", default="0")
    id: int = key(INTEGER, "number", default=0)
    access: str = key(NAME, "the word for who may do what", default="DUMMY_NODE_VECTOR0")
    nodes: tuple[str, ...] = key(list_of(NAME), "the nodes that may", default=())
    size: int | None = key(INTEGER, "bytes, where it is data")
    comment: str = key(TEXT, "what it is", default="")
    codes: Mapping[int, str] = key(map_of(INTEGER, TEXT), "codes: labels", default={})


@dataclass(frozen=True, slots=True, kw_only=True)
class Database(Record):
    """database.yaml: what goes into DBC files for tools that know of it, and into nothing else."""

    version: str = key(TEXT, "the text of VERSION", default="")
    definitions: tuple[DefinitionRow, ...] = key(
        list_of(nested(DefinitionRow)), "attributes", default=()
    )
    attributes: tuple[AttributeRow, ...] = key(
        list_of(nested(AttributeRow)), "values of attributes", default=()
    )
    groups: tuple[GroupRow, ...] = key(list_of(nested(GroupRow)), "signal groups", default=())
    variables: tuple[VariableRow, ...] = key(
        list_of(nested(VariableRow)), "environment variables", default=()
    )
