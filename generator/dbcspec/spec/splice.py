"""Changes to a YAML text at exact places: what is not changed stays, byte for byte."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence

import yaml

from dbcspec.errors import SpecError
from dbcspec.spec.source import Scalar, Table, compose
from typedcan.model.errors import Location

_BOM = b"\xef\xbb\xbf"


def scalar(text: str) -> str:
    """Text as a YAML scalar that reads back the same here, in a line or in a flow mapping."""
    if text.strip() == text and text and "\n" not in text:
        try:
            node = compose(f"{{key: {text}}}\n", "")
            line = compose(f"key: {text}\n", "")
        except SpecError:
            node = line = Scalar(Location(""), "")
        if _only_value(node) == _only_value(line) == text:
            return text
    return json.dumps(text, ensure_ascii=False)


def flow(entries: Mapping[int, str]) -> str:
    """A flow mapping of codes and labels."""
    return f"{{{', '.join(f'{code}: {scalar(label)}' for code, label in entries.items())}}}"


def _only_value(node: object) -> str | None:
    if isinstance(node, Table) and len(node.entries) == 1:
        value = node.entries[0][1]
        return value.text if isinstance(value, Scalar) else None
    return None


class YamlText:
    """One file, and the changes to it.

    Paths lead through mappings by key and through lists by index. A path that does not exist
    raises `KeyError`.
    """

    def __init__(self, data: bytes) -> None:
        self._bom = data.startswith(_BOM)
        self._text = data.removeprefix(_BOM).decode("utf-8")
        self._end_of_line = "\r\n" if "\r\n" in self._text else "\n"
        # Not the C loader: its marks do not count as Python's strings do.
        self._root = yaml.compose(self._text, Loader=yaml.SafeLoader)
        self._edits: list[tuple[int, int, int, str]] = []

    @property
    def is_changed(self) -> bool:
        """Whether there is anything to change."""
        return bool(self._edits)

    def result(self) -> bytes:
        """The file with all changes made."""
        text = self._text
        for start, _, end, new in sorted(self._edits, reverse=True):
            text = text[:start] + new.replace("\n", self._end_of_line) + text[end:]
        return _BOM * self._bom + text.encode("utf-8")

    def set(self, path: Sequence[str | int], key: str, value: str, order: Sequence[str]) -> None:
        """Give a key of a mapping a value, written as YAML.

        A key that is not there yet is put after the last present one that ``order`` has before
        it.
        """
        mapping = self._mapping(path)
        present = {name.value: node for name, node in mapping.value}
        if key in present:
            self._replace(present[key], value)
            return
        before = [name for name in order[: order.index(key)] if name in present]
        anchor = present[before[-1]] if before else mapping.value[-1][1]
        self._insert_after(anchor, mapping, f"{key}: {value}")

    def set_codes(
        self, path: Sequence[str | int], key: str, codes: Mapping[int, str], order: Sequence[str]
    ) -> None:
        """Give a key a mapping of codes to labels, changing single labels where that is enough."""
        present = {name.value: node for name, node in self._mapping(path).value}
        node = present.get(key)
        if node is None:
            if codes:
                self.set(path, key, flow(codes), order)
            return
        entries = self._codes(node)
        if not entries or entries.keys() - codes.keys():
            self._replace(node, flow(codes))
            return
        for code, label in codes.items():
            if code in entries:
                if entries[code].value != label:
                    self._replace(entries[code], scalar(label))
                continue
            separator = ", " if node.flow_style else f"\n{self._indent(node)}"
            smaller = [other for other in entries if other < code]
            if smaller:
                self._insert_after(entries[max(smaller)], node, f"{code}: {scalar(label)}")
            else:
                first = node.value[0][0].start_mark.index
                self._insert(first, f"{code}: {scalar(label)}{separator}")

    def reference(self, path: Sequence[str | int], key: str) -> str | None:
        """The row that a key refers to by ``same_as``, None where it has values of its own."""
        node = {name.value: node for name, node in self._mapping(path).value}.get(key)
        if isinstance(node, yaml.MappingNode):
            for name, value in node.value:
                if name.value == "same_as":
                    return str(value.value)
        return None

    def append(self, path: Sequence[str | int], item: Mapping[str, str]) -> None:
        """Append a mapping to a list, in the style of the list's last item."""
        items = self._node(path)
        assert isinstance(items, yaml.SequenceNode)
        last = items.value[-1]
        if items.flow_style:
            inner = ", ".join(f"{key}: {value}" for key, value in item.items())
            self._insert(self._end(last), f", {{{inner}}}")
            return
        indent = " " * items.start_mark.column
        if last.flow_style:
            inner = ", ".join(f"{key}: {value}" for key, value in item.items())
            text = f"- {{{inner}}}"
        else:
            pairs = (f"{key}: {value}".replace(": \n", ":\n", 1) for key, value in item.items())
            text = "- " + f"\n{indent}  ".join(pairs)
        self._insert(self._line_end(self._end(last)), f"\n{indent}{text}")

    def _codes(self, node: yaml.Node) -> dict[int, yaml.Node]:
        """The codes of a mapping with their label nodes; none where it refers to another row."""
        assert isinstance(node, yaml.MappingNode)
        return {int(name.value, 0): value for name, value in node.value if name.value != "same_as"}

    def _mapping(self, path: Sequence[str | int]) -> yaml.MappingNode:
        node = self._node(path)
        if not isinstance(node, yaml.MappingNode):
            raise KeyError(path)
        return node

    def _node(self, path: Sequence[str | int]) -> yaml.Node:
        node: yaml.Node | None = self._root
        for step in path:
            if isinstance(node, yaml.SequenceNode) and isinstance(step, int):
                node = node.value[step]
            elif isinstance(node, yaml.MappingNode):
                node = {name.value: value for name, value in node.value}[step]
            else:
                raise KeyError(step)
        if node is None:
            raise KeyError(path)
        return node

    def _replace(self, node: yaml.Node, value: str) -> None:
        start, end = node.start_mark.index, self._end(node)
        if self._text[start:end] != value:
            self._edits.append((start, len(self._edits), end, value))

    def _insert_after(self, value: yaml.Node, mapping: yaml.MappingNode, entry: str) -> None:
        """A new entry of a mapping behind a value of it, and behind the comment in its line."""
        end = self._end(value)
        if mapping.flow_style:
            self._insert(end, f", {entry}")
        else:
            self._insert(self._line_end(end), f"\n{self._indent(mapping)}{entry}")

    def _insert(self, at: int, text: str) -> None:
        self._edits.append((at, len(self._edits), at, text))

    def _end(self, node: yaml.Node) -> int:
        """Where the text of a node ends; PyYAML counts the space behind blocks with them."""
        if isinstance(node, yaml.CollectionNode) and not node.flow_style and node.value:
            last = node.value[-1]
            return self._end(last[1] if isinstance(last, tuple) else last)
        start, end = node.start_mark.index, node.end_mark.index
        return start + len(self._text[start:end].rstrip())

    def _line_end(self, index: int) -> int:
        """The end of the line, behind a comment that stands in it."""
        match = re.compile(r"[^\r\n]*").match(self._text, index)
        return match.end() if match else index

    def _indent(self, mapping: yaml.MappingNode) -> str:
        first: yaml.Node = mapping.value[0][0]
        return " " * first.start_mark.column
