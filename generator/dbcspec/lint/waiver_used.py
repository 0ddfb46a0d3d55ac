"""Rule waiver-used: every waiver accepts at least one finding."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    for waiver in subject.unused_waivers:
        text = f"the waiver of {waiver.rule} for {waiver.subject} accepts nothing: delete it"
        yield Found(waiver.where, waiver.subject, text)


RULE = Rule("waiver-used", "every waiver accepts at least one finding", _check, level="warning")
