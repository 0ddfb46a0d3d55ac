"""Things stay in their order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import (
    Breaks,
    Change,
    Class,
    Promise,
    listed,
    message_change,
    protocol_change,
    signal_change,
)
from dbcspec.compare.spec_only import both_are_specs

_SHOWN = 3


def _check(pairing: Pairing) -> Iterator[Change]:
    yield from _of_protocol(pairing)
    for message in pairing.messages:
        if message.reordered:
            old = [message.renamed.get(each.name, each.name) for each in message.old.signals]
            shown = _where_they_differ(old, [each.name for each in message.new.signals])
            yield message_change(message, "order of signals", *shown)
        for signal in message.signals:
            was = pairing.continued(signal.old.receivers)
            now = signal.new.receivers
            if was != now and set(was) == set(now):
                yield signal_change(signal, "order of receivers", listed(was), listed(now))


def _of_protocol(pairing: Pairing) -> Iterator[Change]:
    old, new = pairing.old, pairing.new
    names = pairing.names
    lists = [
        (
            "messages",
            [pairing.names.get(each.name, each.name) for each in old.messages],
            [each.name for each in new.messages],
        ),
        ("nodes", pairing.continued(each.name for each in old.nodes), [n.name for n in new.nodes]),
    ]
    if both_are_specs(pairing):
        buses = {before.name: after.name for before, after in pairing.buses}
        lists += [
            (
                "buses",
                [buses.get(each.name, each.name) for each in old.buses],
                [each.name for each in new.buses],
            ),
            (
                "transfers",
                [each.name for each in old.transfers],
                [each.name for each in new.transfers],
            ),
            (
                "requests",
                [f"{names.get(each.signal, each.signal)} = {each.code}" for each in old.requests],
                [f"{each.signal} = {each.code}" for each in new.requests],
            ),
        ]
        lists += [
            (f"nodes of {after.name}", pairing.continued(before.nodes), list(after.nodes))
            for before, after in pairing.buses
        ]
    for what, before, after in lists:
        if _moved(before, after):
            shown = _where_they_differ(before, after)
            yield protocol_change(what, f"order of {what}", *shown)


def _moved(old: Sequence[str], new: Sequence[str]) -> bool:
    if list(old) == list(new):
        return False
    before, after = _common(old, new)
    return before != after


def _common(old: Sequence[str], new: Sequence[str]) -> tuple[list[str], list[str]]:
    both = set(old) & set(new)
    before = dict.fromkeys(name for name in old if name in both)
    return [*before], [*dict.fromkeys(name for name in new if name in both)]


def _where_they_differ(old: Sequence[str], new: Sequence[str]) -> tuple[str, str]:
    """The first few names between the first and the last that stand elsewhere."""
    before, after = _common(old, new)
    places = [i for i, pair in enumerate(zip(before, after, strict=True)) if pair[0] != pair[1]]
    shown = slice(places[0], min(places[-1] + 1, places[0] + _SHOWN))
    return listed(before[shown]), listed(after[shown])


PROMISE = Promise(
    "order-same",
    "Messages, signals, nodes and receivers are listed in the same order.",
    Class.COSMETIC,
    Breaks.NOBODY,
    _check,
)
