"""Rule node-declared: senders, receivers and bus members are declared nodes."""

from __future__ import annotations

from collections.abc import Iterator
from difflib import get_close_matches

from dbcspec.lint.places import node_names
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.spec.rows import Spec
from typedcan.model.errors import Location
from typedcan.model.protocol import NOWHERE, Protocol

_Mention = tuple[Location, str, str, str]
"""Place, the node named there, by what, and the message that this is or belongs to, if any."""


def _check(subject: Subject) -> Iterator[Found]:
    declared = [node.name for node in subject.protocol.nodes]
    mentions = _in_spec(subject.spec) if subject.spec else _in_model(subject.protocol)
    if not subject.settings.house:
        mentions = _first_mentions(mentions) if declared else iter(())
    for where, node, what, message in mentions:
        if node not in declared:
            close = get_close_matches(node, declared, n=1)
            hint = f" (the closest is {close[0]})" if close else ""
            text = f"{what} names {node}, which is no declared node{hint}: declare or correct it"
            yield Found(where, node, text, message)
    remedy = "give one of its signals a route" if subject.spec else "name the node that sends it"
    for each in subject.protocol.messages if subject.settings.house else ():
        if not each.sender:
            text = f"{each.name} has no sender: {remedy}"
            yield Found(each.where, each.name, text, each.name)


def _first_mentions(mentions: Iterator[_Mention]) -> Iterator[_Mention]:
    """The first mention of each node: a list of nodes lacks it once, however often it is named."""
    seen: set[str] = set()
    for mention in mentions:
        if mention[1] not in seen:
            seen.add(mention[1])
            yield mention


def _in_spec(spec: Spec) -> Iterator[_Mention]:
    names = node_names(spec)
    owners = {field.name: message.name for message, field in spec.fields()}
    for _, row in spec.rows():
        sender, receivers = row.route or ("", ())
        for node in filter(None, (sender, *receivers)):
            yield (
                row.where_is("route"),
                names.get(node, node),
                f"the route of {row.name}",
                owners.get(row.name, ""),
            )
    # Other names are resolved in routes only.
    for bus in spec.standard.buses:
        for node in bus.nodes:
            yield bus.where_is("nodes"), node, f"the bus {bus.name}", ""


def _in_model(protocol: Protocol) -> Iterator[_Mention]:
    for message in protocol.messages:
        if message.sender:
            yield message.where, message.sender, f"the message {message.name}", message.name
    for message, signal in protocol.signals():
        for node in signal.receivers:
            yield signal.where, node, f"the signal {signal.name}", message.name
    for bus in protocol.buses:
        for node in bus.nodes:
            yield NOWHERE, node, f"the bus {bus.name}", ""


RULE = Rule(
    "node-declared",
    "senders, receivers and bus members are declared nodes",
    _check,
    level="warning",
    foreign=True,
)
