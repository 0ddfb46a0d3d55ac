"""A DBC file as text: where its lines stand, and what cantools would refuse a whole file for.

Suppliers' files have codes for signals that they no longer have, values of attributes that they
never define, and enumerations given by word instead of number. cantools refuses such a file; here
these few statements are taken out or put right, and no line changes its number.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field
from itertools import pairwise

from typedcan.databases.sizes import MOST_BITS, MOST_BYTES, refuse_endless_numbers
from typedcan.model.errors import Location, ReadError

UNASSIGNED = "VECTOR__INDEPENDENT_SIG_MSG"
"""The message that holds signals of no message; it is none itself."""

_WORDS = frozenset(
    """VERSION NS_ BS_ BU_ BO_ SG_ CM_ BA_ BA_DEF_ BA_DEF_DEF_ VAL_ VAL_TABLE_ EV_ EV_DATA_
    ENVVAR_DATA_ SGTYPE_ SGTYPE_VAL_ BA_DEF_SGTYPE_ BA_SGTYPE_ SIG_TYPE_REF_ SIG_GROUP_
    SIG_VALTYPE_ SIGTYPE_VALTYPE_ BO_TX_BU_ BA_DEF_REL_ BA_REL_ BA_DEF_DEF_REL_ BU_SG_REL_
    BU_EV_REL_ BU_BO_REL_ SG_MUL_VAL_ CAT_DEF_ CAT_ FILTER NS_DESC_""".split()  # noqa: SIM905 - thirty quoted words read worse
)
_ONE_LINERS = frozenset({"VERSION", "BS_"})
_LONGEST_STATEMENT = 10_000
_LONGEST_LINE = 1 << 22
_LONGEST_TEXT = 1 << 20
_MOST_MESSAGES = 50_000
_MOST_SELECTORS = 1 << 13
_SELECTORS_OF_A_LETTER = 8
"""A long file may have so many more: eight for each of its characters."""

_MOST_DIGITS = 9


# No possessive quantifiers: the first releases of Python 3.11 take them wrongly, and each of these
# can match in one way only.
_QUOTED_OR_COMMENT = re.compile(r'"[^"\\]*(?:\\(?:"|(?!"))[^"\\]*)*"|//[^\n]*|"')
_PLACED = re.compile(
    r"\b(?:BO_\s+(\d+)\s+(\w+)|SG_\s+(\w+)(?:\s+\w+)?)\s*:(?:\s*(\d+)(?:\s*\|\s*(\d+))?)?"
)
_OF_SIGNAL = re.compile(r"\b(?:VAL_|SIG_VALTYPE_)\s+(\d+)\s+(\w+)[^;]*;")
_IDENTIFIER = re.compile(
    r"\b(?:BO_|SG_|VAL_|SIG_VALTYPE_|SG_MUL_VAL_|BO_TX_BU_|SIG_GROUP_)\s+(\d{1,10})\b"
)
_DEFINITION = re.compile(r'\bBA_DEF_\s+(?:\w+_\s+)?("[^"]*")\s+(\w+)([^;]*);')
_VALUE = re.compile(r'\bBA_\s+("[^"]*")[^;]*?("[^"]*")?\s*;')
_SELECTORS = re.compile(r"\bSG_MUL_VAL_[^;]*;")
_RANGE = re.compile(r"(\d{1,20})\s*-\s*(\d{1,20})")
UNFINISHED_CODES = re.compile(
    r'(?m)^[ \t]*VAL_\s+\d+\s+\w+(?:\s+-?\d+\s+"[^"\\]*(?:\\.[^"\\]*)*")+\s*\Z'
)
"""Codes at the end of a file that lack their semicolon only."""

_NO_LINE_END = re.compile(r"[^\n]")
_QUOTED = re.compile(r'"((?:\\"|[^"])*?)"')


@dataclass(frozen=True, slots=True)
class MessagePlace:
    """A message as its BO_ line has it: name and line, and those of its signals."""

    id: int
    name: str
    line: int
    signals: list[tuple[str, int]] = field(default_factory=list[tuple[str, int]])


class DbcText:
    """The text of a DBC file; raises `ReadError` for what cannot be one."""

    def __init__(self, text: str, name: str, *, wide: bool = False) -> None:
        self._text = text
        self._name = name
        self._starts = [match.end() for match in re.finditer("\n", text)]
        self._refuse_endless_lines()
        # The same with nothing in its quotes, so that patterns find no words of other people.
        self._bare = _QUOTED_OR_COMMENT.sub(self._blank, text)
        refuse_endless_numbers(self._bare, name)
        self._refuse_other_text()
        self._refuse_endless_selectors()
        self.unmarked: set[int] = set()
        """Identifiers of more than 11 bits that no mark says to have 29; with ``wide`` only."""
        self._wide = wide
        self.places = self._find_places()
        """The messages in their order."""

    def mended(self) -> str:
        """The text without what no message or definition claims, words of enumerations as numbers.

        Positions change, lines do not.
        """
        pieces: list[str] = []
        done = 0
        for start, end, new in sorted([*self._orphans(), *self._attributes(), *self._marked()]):
            if start < done:  # in a statement that is left out
                continue
            pieces += (self._text[done:start], new)
            done = end
        unfinished = UNFINISHED_CODES.search(self._text)
        return "".join((*pieces, self._text[done:], ";" if unfinished else ""))

    def _marked(self) -> list[tuple[int, int, str]]:
        """Identifiers marked as what they must be, for cantools to read them."""
        found = _IDENTIFIER.finditer(self._bare) if self.unmarked else ()
        return [
            (match.start(1), match.end(1), str(int(match[1]) | 1 << 31))
            for match in found
            if int(match[1]) in self.unmarked
        ]

    def _line(self, position: int) -> int:
        return bisect_right(self._starts, position) + 1

    def _where(self, position: int) -> Location:
        return Location(self._name, self._line(position))

    def _refuse_endless_lines(self) -> None:
        """What is no DBC file at all must not cost minutes and gigabytes to find that out."""
        first = (self._text[:_LONGEST_TEXT].replace(":", " ").split(None, 1) or [":"])[0]
        if first not in _WORDS and not first.startswith("//"):
            raise ReadError(f"{self._name}: is no DBC file: it begins with {first[:20]!r}")
        for start, end in pairwise((0, *self._starts, len(self._text))):
            if end - start > _LONGEST_LINE:
                raise ReadError(f"{self._where(start)}: the line is longer than {_LONGEST_LINE}")

    def _blank(self, match: re.Match[str]) -> str:
        whole = match[0]
        if whole == '"':
            raise ReadError(f"{self._where(match.start())}: a quote is opened and never closed")
        if len(whole) > _LONGEST_TEXT:
            raise ReadError(f"{self._where(match.start())}: a text longer than {_LONGEST_TEXT}")
        inner = whole[1:-1]
        spaces = _NO_LINE_END.sub(" ", inner) if "\n" in inner else " " * len(inner)
        return f'"{spaces}"' if whole[0] == '"' else " " * len(whole)

    def _refuse_other_text(self) -> None:
        """Every statement begins with a word of the language; others only go one on."""
        last, length = "VERSION", 0
        for number, line in enumerate(self._bare.split("\n"), start=1):
            words = line.replace(":", " ").split(None, 1)
            if not words:
                continue
            length += 1
            if words[0] in _WORDS:
                last, length = words[0], 0
            elif last in _ONE_LINERS or length > _LONGEST_STATEMENT:
                raise ReadError(f"{Location(self._name, number)}: this is no line of a DBC file")

    def _refuse_endless_selectors(self) -> None:
        """A range such as 0-4294967295 is a list of so many numbers to cantools."""
        total = 0
        most = _MOST_SELECTORS + _SELECTORS_OF_A_LETTER * len(self._text)
        for statement in _SELECTORS.finditer(self._bare):
            for low, high in _RANGE.findall(statement[0]):
                total += int(high) - int(low)
            if total > most:
                where = self._where(statement.start())
                raise ReadError(f"{where}: more than {most} multiplexer values")

    def _find_places(self) -> list[MessagePlace]:
        places: list[MessagePlace] = []
        for match in _PLACED.finditer(self._bare):
            line = self._line(match.start())
            if match[1] and len(places) == _MOST_MESSAGES:
                raise ReadError(
                    f"{self._where(match.start())}: more than {_MOST_MESSAGES} messages"
                )
            if match[1]:
                self._refuse_wide_identifier(match)
                self._refuse_large(match, match[2], [match[4]], MOST_BYTES, "bytes")
                places.append(MessagePlace(int(match[1]), match[2], line))
            elif places:
                numbers = [match[4], match[5]]
                self._refuse_large(match, match[3], numbers, MOST_BITS, "bits")
                places[-1].signals.append((match[3], line))
        return places

    def _refuse_wide_identifier(self, message: re.Match[str]) -> None:
        """The highest of 32 bits says that an identifier has 29 bits, not 11."""
        extended, identifier = divmod(int(message[1]), 1 << 31)
        bits = 29 if extended else 11
        if self._wide and not extended and identifier >> bits and not identifier >> 29:
            self.unmarked.add(identifier)
        elif message[2] != UNASSIGNED and (extended > 1 or identifier >> bits):
            where = self._where(message.start())
            raise ReadError(f"{where}: {message[2]}: {message[1]} is no identifier of {bits} bits")

    def _refuse_large(
        self, place: re.Match[str], name: str, numbers: list[str | None], most: int, unit: str
    ) -> None:
        """Numbers as large as such a message's or signal's would fill the memory."""
        given = [number for number in numbers if number]
        if any(len(each) > _MOST_DIGITS or int(each) > most for each in given):
            raise ReadError(f"{self._where(place.start())}: {name}: no message has so many {unit}")

    def _orphans(self) -> list[tuple[int, int, str]]:
        """Codes and types of signals that are in no message."""
        signals = {
            (place.id, name)
            for place in self.places
            if place.name != UNASSIGNED
            for name, _ in place.signals
        }
        return [
            self._emptied(match)
            for match in _OF_SIGNAL.finditer(self._bare)
            if (int(match[1]), match[2]) not in signals
        ]

    def _attributes(self) -> list[tuple[int, int, str]]:
        """Values without a definition, and words of enumerations."""
        words: dict[str, list[str]] = {}
        for match in _DEFINITION.finditer(self._bare):
            name = self._text[match.start(1) : match.end(1)]
            values = self._text[match.start(3) : match.end(3)]
            words[name] = _QUOTED.findall(values) if match[2] == "ENUM" else []
        edits: list[tuple[int, int, str]] = []
        for match in _VALUE.finditer(self._bare):
            name = self._text[match.start(1) : match.end(1)]
            value = self._text[match.start(2) + 1 : match.end(2) - 1] if match[2] else ""
            if name not in words:
                edits.append(self._emptied(match))
            elif value in words[name]:
                edits.append((match.start(2), match.end(2), str(words[name].index(value))))
        return edits

    def _emptied(self, match: re.Match[str]) -> tuple[int, int, str]:
        lines = self._text.count("\n", match.start(), match.end())
        return match.start(), match.end(), "\n" * lines
