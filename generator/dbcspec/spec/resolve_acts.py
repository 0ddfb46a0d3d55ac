"""The acts of behaviour.yaml to codes that act, by signal; rows that contradict themselves."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.errors import Fault
from dbcspec.spec.behaviour_rows import ActsRow
from dbcspec.spec.rows import Spec
from typedcan.model.acting import ActingCodes


def acting_codes(spec: Spec, faults: list[Fault]) -> dict[str, ActingCodes]:
    """The codes that act, by signal or ``message.signal``, as their rows name it."""
    acting: dict[str, ActingCodes] = {}
    for row in spec.behaviour.acts:
        if row.signal in acting:
            text = f"{row.signal}: a second row of codes that act; put them into one"
            faults.append(Fault(row.where_is("signal"), text))
        faults += _contradictions(row)
        acting[row.signal] = ActingCodes(
            codes=tuple(sorted(set(row.codes))),
            safe=row.safe,
            reports=row.kind == "report",
            reference=row.cite,
        )
    return acting


def _contradictions(row: ActsRow) -> Iterator[Fault]:
    if not row.codes:
        yield Fault(row.where_is("codes"), f"{row.signal}: no code acts; leave the row out")
    if row.safe in row.codes:
        text = f"{row.signal}: the safe code {row.safe} acts itself"
        yield Fault(row.where_is("safe"), text)
    for code in sorted({code for code in row.codes if row.codes.count(code) > 1}):
        yield Fault(row.where_is("codes"), f"{row.signal}: code {code} stands here twice")
