"""Rule text-gbk: the texts that are not English are in GB2312, the safe part of GBK.

Chinese Windows tools read DBC files as GBK, in which some characters outside GB2312 end in the
byte of a backslash. English texts of a spec are for text-ascii.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.lint.texts import texts


def _check(subject: Subject) -> Iterator[Found]:
    for text in texts(subject):
        if (subject.spec is None or not text.english) and (foreign := _foreign(text.text)):
            fault = f"{text.what} has {foreign!r}, which GB2312 lacks: use another character"
            yield Found(text.where, text.subject, fault, text.message)


def _foreign(text: str) -> str:
    """The first character that GB2312 lacks, or "" ."""
    try:
        text.encode("gb2312")
    except UnicodeEncodeError as error:
        return text[error.start]
    return ""


RULE = Rule(
    "text-gbk",
    "texts that are not English are in GB2312, the safe part of GBK",
    _check,
    level="warning",
)
