"""A line parser for DBC files in the one shape that the design allows; it knows no other."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from decimal import Decimal

_NAME = r"[A-Za-z_][A-Za-z0-9_]*"
_NUMBER = r"-?\d+(?:\.\d+)?"
_TEXT = r'"[^"]*"'
_CODES = rf"(?:\d+ {_TEXT} )+"

SECTIONS = (
    "VERSION",
    "NS_",
    "BS_",
    "BU_",
    "VAL_TABLE_",
    "BO_",
    "CM_",
    "BA_DEF_",
    "BA_DEF_DEF_",
    "BA_",
    "VAL_",
    "SIG_VALTYPE_",
)
"""The order of the sections; BO_ and SG_ are one."""

LINES = {
    "VERSION": r'VERSION ""',
    "NS_": r"NS_ :",
    "BS_": r"BS_:",
    "BU_": rf"BU_:(?P<nodes>(?: {_NAME})*)",
    "VAL_TABLE_": rf"VAL_TABLE_ (?P<name>{_NAME}) (?P<codes>{_CODES});",
    "BO_": rf"BO_ (?P<id>\d+) (?P<name>{_NAME}): (?P<length>\d+) (?P<sender>{_NAME})",
    "SG_": (
        rf" SG_ (?P<name>{_NAME}) : (?P<start>\d+)\|(?P<length>\d+)@(?P<order>[01])(?P<sign>[+-])"
        rf" \((?P<factor>{_NUMBER}),(?P<offset>{_NUMBER})\)"
        rf" \[(?P<minimum>{_NUMBER})\|(?P<maximum>{_NUMBER})\]"
        rf' "(?P<unit>[^"]*)" (?P<receivers>{_NAME}(?:,{_NAME})*)'
    ),
    "CM_": (
        rf"CM_ (?:BU_ (?P<node>{_NAME}) |BO_ (?P<message>\d+) "
        rf'|SG_ (?P<owner>\d+) (?P<signal>{_NAME}) )?"(?P<text>[^"]*)";'
    ),
    "BA_DEF_": (
        rf'BA_DEF_ (?P<on>(?:(?:BU|BO|SG)_ )?) "(?P<name>{_NAME})" '
        rf"(?P<type>INT -?\d+ -?\d+|STRING|ENUM (?P<words>{_TEXT}(?:,{_TEXT})*)) ;"
    ),
    "BA_DEF_DEF_": rf'BA_DEF_DEF_  "(?P<name>{_NAME})" (?P<value>-?\d+|{_TEXT});',
    "BA_": (
        rf'BA_ "(?P<name>{_NAME})" (?:BU_ (?P<node>{_NAME}) |BO_ (?P<message>\d+) '
        rf"|SG_ (?P<owner>\d+) (?P<signal>{_NAME}) )?(?P<value>-?\d+|{_TEXT});"
    ),
    "VAL_": rf"VAL_ (?P<id>\d+) (?P<name>{_NAME}) (?P<codes>{_CODES});",
}
"""The whole of each kind of line, to the last space."""


@dataclass(frozen=True)
class Line:
    """A line: its kind, its text, and the parts of it by name."""

    kind: str
    text: str
    parts: dict[str, str]


@dataclass(frozen=True)
class SignalLine:
    """A SG_ line with its values."""

    message: int
    name: str
    length: int
    signed: bool
    factor: Decimal
    offset: Decimal
    minimum: Decimal
    maximum: Decimal
    unit: str
    receivers: tuple[str, ...]

    @property
    def raw_limits(self) -> tuple[int, int]:
        """The smallest and the largest value that the bits can hold."""
        half = 1 << (self.length - 1)
        return (-half, half - 1) if self.signed else (0, 2 * half - 1)


@dataclass(frozen=True)
class Dbc:
    """A DBC file as its lines; raises `ValueError` for a line of another shape."""

    name: str
    data: bytes
    encoding: str
    lines: list[Line] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "lines", list(_lines(self.text)))

    @property
    def text(self) -> str:
        """The whole text."""
        return self.data.decode(self.encoding)

    def of(self, kind: str) -> list[dict[str, str]]:
        """The parts of all lines of a kind."""
        return [line.parts for line in self.lines if line.kind == kind]

    @property
    def nodes(self) -> list[str]:
        """The nodes of the BU_ line."""
        return self.of("BU_")[0]["nodes"].split()

    @property
    def signals(self) -> list[SignalLine]:
        """All signals, with the identifier of the message above them."""
        found: list[SignalLine] = []
        message = 0
        for line in self.lines:
            if line.kind == "BO_":
                message = int(line.parts["id"])
            elif line.kind == "SG_":
                found.append(_signal(message, line.parts))
        return found

    def values(self, attribute: str) -> dict[str, str]:
        """The values of an attribute by the object that has them: node, identifier, signal."""
        return {
            " ".join(parts[key] for key in ("node", "message", "owner", "signal") if parts[key]): (
                parts["value"].strip('"')
            )
            for parts in self.of("BA_")
            if parts["name"] == attribute
        }


def codes(text: str) -> list[tuple[int, str]]:
    """The codes and labels of a value line."""
    return [(int(code), label) for code, label in re.findall(r'(\d+) "([^"]*)"', text)]


def _signal(message: int, parts: dict[str, str]) -> SignalLine:
    return SignalLine(
        message=message,
        name=parts["name"],
        length=int(parts["length"]),
        signed=parts["sign"] == "-",
        factor=Decimal(parts["factor"]),
        offset=Decimal(parts["offset"]),
        minimum=Decimal(parts["minimum"]),
        maximum=Decimal(parts["maximum"]),
        unit=parts["unit"],
        receivers=tuple(parts["receivers"].split(",")),
    )


def _lines(text: str) -> Iterator[Line]:
    for number, line in enumerate(text.removesuffix("\r\n").split("\r\n"), start=1):
        if not line:
            continue
        if re.fullmatch(r"\t[A-Z_]+_|\tFILTER", line):
            yield Line("NS_", line, {})
            continue
        word = line.split()[0].rstrip(":")
        found = re.fullmatch(LINES[word], line) if word in LINES else None
        if found is None:
            raise ValueError(f"line {number} has not the shape of its kind: {line!r}")
        yield Line(word, line, {key: value or "" for key, value in found.groupdict().items()})
