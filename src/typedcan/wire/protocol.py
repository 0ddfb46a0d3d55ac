"""A protocol as the runtime knows it: its nodes, messages, transfers and requests."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Protocol:
    """What `dbcspec generate` writes of a protocol beside its messages.

    Parameters
    ----------
    name, digest
        Of the protocol and its resolved model; the DBC in ``package`` has the same.
    nodes
        The names of all nodes.
    messages, decoders
        The message classes, and what makes each from its raw values.
    conditional
        The messages that have a period but are sent only while a condition holds.
    """

    name: str
    digest: str
    package: str
    nodes: tuple[str, ...]
    messages: tuple[type[Message], ...]
    decoders: Mapping[type[Message], Callable[[Sequence[int]], Message]]
    conditional: tuple[type[Message], ...]
    transfers: tuple[Transfer, ...]
    requests: tuple[Request, ...]

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
        return tuple(message for message in self.messages if node == message.SENDER)

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
