"""What two spellings of one protocol differ in everywhere, as one finding instead of hundreds."""

from __future__ import annotations

from collections.abc import Iterable

from typedcan.model.protocol import NOWHERE
from typedcan.report.item import Item

_FEWEST = 3
"""Findings alike that are summed up."""

_NAMED = 3
"""Members that the text of a sum names; ``members`` has all."""

_RENAMES = {
    "signal-name-same": "signals are called otherwise",
    "message-name-same": "messages are called otherwise",
}
_SAME_CHANGE = {
    "signal-receivers-same": "receivers",
    "signal-unit-same": "unit",
    "signal-start-value-same": "start value",
    "signal-range-not-narrowed": "range",
    "signal-range-not-widened": "range",
    "message-sender-same": "sender",
    "message-send-type-same": "send type",
}
_ALL_ALIKE = {
    "attribute-same": "attributes of other tools differ",
    "attribute-definition-same": "definitions of attributes differ",
    "comment-same": "comments differ",
    "reserved-signal-present": "fields that are called reserved are gone",
}


def summed(items: Iterable[Item]) -> list[Item]:
    """The items, where those that are alike became one, at the place of the first.

    Names, comments and reserved fields are one sum each; receivers, units, start values, ranges
    and senders are summed up where both the old and the new value are the same.
    """
    groups: dict[tuple[str, ...], list[Item]] = {}
    for item in items:
        groups.setdefault(_key(item), []).append(item)
    found: list[Item] = []
    for alike in groups.values():
        summing = len(alike) >= _FEWEST and alike[0].rule in _TEXTS
        found += [_sum(alike)] if summing else alike
    return found


_TEXTS = {**_RENAMES, **_SAME_CHANGE, **_ALL_ALIKE}


def _key(item: Item) -> tuple[str, ...]:
    if item.rule in _SAME_CHANGE:
        return item.rule, item.old, item.new
    if item.rule in _TEXTS:
        return (item.rule,)
    return item.rule, item.group, item.subject, item.text


def _sum(items: list[Item]) -> Item:
    first = items[0]
    members = tuple(map(_member, items))
    more = f" and {len(items) - _NAMED} more" if len(items) > _NAMED else ""
    named = f"{', '.join(members[:_NAMED])}{more}"
    if first.rule in _SAME_CHANGE:
        text = f"{_SAME_CHANGE[first.rule]} {first.old or 'none'} → {first.new or 'none'}: {named}"
    else:
        text = f"{_TEXTS[first.rule]}: {named}"
    old, new = (first.old, first.new) if first.rule in _SAME_CHANGE else ("", "")
    return Item(
        rule=first.rule,
        level=first.level,
        group="",
        subject=f"{len(items)} of them",
        text=text,
        where=first.where or NOWHERE,
        breaks=first.breaks,
        old=old,
        new=new,
        members=members,
    )


def _member(item: Item) -> str:
    within = f"{item.group}." if item.group and item.group != item.subject else ""
    if item.rule in _RENAMES:
        return f"{within}{item.old} → {item.new}"
    if item.rule.startswith("attribute-"):
        return f"{within}{item.subject}: {item.text}"
    return f"{within}{item.subject}"
