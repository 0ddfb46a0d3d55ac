"""Rule name-keyword: no name is a word of the languages that code is generated in."""

from __future__ import annotations

import keyword
from collections.abc import Iterator

from dbcspec.lint.name_spaces import name_spaces
from dbcspec.lint.places import Places, value_tables
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.naming import member_names
from typedcan.model.protocol import Aspect

_C = """
    auto break case char const continue default do double else enum extern float for goto if
    inline int long register restrict return short signed sizeof static struct switch typedef union
    unsigned void volatile while _Alignas _Alignof _Atomic _Bool _Complex _Generic _Imaginary
    _Noreturn _Static_assert _Thread_local NULL EOF
"""
_CAPL = """
    byte word dword qword int64 message multiplexed_message pg timer msTimer sysvar sysvarInt
    sysvarFloat sysvarString sysvarData envVar envvar signal diagRequest diagResponse linFrame
    frFrame frPDU mostMessage ethernetPacket includes variables on elcount export import testcase
    testfunction this key preStart start stopMeasurement preStop errorFrame busOff errorActive
    errorPassive warningLimit
"""
_LANGUAGES = {
    "Python": frozenset(keyword.kwlist),
    "C": frozenset(_C.split()),
    "CAPL": frozenset(_CAPL.split()),
}


def _check(subject: Subject) -> Iterator[Found]:
    seen: set[tuple[str, str]] = set()
    for space in name_spaces(subject):
        for where, name, what, message, alias in space:
            if (language := _language(name)) and not alias and (name, what) not in seen:
                seen.add((name, what))
                text = f"{name}, {what}, is a word of {language}: rename it"
                yield Found(where, name, text, message)
    yield from _in_python(subject)


def _in_python(subject: Subject) -> Iterator[Found]:
    """The names that generated code has beyond those of the protocol."""
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        if keyword.iskeyword(signal.python_name):
            text = f"{signal.python_name}, the field of {signal.name}, is a word of Python: rename"
            where = places.layout(signal, "field")
            yield Found(where, signal.name, f"{text} it", message.name)
    for table in value_tables(subject.protocol):
        labels = table.labels() if Aspect.PYTHON_NAMES in subject.protocol.carries else {}
        for code, member in member_names([*labels.items()]).items():
            if language := _language(member):
                text = (
                    f"{member}, the member for {labels[code]!r} of {table.name}, is a word of "
                    f"{language}: give another label"
                )
                yield Found(places.codes(table, code), table.name, text)


def _language(name: str) -> str:
    """The language that a name is a word of, or "" ."""
    return next((language for language, words in _LANGUAGES.items() if name in words), "")


RULE = Rule("name-keyword", "no name is a word of Python, C or CAPL", _check, level="warning")
