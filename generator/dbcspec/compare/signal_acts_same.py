"""The same codes of a signal make its receiver act, and the same code is safe.

Bits that belonged to no signal were sent as 0: a new signal at which 0 acts is told here too.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, from_to, in_signals, listed
from typedcan.model.protocol import Aspect, Signal

_WORD = "codes that act"


def _acts(signal: Signal) -> str:
    acting = signal.acting
    codes = listed(map(str, acting.codes)) if acting else ""
    return f"{codes} as {acting.kind}, safe {acting.safe}" if acting else ""


def _check(pairing: Pairing) -> Iterator[Change]:
    yield from in_signals(_WORD, _acts)(pairing)
    for message in pairing.messages:
        for signal in message.added:
            if signal.acting and 0 in signal.acting.codes:
                yield Change(
                    message=message.new.name,
                    subject=signal.name,
                    text=f"{from_to(_WORD, '', _acts(signal))}; its bits were sent as 0",
                    old="",
                    new=_acts(signal),
                    where=signal.where,
                )


PROMISE = Promise(
    "signal-acts-same",
    "The same codes of a signal make its receiver act, and the same code ends that.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
    needs=Aspect.ACTS,
)
