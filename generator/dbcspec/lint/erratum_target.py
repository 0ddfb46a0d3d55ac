"""Rule erratum-target: every change of an erratum finds what it names, and changes it."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    errata = subject.spec.errata if subject.spec else ()
    for fault in subject.errata_faults:
        # The text may come from the reader of a new value; the erratum is the one around it.
        before = [erratum for erratum in errata if erratum.where <= fault.where]
        number = max(before, key=lambda erratum: erratum.where).id if before else ""
        yield Found(fault.where, number, fault.text)


RULE = Rule("erratum-target", "every erratum changes something that exists", _check)
