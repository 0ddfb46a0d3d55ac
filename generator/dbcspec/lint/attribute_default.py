"""Rule attribute-default: every attribute that a DBC file defines has a default."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.fix import attributes_without_default
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.errors import Location


def _check(subject: Subject) -> Iterator[Found]:
    for attribute in attributes_without_default(subject.dbc_text or ""):
        remedy = f'add BA_DEF_DEF_  "{attribute.name}" {attribute.default or "…"};'
        yield Found(
            Location(subject.source, attribute.line),
            attribute.name,
            f"the attribute {attribute.name} has no default: {remedy}",
        )


RULE = Rule(
    "attribute-default",
    "every attribute that a DBC file defines has a default",
    _check,
    level="warning",
)
