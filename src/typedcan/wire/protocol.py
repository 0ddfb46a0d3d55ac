"""A protocol as the runtime knows it: its nodes, messages, transfers and requests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from typedcan.model import protocol as model
from typedcan.model.frozen import quicken
from typedcan.model.transfers.parts import Part, Parts
from typedcan.wire.errors import UnknownMessageError, UnknownNodeError
from typedcan.wire.message import Message, StraightLine


class FieldRef(NamedTuple):
    """A field of a message."""

    message: type[Message]
    field: str


@dataclass(frozen=True, eq=False, repr=False)
class Transfer:
    """A value that takes several frames, with the classes of its messages.

    Parameters
    ----------
    parts
        What the model says of it.
    classes
        By name, the messages that carry it or tell how much there is.
    """

    parts: Parts
    classes: Mapping[str, type[Message]]

    def __repr__(self) -> str:
        return f"<Transfer {self.name}: {self.parts.transfer.kind}>"

    @property
    def name(self) -> str:
        """Its name here."""
        return self.parts.transfer.name

    @property
    def title(self) -> str:
        """Its short English title."""
        return self.parts.transfer.english

    @property
    def messages(self) -> tuple[type[Message], ...]:
        """The messages that carry it, in order."""
        return tuple(self.classes[message.name] for message in self.parts.messages)

    @property
    def items(self) -> tuple[FieldRef, ...]:
        """The fields that hold its parts, in order: of one frame, where frames are numbered."""
        return tuple(filter(None, map(self._ref, self.parts.items)))

    @property
    def count(self) -> int | None:
        """How many parts there are, where that is fixed."""
        return self.parts.transfer.count

    @property
    def count_field(self) -> FieldRef | None:
        """The field that tells how many there are."""
        return self._ref(self.parts.count)

    @property
    def frame_number(self) -> FieldRef | None:
        """The field that numbers the frames."""
        return self._ref(self.parts.number)

    @property
    def group(self) -> FieldRef | None:
        """The field that names the group that a frame belongs to."""
        return self._ref(self.parts.group)

    @property
    def groups_field(self) -> FieldRef | None:
        """The field that tells how many groups there are."""
        return self._ref(self.parts.groups)

    @property
    def length_field(self) -> FieldRef | None:
        """The field that tells how many of the parts count."""
        return self._ref(self.parts.length)

    @property
    def fill(self) -> int | None:
        """Raw value of parts that are not used, None where there is none."""
        return self.parts.transfer.fill

    def _ref(self, part: Part | None) -> FieldRef | None:
        if part is None:
            return None
        return FieldRef(self.classes[part.message.name], part.signal.python_name)


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """A field that asks for messages.

    ``code`` asks, ``withdraw`` takes the request back, ``answers`` are the messages asked for.
    """

    field: FieldRef
    code: int
    withdraw: int | None
    answers: tuple[type[Message], ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Protocol:
    """A protocol with the classes of its messages.

    Parameters
    ----------
    model
        All that is known of it.
    name, digest, nodes
        Of the model: its name, what changes whenever anything of it changes, the names of all
        nodes.
    messages, codecs
        The message classes, and the generated functions of those that have them.
    conditional
        The messages that have a period but are sent only while a condition holds.
    transfers, requests
        By fields of the classes.
    """

    model: model.Protocol
    name: str
    digest: str
    nodes: tuple[str, ...]
    messages: tuple[type[Message], ...]
    codecs: Mapping[type[Message], StraightLine]
    conditional: tuple[type[Message], ...]
    transfers: tuple[Transfer, ...]
    requests: tuple[Request, ...]

    def __repr__(self) -> str:
        count = len(self.messages)
        return f"<Protocol {self.name}: {count} messages, digest {self.digest}>"

    def message(self, name: str) -> type[Message]:
        """The message class of that name; raises `UnknownMessageError`."""
        for message in self.messages:
            if name == message.NAME:
                return message
        known = ", ".join(message.NAME for message in self.messages)
        raise UnknownMessageError(f"there is no message {name!r}; known: {known}")

    def sent_by(self, node: str) -> tuple[type[Message], ...]:
        """The messages that a node sends; raises `UnknownNodeError`."""
        self._check(node)
        return tuple(message for message in self.messages if node in message.MODEL.senders)

    def received_by(self, node: str) -> tuple[type[Message], ...]:
        """The messages meant for a node; raises `UnknownNodeError`."""
        self._check(node)
        return tuple(message for message in self.messages if node in message.RECEIVERS)

    def transfer(self, name: str) -> Transfer:
        """The transfer of that name; raises `LookupError`."""
        for transfer in self.transfers:
            if name == transfer.name:
                return transfer
        known = ", ".join(transfer.name for transfer in self.transfers)
        raise LookupError(f"there is no transfer {name!r}; known: {known}")

    def _check(self, node: str) -> None:
        if node not in self.nodes:
            known = ", ".join(self.nodes)
            raise UnknownNodeError(f"there is no node {node!r}; known: {known}")


def bind(
    protocol: model.Protocol,
    messages: Sequence[type[Message]],
    codecs: Mapping[type[Message], StraightLine],
) -> Protocol:
    """A protocol of the model with its message classes; they are in the model's order."""
    for kind in messages:
        quicken(kind)
    classes = {kind.MODEL.name: kind for kind in messages}
    fields = {
        signal.name: FieldRef(kind, signal.python_name)
        for kind in messages
        for signal in kind.MODEL.signals
    }
    return Protocol(
        model=protocol,
        name=protocol.name,
        digest=protocol.digest,
        nodes=tuple(node.name for node in protocol.nodes),
        messages=tuple(messages),
        codecs=codecs,
        conditional=tuple(
            kind
            for kind in messages
            if kind.PERIOD and kind.MODEL.send_type is model.SendType.IF_ACTIVE
        ),
        transfers=tuple(Transfer(Parts(each, protocol), classes) for each in protocol.transfers),
        requests=tuple(
            Request(
                field=fields[each.signal],
                code=each.code,
                withdraw=each.withdraw,
                answers=tuple(classes[name] for name in each.answers),
            )
            for each in protocol.requests
        ),
    )
