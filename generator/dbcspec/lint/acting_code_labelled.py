"""Rule acting-code-labelled: what acts, and what is safe, are codes that the signal labels.

So nothing moves at a raw value that no document names; a float has no codes at all.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import Signal


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        for key, what, codes in _unlabelled(signal):
            text = (
                f"{signal.name}: no label for {what} {', '.join(map(str, codes))}: label it, or "
                f"correct {key}"
            )
            yield Found(places.acts(message, signal, key), signal.name, text, message.name)


def _unlabelled(signal: Signal) -> Iterator[tuple[str, str, list[int]]]:
    """Key of the row, what it is, and the codes without a label."""
    if signal.acting is None:
        return
    table = None if signal.is_float else signal.value_table
    labelled = {code.value for code in table.codes} if table else set[int]()
    acting = [code for code in signal.acting.codes if code not in labelled]
    if acting:
        yield "codes", "acting code", acting
    if signal.acting.safe not in labelled:
        yield "safe", "safe code", [signal.acting.safe]


RULE = Rule(
    "acting-code-labelled", "codes that act, and their safe code, have labels of their own", _check
)
