"""Rule text-fits-dbc: no text has characters that DBC readers take differently.

Some readers end a text at a backslash, a semicolon or a line break, and cut labels and units at a
comma.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.lint.texts import Text, Use, texts

_FORBIDDEN = {'"': "a double quote", "\\": "a backslash", ";": "a semicolon", "\n": "a line break"}


def _check(subject: Subject) -> Iterator[Found]:
    for text in texts(subject):
        for fault in _faults(text):
            yield Found(text.where, text.subject, f"{text.what} {fault}", text.message)


def _faults(text: Text) -> Iterator[str]:
    plain = text.text.replace("\r\n", "\n")
    for character, name in _FORBIDDEN.items():
        if character in plain:
            yield f"contains {name}: take it out"
    if any(ord(each) < 32 and each != "\n" for each in plain):
        yield "contains a control character: take it out"
    if text.use is not Use.COMMENT and "," in plain:
        yield "contains a comma: write it without"
    if text.use is Use.LABEL and not plain.strip():
        yield "is empty: give a label, or leave out the code"


RULE = Rule("text-fits-dbc", "no text has characters that DBC readers take differently", _check)
