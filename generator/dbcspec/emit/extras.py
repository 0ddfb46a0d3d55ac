"""What a protocol carries beside messages as lines of a DBC file: attributes, groups, variables."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from typedcan.model.extras import Attribute, AttributeDefinition, EnvironmentVariable
from typedcan.model.protocol import Message, Protocol

NOBODY = "Vector__XXX"
"""Who sends or receives what nobody is named for."""

_EXTENDED = 0x8000_0000
_QUOTED_TYPES = ("STRING", "ENUM")


def dbc_id(message: Message) -> int:
    """The identifier as BO_ has it: bit 31 marks an extended frame."""
    return message.frame_id | _EXTENDED if message.extended else message.frame_id


def quote(text: str) -> str:
    """A text as DBC files write it."""
    # A backslash before the closing quote would quote the quote.
    text = f"{text} " if text.endswith("\\") else text
    return '"' + text.replace('"', '\\"') + '"'


def quoted_codes(codes: Iterable[tuple[int, str]]) -> str:
    """Codes and their labels as VAL_ has them."""
    return " ".join(f"{value} {quote(label)}" for value, label in codes)


class ExtraLines:
    """The lines of what `typedcan.model.extras` has; ``types`` of attributes defined elsewhere."""

    def __init__(self, protocol: Protocol, types: Mapping[str, str]) -> None:
        self._protocol = protocol
        own = {each.name: each.type for each in protocol.definitions}
        self._types = {**types, **own}
        self.defined = frozenset(own)
        """Attributes whose definition and values are the protocol's own."""
        self.of_database = frozenset(each.name for each in protocol.attributes)
        """Attributes that the database itself has a value of."""

    def tells(self, message: Message, name: str) -> bool:
        """Whether an attribute of a message is among the protocol's own."""
        return name in self.defined or any(each.name == name for each in message.attributes)

    def variables(self) -> Iterator[str]:
        """The environment variables."""
        for each in self._protocol.variables:
            nodes = ",".join(each.nodes) or NOBODY
            limits = f"[{each.minimum}|{each.maximum}] {quote(each.unit)}"
            who = f"{each.initial} {each.id} {each.access} {nodes}"
            yield f"EV_ {each.name}: {each.kind} {limits} {who};"
        for each in self._protocol.variables:
            if each.size is not None:
                yield f"ENVVAR_DATA_ {each.name}: {each.size};"

    def comments(self) -> Iterator[str]:
        """The comments of the environment variables."""
        for each in self._protocol.variables:
            if each.comment:
                yield f"CM_ EV_ {each.name} {quote(each.comment)};"

    def definitions(self) -> Iterator[str]:
        """The definitions of attributes that nodes have for something."""
        for each in self._relations():
            yield f'BA_DEF_REL_ {each.of} "{each.name}" {each.type} ;'

    def defaults(self) -> Iterator[str]:
        """What these attributes are where no value is given."""
        for each in self._relations():
            if each.default is not None:
                yield f'BA_DEF_DEF_REL_ "{each.name}" {default_of(each)};'

    def values(self) -> Iterator[str]:
        """The values of attributes, of whatever has them."""
        for of, attributes in self._owners():
            for each in attributes:
                yield f'BA_ "{each.name}" {of}{self._value(each.name, each.value)};'
        for message in self._protocol.messages:
            number = dbc_id(message)
            for told in message.relations:
                value = self._value(told.name, told.value)
                signal = f"BU_SG_REL_ {told.node} SG_ {number} {told.signal}"
                of = signal if told.signal else f"BU_BO_REL_ {told.node} {number}"
                yield f'BA_REL_ "{told.name}" {of} {value};'

    def codes(self) -> Iterator[str]:
        """The codes of the environment variables."""
        for each in self._protocol.variables:
            if each.codes:
                yield f"VAL_ {each.name} {quoted_codes(each.codes)} ;"

    def groups(self) -> Iterator[str]:
        """The signal groups."""
        for message in self._protocol.messages:
            for group in message.groups:
                names = " ".join(group.signals)
                head = f"SIG_GROUP_ {dbc_id(message)} {group.name} {group.repetitions}"
                yield f"{head} : {names};"

    def _relations(self) -> Iterator[AttributeDefinition]:
        return (each for each in self._protocol.definitions if each.is_relation)

    def _owners(self) -> Iterator[tuple[str, tuple[Attribute, ...]]]:
        yield "", self._protocol.attributes
        for node in self._protocol.nodes:
            yield f"BU_ {node.name} ", node.attributes
        for message in self._protocol.messages:
            yield f"BO_ {dbc_id(message)} ", message.attributes
            for signal in message.signals:
                yield f"SG_ {dbc_id(message)} {signal.name} ", signal.attributes
        for variable in self._protocol.variables:
            yield f"EV_ {variable.name} ", variable.attributes

    def _value(self, name: str, value: str) -> str:
        return quote(value) if self._types.get(name, "").startswith("STRING") else value


def default_of(definition: AttributeDefinition) -> str:
    """The default as DBC files write it."""
    default = definition.default or ""
    return quote(default) if definition.type.startswith(_QUOTED_TYPES) else default


def renamed_variable(
    variable: EnvironmentVariable, nodes: Mapping[str, str]
) -> EnvironmentVariable:
    """The variable with other names of nodes."""
    return replace(variable, nodes=tuple(nodes.get(name, name) for name in variable.nodes))


def renamed_extras(
    message: Message, signals: Mapping[str, str], nodes: Mapping[str, str]
) -> Message:
    """The message whose groups and relations have other names of signals and nodes."""
    return replace(
        message,
        groups=tuple(
            replace(each, signals=tuple(signals.get(name, name) for name in each.signals))
            for each in message.groups
        ),
        relations=tuple(
            replace(
                each,
                node=nodes.get(each.node, each.node),
                signal=signals.get(each.signal, each.signal),
            )
            for each in message.relations
        ),
    )
