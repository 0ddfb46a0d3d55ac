"""Rule transfer-fits-kind: each transfer can be put together as its kind says.

One that cannot is passed over by live nodes and in the tables of logs.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.protocol import NOWHERE
from typedcan.model.transfers.registry import problems


def _check(subject: Subject) -> Iterator[Found]:
    rows = {row.name: row for row in subject.spec.behaviour.transfers} if subject.spec else {}
    for transfer in subject.protocol.transfers:
        row = rows.get(transfer.name)
        for problem in problems(transfer, subject.protocol):
            where = row.where_is(problem.key) if row else NOWHERE
            text = f"transfer {transfer.name}, {problem.key}: {problem.text}"
            yield Found(where, transfer.name, text)


RULE = Rule("transfer-fits-kind", "each transfer has what its kind needs, and nothing else", _check)
