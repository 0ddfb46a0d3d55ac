"""What databases say beside messages: attributes of any name, groups, environment variables."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class AttributeDefinition:
    """An attribute that a database defines for its own tools.

    ``of`` is the keyword of what has it, as DBC files write it: "" for the database, ``BU_``,
    ``BO_``, ``SG_``, ``EV_``, or a relation of a node such as ``BU_SG_REL_``. ``type`` is as DBC
    files write it, ``ENUM "No","Yes"``. ``default`` is None where none is given.
    """

    name: str
    of: str
    type: str
    default: str | None = None

    @property
    def is_relation(self) -> bool:
        """Whether nodes have it for a message, a signal or a variable."""
        return self.of.endswith("_REL_")


@dataclass(frozen=True, slots=True)
class Attribute:
    """The value of an attribute, as text without quotes; of an enumeration the index."""

    name: str
    value: str


@dataclass(frozen=True, slots=True)
class Relation:
    """The value of an attribute that a node has for a message, or for a ``signal`` of it."""

    name: str
    node: str
    value: str
    signal: str = ""


@dataclass(frozen=True, slots=True)
class SignalGroup:
    """Signals of one message that belong together."""

    name: str
    repetitions: int
    signals: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class EnvironmentVariable:
    """A variable of a simulation, with what DBC files write of it.

    ``kind`` is 0 for an integer, 1 for a float, 2 for text; ``access`` the word for who may do
    what, ``nodes`` who. ``size`` is in bytes, None where it is not data. Numbers are text, as they
    came.
    """

    name: str
    kind: int = 0
    minimum: str = "0"
    maximum: str = "0"
    unit: str = ""
    initial: str = "0"
    id: int = 0
    access: str = "DUMMY_NODE_VECTOR0"
    nodes: tuple[str, ...] = ()
    size: int | None = None
    comment: str = ""
    codes: tuple[tuple[int, str], ...] = ()
    attributes: tuple[Attribute, ...] = ()
