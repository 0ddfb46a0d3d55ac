"""Rule checksum-algorithm-known: each checksum has an algorithm that the runtime can compute.

One that it cannot is sent as 0 and not verified. Where the standard leaves the algorithm open that
is all that can be done: a waiver says so, with the reason.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.checksums import ALGORITHMS


def _check(subject: Subject) -> Iterator[Found]:
    rows = {row.signal: row for row in subject.spec.behaviour.checksums} if subject.spec else {}
    for message in subject.protocol.messages:
        checksum = message.checksum
        if checksum and checksum.algorithm not in ALGORITHMS:
            row = rows.get(checksum.signal)
            where = row.where_is("algorithm") if row else message.signal(checksum.signal).where
            text = (
                f"{checksum.signal} has the algorithm {checksum.algorithm!r}, which nothing here "
                f"computes (known: {', '.join(ALGORITHMS)}), so that it would be sent as 0: "
                "correct it, or waive this where the standard leaves it open"
            )
            yield Found(where, checksum.signal, text, message.name)


RULE = Rule(
    "checksum-algorithm-known", "each checksum has an algorithm that can be computed", _check
)
