"""Compares two protocols: every broken promise as an item of a report."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from dbcspec.compare.advice import advice_on
from dbcspec.compare.pairing import Pairing, pair
from dbcspec.compare.promise import Change, Promise
from dbcspec.compare.registry import PROMISES
from dbcspec.compare.sums import summed
from typedcan.model.protocol import Protocol
from typedcan.report.item import LEVELS, Item, RuleInfo

RULES: tuple[RuleInfo, ...] = tuple(
    RuleInfo(promise.id, promise.purpose, promise.class_.word, *advice_on(promise.id))
    for promise in PROMISES
)
"""The promises as reports describe them."""

_Place = tuple[float, float]


def compare(old: Protocol, new: Protocol, promises: Iterable[Promise] = PROMISES) -> list[Item]:
    """Every promise that ``new`` breaks; see `findings`."""
    return findings(pair(old, new), promises)


def findings(pairing: Pairing, promises: Iterable[Promise] = PROMISES) -> list[Item]:
    """Every broken promise, in the order of the new protocol's messages and their signals.

    Of protocols matched by place, what differs everywhere is summed up. What belongs to no message
    comes first, what is gone stands where it was; of one signal the gravest comes first. What only
    one side can say at all (`Protocol.carries`) is no difference.
    """
    found = [(promise, change) for promise in promises for change in promise.changes(pairing)]
    places = _places(pairing, {change.message for _, change in found})
    found.sort(key=lambda entry: (*_place(places, entry[1]), -entry[0].class_))
    items = [_item(promise, change) for promise, change in found]
    return summed(items) if pairing.by_place else items


def worst(items: Iterable[Item]) -> str | None:
    """The gravest level among items, None where there are none."""
    levels = {item.level for item in items}
    return next((level for level in LEVELS if level in levels), None)


def _item(promise: Promise, change: Change) -> Item:
    return Item(
        rule=promise.id,
        level=promise.class_.word,
        group=change.message,
        subject=change.subject,
        text=change.text,
        where=change.where,
        breaks=promise.breaks.value,
        old=change.old,
        new=change.new,
    )


def _place(places: Mapping[tuple[str, str], _Place], change: Change) -> _Place:
    return places.get((change.message, change.subject), (-1, -1))


def _places(pairing: Pairing, messages: set[str]) -> dict[tuple[str, str], _Place]:
    """Where the named messages and their signals come in a report."""
    index = {message.name: float(i) for i, message in enumerate(pairing.new.messages)}
    places: dict[tuple[str, str], _Place] = {}
    for both in pairing.messages:
        name = both.new.name
        if name in messages:
            places[name, name] = index[name], -1
            for position, signal in enumerate(both.old.signals):
                places[name, signal.name] = index[name], position - 0.5
            for position, signal in enumerate(both.new.signals):
                places[name, signal.name] = index[name], position
    for message in pairing.added:
        places[message.name, message.name] = index[message.name], -1
    continued = {id(both.old): index[both.new.name] for both in pairing.messages}
    last = -1.0
    for message in pairing.old.messages:
        last = continued.get(id(message), last)
        if id(message) not in continued:
            places.setdefault((message.name, message.name), (last + 0.5, -1))
    return places
