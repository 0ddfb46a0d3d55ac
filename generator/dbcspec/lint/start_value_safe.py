"""Rule start-value-safe: no signal starts with a code that acts, or says that something is on.

The start value stands in DBC files, and generated code sends it for a field that is not given.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        acting = signal.acting
        if acting and signal.start_value in acting.codes:
            what = "says that something is on" if acting.reports else "acts"
            text = (
                f"{signal.name} starts with raw {signal.start_value}, which {what}: start with "
                f"{acting.safe}, the safe code"
            )
            yield Found(places.layout(signal, "initial"), signal.name, text, message.name)


RULE = Rule("start-value-safe", "no signal starts with a code that acts", _check)
