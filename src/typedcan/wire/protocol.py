"""A protocol as the runtime knows it: its nodes, messages, transfers and requests."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from typedcan.model import protocol as model
from typedcan.wire.errors import UnknownMessageError, UnknownNodeError
from typedcan.wire.message import Message


class FieldRef(NamedTuple):
    """A field of a message."""

    message: type[Message]
    field: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Transfer:
    """A value that takes several frames.

    Parameters
    ----------
    name, title
        Its name here and its short English title.
    messages
        The messages that carry it.
    items
        The fields that hold its parts, in order: those of one frame where there is a
        ``frame_number``, else those of all messages.
    count, count_field
        How many parts there are, or the field that tells.
    frame_number
        The field that numbers the frames from 1.
    group, groups_field
        The field that names the group that a frame belongs to, counted from 1, and the one that
        tells how many groups there are.
    length_field
        The field that tells how many of the parts count.
    numbered_within_group
        Whether the frame numbers begin anew in each group.
    fill
        Raw value of parts that are not used, None where there is none.
    """

    name: str
    title: str
    messages: tuple[type[Message], ...]
    items: tuple[FieldRef, ...]
    count: int | None = None
    count_field: FieldRef | None = None
    frame_number: FieldRef | None = None
    group: FieldRef | None = None
    groups_field: FieldRef | None = None
    length_field: FieldRef | None = None
    numbered_within_group: bool = False
    fill: int | None = None


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
    messages, decoders
        The message classes, and what makes each from its raw values.
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
    decoders: Mapping[type[Message], Callable[[Sequence[int]], Message]]
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
    decoders: Mapping[type[Message], Callable[[Sequence[int]], Message]],
) -> Protocol:
    """A protocol of the model with its message classes; they are in the model's order."""
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
        decoders=decoders,
        conditional=tuple(
            kind
            for kind in messages
            if kind.PERIOD and kind.MODEL.send_type is model.SendType.IF_ACTIVE
        ),
        transfers=tuple(_transfer(each, classes, fields) for each in protocol.transfers),
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


def _transfer(
    transfer: model.Transfer,
    classes: Mapping[str, type[Message]],
    fields: Mapping[str, FieldRef],
) -> Transfer:
    return Transfer(
        name=transfer.name,
        title=transfer.english,
        messages=tuple(classes[name] for name in transfer.messages),
        items=tuple(fields[name] for name in transfer.items),
        count=transfer.count,
        count_field=fields.get(transfer.count_signal),
        frame_number=fields.get(transfer.frame_number),
        group=fields.get(transfer.group),
        groups_field=fields.get(transfer.groups_signal),
        length_field=fields.get(transfer.length_signal),
        numbered_within_group=transfer.numbered_within_group,
        fill=transfer.fill,
    )
