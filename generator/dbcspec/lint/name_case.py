"""Rule name-case: names that share a space differ in more than case.

Some readers, file systems and programming languages take upper and lower case for the same.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.name_spaces import Named, name_spaces
from dbcspec.lint.rule import Found, Rule, Subject


def _check(subject: Subject) -> Iterator[Found]:
    for space in name_spaces(subject):
        first: dict[str, Named] = {}
        for named in (each for each in space if not each.alias):
            other = first.setdefault(named.name.casefold(), named)
            if other.name != named.name:
                text = (
                    f"{named.name}, {named.what}, differs from {other.name}, {other.what}, in case "
                    f"only: rename one"
                )
                yield Found(named.where, named.name, text, named.message)


RULE = Rule(
    "name-case", "names that share a space differ in more than case", _check, level="warning"
)
