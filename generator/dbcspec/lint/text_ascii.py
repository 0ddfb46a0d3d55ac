"""Rule text-ascii: the English texts of a spec are ASCII, as the files made of them are.

A DBC file has one text for all: text-gbk judges its characters.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.lint.texts import texts


def _check(subject: Subject) -> Iterator[Found]:
    for text in texts(subject) if subject.spec else ():
        if text.english and not text.text.isascii():
            fault = f"{text.what} is not ASCII: give an English form"
            yield Found(text.where, text.subject, fault, text.message)


RULE = Rule("text-ascii", "the English texts of a spec are ASCII", _check, level="warning")
