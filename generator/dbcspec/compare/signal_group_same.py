"""Signals that belong together still do."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, message_change
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        old = {
            each.name: _text([message.renamed.get(s, s) for s in each.signals], each.repetitions)
            for each in message.old.groups
        }
        new = {each.name: _text(each.signals, each.repetitions) for each in message.new.groups}
        for name in dict.fromkeys([*old, *new]):
            was, now = old.get(name, ""), new.get(name, "")
            if was != now:
                yield message_change(message, f"signal group {name}", was, now)


def _text(signals: tuple[str, ...] | list[str], repetitions: int) -> str:
    often = f", {repetitions} times" if repetitions != 1 else ""
    return f"{' '.join(sorted(signals)) or 'no signal'}{often}"


PROMISE = Promise(
    "signal-group-same",
    "Signals that are to be taken together are the same ones.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
    needs=Aspect.ATTRIBUTES,
)
