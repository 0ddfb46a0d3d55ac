"""Rule text-fits-dbc: every DBC reader takes the texts and numbers of the protocol the same way.

English texts are ASCII. The others are encodable in GB2312, none of whose characters ends in
the byte of a backslash. Some readers cut labels and units at a comma, long labels and long lines.
"""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from dbcspec.lint.texts import Text, Use, texts
from dbcspec.model import ValueTable

_FORBIDDEN = {'"': "a double quote", "\\": "a backslash", ";": "a semicolon", "\n": "a line break"}
_MOST_DIGITS = 6
_LONGEST_LABEL = 63
_LONGEST_LINE = 5999
_LINE_START = f"VAL_ {2**32 - 1} {'n' * 32} "
"""The longest there can be."""


def _check(subject: Subject) -> Iterator[Found]:
    for text in texts(subject):
        for fault in _text_faults(text):
            yield text.where, text.subject, f"{text.what} {fault}"
    places = Places(subject)
    for _, signal in subject.protocol.signals():
        for key, value in (("factor", signal.factor), ("offset", signal.offset)):
            digits = len(value.normalize().as_tuple().digits)
            if digits > _MOST_DIGITS:
                fault = f"has {digits} significant digits: give at most {_MOST_DIGITS}"
                where = places.meaning(signal, key)
                yield where, signal.name, f"{key} {value} of {signal.name} {fault}"
    for table in subject.protocol.value_tables:
        length = _line_length(table)
        if length > _LONGEST_LINE:
            fault = f"may take {length} bytes: shorten its labels to at most {_LONGEST_LINE}"
            yield places.codes(table), table.name, f"the value line of {table.name} {fault}"


def _text_faults(text: Text) -> Iterator[str]:
    for character, name in _FORBIDDEN.items():
        if character in text.text:
            yield f"contains {name}: take it out"
    if any(ord(each) < 32 and each != "\n" for each in text.text):
        yield "contains a control character: take it out"
    if text.use is not Use.COMMENT and "," in text.text:
        yield "contains a comma: write it without"
    if text.english and not text.text.isascii():
        yield "is not ASCII: give an English form"
    if not text.english and (foreign := _not_in_gb2312(text.text)):
        yield f"has {foreign!r}, which GB2312 lacks: use another character"
    if text.use is Use.LABEL:
        length = len(text.text.encode())
        if not text.text.strip():
            yield "is empty: give a label, or leave out the code"
        if length > _LONGEST_LABEL:
            yield f"takes {length} bytes: shorten it to at most {_LONGEST_LABEL}"


def _not_in_gb2312(text: str) -> str:
    try:
        text.encode("gb2312")
    except UnicodeEncodeError as error:
        return text[error.start]
    return ""


def _line_length(table: ValueTable) -> int:
    """The bytes of the longest VAL_ line with the table's codes, in any of the DBC files."""
    return max(
        len(f"{_LINE_START}{' '.join(_pairs(table.labels(english=english)))} ;".encode())
        for english in (True, False)
    )


def _pairs(labels: dict[int, str]) -> list[str]:
    return [f'{value} "{label}"' for value, label in labels.items()]


RULE = Rule("text-fits-dbc", "every DBC reader takes the texts and numbers the same way", _check)
