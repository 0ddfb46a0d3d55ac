"""Mends the text of a DBC file where the right answer is certain, and finds what to mend.

Certain is what changes no meaning: the form of a line, and the default of an attribute that says
as much as none, or that nothing can get. Texts in quotes and comments behind // stay as they are.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal

from typedcan.databases.dbc_text import UNFINISHED_CODES

_HIDDEN = re.compile(r'"(?:\\"|[^"])*"|//[^\n]*?(?=\r?(?:\n|\Z))')
_HIDDEN_CHARACTER = "\0"
_BREAK = re.compile(r"\r\n|\r|\n")


@dataclass(frozen=True, slots=True)
class Repair:
    """Something mended: the fault, how many lines had it, and the first of them, from 1."""

    line: int
    fault: str
    count: int = 1

    def __str__(self) -> str:
        return f"{self.fault}, in {self.count} lines" if self.count > 1 else self.fault


@dataclass(frozen=True, slots=True)
class Undefaulted:
    """An attribute without a default; ``default`` is the certain one as DBC writes it, or ""."""

    name: str
    line: int
    default: str


@dataclass(frozen=True, slots=True)
class _Line:
    """A line with its break and its number; ``bare`` has NULs for texts and comments.

    Breaks inside a text in quotes do not end a line.
    """

    text: str
    bare: str
    end: str
    number: int


def fix_dbc(text: str) -> tuple[str, list[str]]:
    """The text mended, and what was done, one line each; mending it again changes nothing."""
    formed, repairs = repair_form(text)
    # What stands behind an open quote is no certain place for a line.
    missing = [] if '"' in _bare(formed) else attributes_without_default(formed)
    missing = [each for each in missing if each.default]
    done = [f"line {repair.line}: mended: {repair}" for repair in repairs]
    done += [f"line {each.line}: {each.name} got the default {each.default}" for each in missing]
    return _with_defaults(formed, missing), done


def fix_bytes(data: bytes, encoding: str) -> tuple[bytes, list[str]]:
    """The bytes of a DBC file mended, in the same encoding but without a byte order mark."""
    text, done = fix_dbc(raw_text(data, encoding))
    return text.encode("utf-8" if encoding == "utf-8-sig" else encoding), done


def raw_text(data: bytes, encoding: str) -> str:
    """The bytes as text with the byte order mark and the line breaks that they have.

    Raises `UnicodeDecodeError` where the encoding is another.
    """
    return data.decode("utf-8" if encoding == "utf-8-sig" else encoding)


def repair_form(text: str) -> tuple[str, list[Repair]]:
    """The text with every line in its usual form, and what was mended, each fault once."""
    repairs: list[Repair] = []
    if text.startswith("\ufeff"):
        text = text.lstrip("\ufeff")
        repairs.append(Repair(1, "a byte order mark"))
    lines = list(_lines(text))
    changed: dict[str, list[int]] = {}
    formed: list[str] = []
    for line in lines:
        mended = line.text
        for fault, mend in _MENDERS.items():
            before, mended = mended, mend(mended, line.bare)
            if mended != before:
                changed.setdefault(fault, []).append(line.number)
        if line.end not in ("\r\n", ""):
            changed.setdefault("not CRLF at the end of the line", []).append(line.number)
        formed.append(mended)
    if UNFINISHED_CODES.search(text):
        last = max(index for index, each in enumerate(formed) if each)
        formed[last] += " ;"
        changed["no semicolon at the end of the file"] = [lines[last].number]
    if lines and not lines[-1].end:
        changed.setdefault("no line break at the end of the file", []).append(lines[-1].number)
    for fault, numbers in changed.items():
        repairs.append(Repair(numbers[0], fault, len(numbers)))
    return "".join(f"{each}\r\n" for each in formed), sorted(repairs, key=lambda each: each.line)


def _lines(text: str) -> Iterator[_Line]:
    bare = _bare(text)
    start, number = 0, 1
    for match in (*_BREAK.finditer(bare), None):
        stop = match.start() if match else len(text)
        end = match.group() if match else ""
        if match or stop > start:
            yield _Line(text[start:stop], bare[start:stop], end, number)
        number += text.count("\n", start, stop + len(end))
        start = stop + len(end)


def _bare(text: str) -> str:
    """The text with NULs in place of texts in quotes and of comments."""
    return _HIDDEN.sub(lambda match: _HIDDEN_CHARACTER * len(match.group()), text)


def _trimmed(text: str, _: str) -> str:
    return text.rstrip(" \t")


_SIGNAL = re.compile(
    r"""\s*SG_\s+(?P<name>\w+)(?:\s+(?P<mux>m\d+M?|M))?\s*:\s*
    (?P<start>\d+)\s*\|\s*(?P<length>\d+)\s*@\s*(?P<order>[01])\s*(?P<sign>[+-])\s*
    \(\s*(?P<factor>[^\s,()]+)\s*,\s*(?P<offset>[^\s,()]+)\s*\)\s*
    \[\s*(?P<low>[^\s|\[\]]+)\s*\|\s*(?P<high>[^\s|\[\]]+)\s*\]\s*
    (?P<unit>"(?:\\"|[^"])*")\s*(?P<receivers>\w+(?:\s*,\s*\w+)*)\s*""",
    re.VERBOSE,
)
_MESSAGE = re.compile(r"\s*BO_\s+(\d+)\s+(\w+)\s*:\s*(\d+)\s+(\w+)\s*")
_VALUES = re.compile(r"(\s*VAL(?:_TABLE)?_\s.*?)\s*;\s*", re.DOTALL)


def _signal(text: str, _: str) -> str:
    """One space before SG_ and around the colon, none inside brackets and receiver lists."""
    match = _SIGNAL.fullmatch(text)
    if match is None:
        return text
    part: Mapping[str, str] = match.groupdict(default="")
    mux = f" {part['mux']}" if part["mux"] else ""
    receivers = "".join(part["receivers"].split())
    return (
        f" SG_ {part['name']}{mux} : {part['start']}|{part['length']}@{part['order']}{part['sign']}"
        f" ({part['factor']},{part['offset']}) [{part['low']}|{part['high']}]"
        f" {part['unit']} {receivers}"
    )


def _message(text: str, _: str) -> str:
    return _MESSAGE.sub(r"BO_ \1 \2: \3 \4", text) if _MESSAGE.fullmatch(text) else text


def _values(text: str, bare: str) -> str:
    """One space before the semicolon, where this line has the whole statement and no other."""
    if bare.count(";") != 1 or not bare.rstrip().endswith(";"):
        return text
    match = _VALUES.fullmatch(text)
    return f"{match.group(1)} ;" if match else text


_MENDERS: dict[str, Callable[[str, str], str]] = {
    "blanks at the end of the line": _trimmed,
    "unusual spacing of SG_": _signal,
    "unusual spacing of BO_": _message,
    "not one space before the semicolon of values": _values,
}
"""What is mended in each line, in this order, from its text and the same without quoted texts."""

_DEFINITION = re.compile(
    r'^[ \t]*BA_DEF_[ \t]+(?:(BU_|BO_|SG_|EV_)[ \t]+)?"(\w+)"[ \t]+(\w+)([^;]*);', re.MULTILINE
)
_DEFAULT = re.compile(r'^[ \t]*BA_DEF_DEF_[ \t]+"(\w+)"[^;"]*(?:"[^"]*")?[^;"]*;', re.MULTILINE)
_VALUE = re.compile(
    r'^[ \t]*BA_[ \t]+"(\w+)"[ \t]+(?:BU_[ \t]+(\w+)|BO_[ \t]+(\d+)|SG_[ \t]+(\d+[ \t]+\w+))?',
    re.MULTILINE,
)
_BLOCK = re.compile(r"^[ \t]*BO_[ \t]+(\d+)[ \t]+(\w+)|^[ \t]*SG_[ \t]+(\w+)", re.MULTILINE)
_NODES = re.compile(r"^[ \t]*BU_[ \t]*:([^\r\n]*)", re.MULTILINE)
_UNASSIGNED = "VECTOR__INDEPENDENT_SIG_MSG"
_ZERO_IS_NONE = """
    GenMsgCycleTime GenMsgCycleTimeFast GenMsgDelayTime GenMsgStartDelayTime
    GenMsgNrOfRepetition GenSigStartValue
"""
"""Attributes whose 0 says as much as no value."""


def attributes_without_default(text: str) -> list[Undefaulted]:
    """The attributes that are defined without a BA_DEF_DEF_, in their order."""
    bare = _bare(text)
    given = {match.group(1) for match in _matches(_DEFAULT, text, bare)}
    objects, values = _objects(text, bare), _objects_with_value(text, bare)
    found = {
        match.group(2): Undefaulted(
            name=match.group(2),
            line=text.count("\n", 0, match.start()) + 1,
            default=_certain_default(
                match, unused=objects[match.group(1) or ""] <= values.get(match.group(2), set())
            ),
        )
        for match in _matches(_DEFINITION, text, bare)
        if match.group(2) not in given
    }
    return list(found.values())


def _matches(pattern: re.Pattern[str], text: str, bare: str) -> Iterator[re.Match[str]]:
    """The matches that do not begin inside a text or a comment."""
    for match in pattern.finditer(text):
        if bare[match.start()] != _HIDDEN_CHARACTER:
            yield match


def _objects(text: str, bare: str) -> dict[str, set[str]]:
    """By the keyword of BA_DEF_, what can have a value; environment variables are not counted."""
    nodes = {name for match in _matches(_NODES, text, bare) for name in match.group(1).split()}
    objects = {"": {""}, "BU_": nodes, "BO_": set[str](), "SG_": set[str](), "EV_": {"?"}}
    message = ""
    for match in _matches(_BLOCK, text, bare):
        identifier, name, signal = match.groups()
        if signal:
            objects["SG_"].add(f"{message} {signal}")
        else:
            message = identifier
            objects["BO_"] |= {identifier} - ({identifier} if name == _UNASSIGNED else set[str]())
    return objects


def _objects_with_value(text: str, bare: str) -> dict[str, set[str]]:
    """By attribute, what has a value of its own."""
    values: dict[str, set[str]] = {}
    for match in _matches(_VALUE, text, bare):
        name, node, message, signal = match.groups(default="")
        values.setdefault(name, set()).add(node or message or " ".join(signal.split()))
    return values


def _certain_default(match: re.Match[str], *, unused: bool) -> str:
    """The default of a definition, "" where objects would get a value that nobody gave them."""
    _, name, kind, rest = match.groups()
    if kind == "STRING":
        return '""'
    if kind == "ENUM":
        first = re.search(r'"[^"]*"', rest)
        return first.group() if first and unused else ""
    if name in _ZERO_IS_NONE.split() or unused:
        limits = [Decimal(each) for each in re.findall(r"[+-]?\d+(?:\.\d+)?(?![\d.eE])", rest)]
        return _nearest_to_zero(limits)
    return ""


def _nearest_to_zero(limits: list[Decimal]) -> str:
    """0 where it is within the limits, else the nearer limit."""
    if len(limits) != 2 or limits[0] >= limits[1]:
        return "0"
    return str(min(max(Decimal(0), limits[0]), limits[1]))


def _with_defaults(text: str, missing: list[Undefaulted]) -> str:
    """The text with a BA_DEF_DEF_ line for each, behind those that there are."""
    if not missing:
        return text
    bare = _bare(text)
    last = [*_matches(_DEFINITION, text, bare), *_matches(_DEFAULT, text, bare)][-1]
    stop = text.index("\n", last.end()) + 1
    lines = "".join(f'BA_DEF_DEF_  "{each.name}" {each.default};\r\n' for each in missing)
    return f"{text[:stop]}{lines}{text[stop:]}"
