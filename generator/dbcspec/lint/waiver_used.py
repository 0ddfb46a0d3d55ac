"""Rule waiver-used: every waiver accepts at least one finding."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.errors import Location
from dbcspec.lint.rule import Rule, Subject


def _check(subject: Subject) -> Iterator[tuple[Location, str, str]]:
    for waiver in subject.unused_waivers:
        text = f"the waiver of {waiver.rule} for {waiver.subject} accepts nothing: delete it"
        yield waiver.where, waiver.subject, text


RULE = Rule("waiver-used", "every waiver accepts at least one finding", _check)
