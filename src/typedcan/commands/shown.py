"""Which messages of a trace are printed: by message, node, condition, faults, or what changed."""

from __future__ import annotations

import argparse
import operator
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from typedcan.commands.log_options import names
from typedcan.commands.values import find_field, message_named, value_of
from typedcan.model.signal_state import SignalState
from typedcan.shell.console import CommandError
from typedcan.wire.codec import Codec
from typedcan.wire.fields import FilledField
from typedcan.wire.link import Fault, Received
from typedcan.wire.message import Message

_OPERATORS: Mapping[str, Callable[[Any, Any], bool]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "!=": operator.ne,
    "==": operator.eq,
    "=": operator.eq,
    "<": operator.lt,
    ">": operator.gt,
}
_CONDITION = re.compile(rf"\s*([\w.]+)\s*({'|'.join(_OPERATORS)})\s*(.*?)\s*")
_ORDERING = ("<", ">", "<=", ">=")


@dataclass(frozen=True, slots=True)
class Condition:
    """What a field of some message classes must be."""

    compare: Callable[[Any, Any], bool]
    wanted: Mapping[type[Message], tuple[str, Any]]
    ordering: bool

    def holds(self, message: Message) -> bool:
        """Whether the message has the field, with such a value."""
        found = self.wanted.get(type(message))
        if found is None:
            return False
        name, wanted = found
        value = getattr(message, name)
        if value is None or (self.ordering and isinstance(value, SignalState)):
            return False
        return self.compare(value, wanted)


class Shown:
    """What of a trace is shown; by itself all of it.

    Parameters
    ----------
    messages
        Names of messages; none: all.
    nodes
        Names of nodes: what they send; none: all.
    conditions
        All of them must hold. Messages without the field are not shown.
    faults
        Only what has a fault.
    changes
        Only messages that say something else than the last one of their kind on their channel;
        counters and checksums do not count.
    """

    def __init__(
        self,
        messages: frozenset[str] = frozenset(),
        nodes: frozenset[str] = frozenset(),
        conditions: Sequence[Condition] = (),
        *,
        faults: bool = False,
        changes: bool = False,
    ) -> None:
        self._messages = messages
        self._nodes = nodes
        self._conditions = conditions
        self._faults = faults
        self._changes = changes
        self._last: dict[object, tuple[object, ...]] = {}

    def has(self, taken: Received[Message] | Fault) -> bool:
        """Whether this one is shown."""
        if isinstance(taken, Fault):
            return self._has_fault(taken)
        kind = type(taken.message)
        if self._messages and kind.NAME not in self._messages:
            return False
        if self._nodes and not self._nodes & set(kind.MODEL.senders):
            return False
        if self._faults and not taken.faults:
            return False
        if not all(condition.holds(taken.message) for condition in self._conditions):
            return False
        return not self._changes or self._is_news(taken)

    def _has_fault(self, fault: Fault) -> bool:
        if self._conditions or (self._messages and fault.message not in self._messages):
            return False
        return not self._nodes

    def _is_news(self, taken: Received[Message]) -> bool:
        message = taken.message
        now = tuple(
            getattr(message, field.name)
            for field in message.FIELDS.values()
            if not isinstance(field, FilledField)
        )
        key = (taken.frame.channel, taken.frame.arbitration_id, taken.frame.is_extended_id)
        before, self._last[key] = self._last.get(key), now
        return before != now


def add_filters(parser: argparse.ArgumentParser) -> None:
    """Declare --messages, --nodes, --where, --faults and --changes."""
    group = parser.add_argument_group("what is shown; everything is counted")
    for name, metavar, text in (
        ("--messages", "NAME,...", "these messages only"),
        ("--nodes", "NODE,...", "what these nodes send"),
    ):
        group.add_argument(
            name, type=names, action="extend", default=[], metavar=metavar, help=text
        )
    group.add_argument(
        "--where",
        action="append",
        default=[],
        metavar="CONDITION",
        help="such as 'soc<20', 'Status.mode=On' or 'soc=invalid'; all given must hold",
    )
    group.add_argument("--faults", action="store_true", help="only what has a fault")
    group.add_argument(
        "--changes", action="store_true", help="only what says something else than before"
    )


def shown_of(options: argparse.Namespace, codec: Codec) -> Shown:
    """What the options ask for; raises `CommandError` for names and values that there are not."""
    kinds = codec.protocol.messages
    messages = frozenset(message_named(kinds, name).NAME for name in options.messages)
    senders = {node for kind in kinds for node in kind.MODEL.senders}
    spelt = {node.casefold(): node for node in senders}
    for name in options.nodes:
        if name.casefold() not in spelt:
            known = ", ".join(sorted(senders)) or "none"
            raise CommandError(f"there is no node {name!r} that sends; known: {known}")
    return Shown(
        messages,
        frozenset(spelt[name.casefold()] for name in options.nodes),
        [condition_of(text, kinds) for text in options.where],
        faults=options.faults,
        changes=options.changes,
    )


def condition_of(text: str, kinds: Sequence[type[Message]]) -> Condition:
    """The condition in a text such as ``soc<20``; raises `CommandError`."""
    match = _CONDITION.fullmatch(text)
    if not match or not match[3]:
        raise CommandError(f"expected a condition such as soc<20 or bms=1, not {text!r}")
    name, sign, value = match.groups()
    message, dot, field_name = name.rpartition(".")
    if dot:
        kinds = [message_named(kinds, message)]
    wanted: dict[type[Message], tuple[str, Any]] = {}
    problem: CommandError | None = None
    for kind in kinds:
        field = find_field(kind, field_name)
        if field is None:
            continue
        try:
            wanted[kind] = field.name, value_of(kind, field, value)
        except CommandError as error:
            problem = error
    if not wanted:
        raise problem or CommandError(f"no message has a field {field_name!r}")
    return Condition(_OPERATORS[sign], wanted, sign in _ORDERING)
