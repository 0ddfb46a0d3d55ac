"""What cantools has read beside messages to the model: attributes, groups, variables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from cantools.database.can import Database
from cantools.database.can import Message as CantoolsMessage

from typedcan.model.extras import (
    Attribute,
    AttributeDefinition,
    EnvironmentVariable,
    Relation,
    SignalGroup,
)

_TOLD = frozenset(
    {
        *("Baudrate", "DBName", "SpecDigest", "SpecReference", "SpecErrata", "NmStationAddress"),
        *("GenMsgCycleTime", "VFrameFormat", "CANFD_BRS", "GenSigStartValue"),
        *("SystemNodeLongSymbol", "SystemMessageLongSymbol", "SystemSignalLongSymbol"),
    }
)
"""Attributes that the rest of the model tells whole."""

_UNUSED = ("NotUsed",) * 6
_USUAL = {
    "BusType": AttributeDefinition("BusType", "", "STRING", "CAN"),
    "GenMsgILSupport": AttributeDefinition("GenMsgILSupport", "BO_", 'ENUM "No","Yes"', "Yes"),
    "GenMsgSendType": AttributeDefinition(
        "GenMsgSendType",
        "BO_",
        "ENUM "
        + ",".join(f'"{word}"' for word in ("Cyclic", *_UNUSED, "IfActive", "NoMsgSendType")),
        "NoMsgSendType",
    ),
}
"""Attributes that the rest of the model tells too, where they are defined so."""

_USUAL_VALUES = {
    "BusType": {"CAN", "CAN FD"},
    "GenMsgILSupport": {"1"},
    "GenMsgSendType": {"0", "7", "8"},
}


class Extras:
    """What a database says beside messages; of a format without attributes, nothing."""

    def __init__(self, database: Database) -> None:
        self._dbc = database.dbc
        definitions = self._dbc.attribute_definitions if self._dbc else {}
        relations = self._dbc.relation_attribute_definitions if self._dbc else {}
        every = [_definition(each) for each in (*definitions.values(), *relations.values())]
        self._usual = {each.name for each in every if each == _USUAL.get(each.name)}
        self.definitions = tuple(
            each for each in every if each.name not in _TOLD and each.name not in self._usual
        )
        """Of all attributes that the rest of the model does not tell."""

    def attributes(self, found: Mapping[str, Any]) -> tuple[Attribute, ...]:
        """The values of one object, as cantools has them, that the model does not tell."""
        values = (Attribute(name, str(each.value)) for name, each in found.items())
        return tuple(each for each in values if each.name not in _TOLD and not self._is_usual(each))

    def _is_usual(self, value: Attribute) -> bool:
        return value.name in self._usual and value.value in _USUAL_VALUES[value.name]

    def of_database(self) -> tuple[Attribute, ...]:
        """The values that the database itself has."""
        return self.attributes(self._dbc.attributes) if self._dbc else ()

    def variables(self) -> Iterator[EnvironmentVariable]:
        """The environment variables, without their codes."""
        for each in self._dbc.environment_variables.values() if self._dbc else ():
            yield EnvironmentVariable(
                name=each.name,
                kind=each.env_type,
                minimum=str(each.minimum),
                maximum=str(each.maximum),
                unit=each.unit,
                initial=str(each.initial_value),
                id=each.env_id,
                access=each.access_type,
                nodes=tuple(each.access_nodes),
                size=each.data_size,
                comment=each.comment or "",
                attributes=self.attributes(each.dbc.attributes),
            )

    def relations(self, message: CantoolsMessage) -> Iterator[Relation]:
        """The values that nodes have for a message and for its signals."""
        found = self._dbc.relation_attributes if self._dbc else None
        if found is None:
            return
        number = message.frame_id | (1 << 31 if message.is_extended_frame else 0)
        for node, attributes in found.node_message_relations.get(number, {}).items():
            for name, each in attributes.items():
                yield Relation(name, node, str(each.value))
        for signal, nodes in found.node_signal_relations.get(number, {}).items():
            for node, attributes in nodes.items():
                for name, each in attributes.items():
                    yield Relation(name, node, str(each.value), signal)


def groups_of(message: CantoolsMessage) -> tuple[SignalGroup, ...]:
    """The signal groups of a message."""
    return tuple(
        SignalGroup(each.name, each.repetitions, tuple(each.signal_names))
        for each in message.signal_groups or ()
    )


def _definition(found: Any) -> AttributeDefinition:
    limits = (found.minimum, found.maximum)
    words = ",".join(f'"{word}"' for word in found.choices or ())
    numbers = " ".join(str(each) for each in limits if each is not None)
    return AttributeDefinition(
        name=found.name,
        of=found.kind or "",
        type=f"{found.type_name} {words or numbers}".strip(),
        default=None if found.default_value is None else str(found.default_value),
    )
