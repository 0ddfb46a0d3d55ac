"""YAML text to located nodes: every scalar stays text and knows its file, line and column.

``yaml.safe_load`` would turn the labels OFF and NO into False, drop repeated keys without a
word and forget where things stood, so only PyYAML's composer is used.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from dbcspec.errors import Fault, SpecError
from typedcan.model.errors import Location

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_DEEPEST = 40
_NOT_YAML = re.compile("[^\t\n\r -~\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_TOO_MANY_OPENED = re.compile(rf"(?:[\[{{]\s*){{{_DEEPEST}}}[\[{{]")


@dataclass(frozen=True, slots=True)
class Scalar:
    """A leaf: its text as written, never converted."""

    where: Location
    text: str


@dataclass(frozen=True, slots=True)
class Items:
    """A sequence of nodes."""

    where: Location
    nodes: tuple[Node, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """A mapping; keys are scalars, unique, in the order of the file."""

    where: Location
    entries: tuple[tuple[Scalar, Node], ...]


Node = Scalar | Items | Table


def read_yaml(path: Path, shown_as: str) -> Node:
    """Read one YAML file into located nodes.

    ``shown_as`` is the path that locations carry. Raises `SpecError` with every fault found,
    for anything that is not one plain YAML document in UTF-8.
    """
    return compose(_decode(path, shown_as), shown_as)


def compose(text: str, shown_as: str) -> Node:
    """Turn YAML text into located nodes; see `read_yaml`."""
    if faults := list(_character_faults(text, shown_as)):
        raise SpecError(faults)
    try:
        faults.extend(_event_faults(text, shown_as))
        root = None if faults else yaml.compose(text, Loader=_LOADER)
    except yaml.MarkedYAMLError as error:
        raise SpecError([_parser_fault(error, text, shown_as)]) from None
    if root is None:
        raise SpecError(faults or [Fault(Location(shown_as), "the file is empty")])
    node = _Converter(shown_as, faults).convert(root)
    if faults:
        raise SpecError(faults)
    return node


def _character_faults(text: str, shown_as: str) -> Iterator[Fault]:
    """The first tab, and the first character that YAML does not allow, of each line."""
    for number, line in enumerate(text.split("\n"), start=1):
        if "\t" in line:
            where = Location(shown_as, number, line.index("\t") + 1)
            yield Fault(where, "tab character: use spaces")
        if found := _NOT_YAML.search(line):
            where = Location(shown_as, number, found.start() + 1)
            yield Fault(where, f"not YAML: character U+{ord(found[0]):04X} is not allowed")


def _parser_fault(error: yaml.MarkedYAMLError, text: str, shown_as: str) -> Fault:
    """Why PyYAML's parser gives up.

    Where many brackets open in a row it may do so before it yields an event of the first.
    """
    if deep := _TOO_MANY_OPENED.search(text):
        before = text[: deep.end() - 1]
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        return Fault(Location(shown_as, line, column), "nested too deeply")
    mark = error.problem_mark or error.context_mark
    where = _place(mark, shown_as) if mark else Location(shown_as)
    return Fault(where, f"not YAML: {error.problem or error.context}")


def _event_faults(text: str, shown_as: str) -> Iterator[Fault]:
    """What YAML allows and the spec does not, found before anything is built from it.

    Composing nests as deeply as the text does, so text that is nested too deeply must not get
    there.
    """
    depth = documents = 0
    for event in yaml.parse(text, Loader=_LOADER):
        where = _place(event.start_mark, shown_as)
        depth += isinstance(event, yaml.CollectionStartEvent)
        depth -= isinstance(event, yaml.CollectionEndEvent)
        documents += isinstance(event, yaml.DocumentStartEvent)
        if depth > _DEEPEST:
            yield Fault(where, "nested too deeply")
            return
        if documents > 1:
            yield Fault(where, "a second document begins: one file holds one")
            return
        if getattr(event, "anchor", None):
            yield Fault(where, "YAML anchors and aliases are not used here")
        if tag := getattr(event, "tag", None):
            yield Fault(where, f"YAML tag {tag} is not used here")


def _place(mark: Any, shown_as: str) -> Location:
    return Location(shown_as, mark.line + 1, mark.column + 1)


def _decode(path: Path, shown_as: str) -> str:
    try:
        data = path.read_bytes()
    except OSError as error:
        raise SpecError.at(Location(shown_as), f"cannot be read: {error.strerror}") from None
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data[: error.start]
        line_start = before.rfind(b"\n") + 1
        column = len(before[line_start:].decode("utf-8", "replace")) + 1
        where = Location(shown_as, before.count(b"\n") + 1, column)
        raise SpecError.at(where, f"not UTF-8: byte 0x{data[error.start]:02X}") from None


class _Converter:
    """PyYAML's nodes to ours; what the spec does not allow becomes a fault."""

    def __init__(self, shown_as: str, faults: list[Fault]) -> None:
        self._shown_as = shown_as
        self._faults = faults

    def convert(self, node: yaml.Node) -> Node:
        where = _place(node.start_mark, self._shown_as)
        if isinstance(node, yaml.MappingNode):
            return Table(where, tuple(self._entries(node)))
        if isinstance(node, yaml.SequenceNode):
            return Items(where, tuple(self.convert(child) for child in node.value))
        return Scalar(where, str(node.value))

    def _entries(self, node: yaml.MappingNode) -> Iterator[tuple[Scalar, Node]]:
        keys: set[str] = set()
        for key_node, value_node in node.value:
            key = self.convert(key_node)
            value = self.convert(value_node)
            if not isinstance(key, Scalar):
                self._faults.append(Fault(key.where, "a key must be plain text"))
            elif key.text in keys:
                self._faults.append(Fault(key.where, f"key {key.text!r} stands here twice"))
            else:
                keys.add(key.text)
                yield key, value
