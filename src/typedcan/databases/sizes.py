"""Sizes that files state, looked at before cantools does anything with them.

A line that says a hundred million bits, or a number with nine digits of exponent, is short; what
would be made of it fills the memory. So each number that says how large something is must be one
that a message can have, however it is spelt.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from xml.parsers import expat

from typedcan.model.errors import Location, ReadError

MOST_BYTES = 4095
"""Of the longest transfer that ISO 15765-2 knows with a length of 12 bits."""

MOST_BITS = 8 * MOST_BYTES
"""No message has more."""

_DEEPEST = 200
_LONGEST_NUMBER = 20
_WHOLE = (True,)
_ENDLESS = re.compile(r"(?<![\w.-])[-+]?(?:\d+\.?\d*|\.\d+)[eE]\+?\d{5,}(?![\w.-])")


def refuse_endless_numbers(text: str, name: str) -> None:
    """Raise `ReadError` for a number with five digits of exponent: as an integer it has no end."""
    if found := _ENDLESS.search(text):
        where = Location(name, text.count("\n", 0, found.start()) + 1)
        raise ReadError(f"{where}: nothing has a value of {found[0][:_LONGEST_NUMBER]}")


def refuse_large(text: str, format_: str, name: str) -> None:
    """Raise `ReadError` for what no message has in the text of a KCD, SYM or ARXML file."""
    if (
        format_ != "arxml"
    ):  # which has identifiers that look like numbers, and reads these as floats
        refuse_endless_numbers(text, name)
    _REFUSING[format_](text, name)


def _is_too_large(number: str) -> bool:
    """Whether a size is one that no message has, in any spelling that Python's int takes."""
    if len(number) > _LONGEST_NUMBER:
        return True
    for base in (0, 10):
        try:
            return abs(int(number, base)) > MOST_BITS
        except ValueError:
            continue
    return False


class _Xml:
    """Goes through XML once: no document types, no endless nesting, no sizes beyond a message's."""

    def __init__(self, name: str, is_size: Callable[[str], bool]) -> None:
        self._name = name
        self._is_size = is_size
        self._depth = 0
        self._text: list[str] | None = None
        self._parser = expat.ParserCreate("utf-8")
        self._parser.StartDoctypeDeclHandler = self._doctype
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.CharacterDataHandler = self._characters

    def check(self, text: str) -> None:
        try:
            self._parser.Parse(text.encode("utf-8", "surrogatepass"), *_WHOLE)
        except expat.ExpatError as error:
            where = Location(self._name, error.lineno, error.offset + 1)
            raise ReadError(f"{where}: not XML: {expat.ErrorString(error.code)}") from None

    def _error(self, text: str) -> ReadError:
        return ReadError(f"{Location(self._name, self._parser.CurrentLineNumber)}: {text}")

    def _doctype(self, *_: object) -> None:
        raise self._error("declares a document type, which a database has no use for")

    def _start(self, tag: str, attributes: Mapping[str, str]) -> None:
        self._depth += 1
        if self._depth > _DEEPEST:
            raise self._error("nested too deeply")
        for key, value in attributes.items():
            if self._is_size(key) and _is_too_large(value.strip()):
                raise self._large(value)
        self._text = [] if self._is_size(tag.rpartition(":")[2]) else None

    def _characters(self, text: str) -> None:
        if self._text is not None:
            self._text.append(text)

    def _end(self, _: str) -> None:
        self._depth -= 1
        if self._text is not None and _is_too_large("".join(self._text).strip()):
            raise self._large("".join(self._text).strip())
        self._text = None

    def _large(self, value: str) -> ReadError:
        return self._error(f"no message has so many bits: {value[:_LONGEST_NUMBER]}")


def _refuse_in_kcd(text: str, name: str) -> None:
    _Xml(name, lambda key: key in ("length", "offset")).check(text)


def _refuse_in_arxml(text: str, name: str) -> None:
    _Xml(name, lambda tag: tag.endswith("LENGTH") or tag == "START-POSITION").check(text)


_NO_SIZES_IN_SYM = re.compile(
    r"""//[^\n]*|"[^"]*"|/\w+:\S*|\benum\s+\w+\s*\([^)]*\)|"""
    r"""\b(?:CycleTime|Timeout|MinInterval|ID|Type|Color|FormatVersion|Title)\s*=\s*\S+""",
    re.IGNORECASE,
)
"""What has numbers in a SYM file that are none of places and lengths."""

_NUMBER_IN_SYM = re.compile(r"(?<![\w.])\d[\w.]*")


def _refuse_in_sym(text: str, name: str) -> None:
    bare = _NO_SIZES_IN_SYM.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    for found in _NUMBER_IN_SYM.finditer(bare):
        number = found[0]
        if not number.lower().endswith("h") and _is_too_large(number):  # values of multiplexers
            where = Location(name, text.count("\n", 0, found.start()) + 1)
            raise ReadError(f"{where}: no message has so many bits: {number[:_LONGEST_NUMBER]}")


_REFUSING: Mapping[str, Callable[[str, str], None]] = {
    "kcd": _refuse_in_kcd,
    "sym": _refuse_in_sym,
    "arxml": _refuse_in_arxml,
}
