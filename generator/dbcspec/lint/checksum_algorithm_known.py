"""Rule checksum-algorithm-known: each checksum has an algorithm that the runtime can compute.

A message with one that it cannot is not sent, unless users give it a function. Where the standard
leaves the algorithm open, the spec says so: until users give one it is sent as 0 and not verified.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.checksums.registry import AlgorithmError, method_of


def _check(subject: Subject) -> Iterator[Found]:
    rows = {row.signal: row for row in subject.spec.behaviour.checksums} if subject.spec else {}
    for message in subject.protocol.messages:
        checksum = message.checksum
        if checksum is None or checksum.is_open or checksum.algorithm in subject.algorithms:
            continue
        try:
            method_of(checksum.algorithm)
        except AlgorithmError as error:
            name = checksum.signal
            row = rows.get(f"{message.name}.{name}", rows.get(name))
            where = row.where_is("algorithm") if row else message.signal(name).where
            text = f"{name}: {error}; --algorithm takes a function of yours"
            text += "; where the standard leaves it open, say `open: yes`"
            yield Found(where, name, text, message.name)


RULE = Rule(
    "checksum-algorithm-known", "each checksum has an algorithm that can be computed", _check
)
