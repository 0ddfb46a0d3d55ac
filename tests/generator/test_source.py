"""YAML becomes located text, and everything that is not plain YAML is a fault with its place."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dbcspec.errors import SpecError
from dbcspec.spec.source import Items, Node, Scalar, Table, compose, read_yaml


def faults(text: str) -> list[str]:
    with pytest.raises(SpecError) as caught:
        compose(text, "spec/t.yaml")
    return [str(fault) for fault in caught.value.faults]


def plain(node: Node) -> object:
    """The node as lists, dicts and text."""
    match node:
        case Scalar():
            return node.text
        case Items():
            return [plain(child) for child in node.nodes]
        case Table():
            return {key.text: plain(value) for key, value in node.entries}


def test_scalars_stay_the_text_that_stands_there() -> None:
    text = "codes: {0: OFF, 1: NO}\nmask: 0x1F\nyear: 2024-01-01\nnumber: 1e3\nnull: ~\nempty:\n"
    assert plain(compose(text, "t")) == {
        "codes": {"0": "OFF", "1": "NO"},
        "mask": "0x1F",
        "year": "2024-01-01",
        "number": "1e3",
        "null": "~",
        "empty": "",
    }


def test_quoted_and_folded_text_is_read_as_yaml_has_it() -> None:
    text = "a: \"x: y\"\nb: 'it''s'\nc: >-\n  one\n  two\nd: [1, two]\n"
    expected = {"a": "x: y", "b": "it's", "c": "one two", "d": ["1", "two"]}
    assert plain(compose(text, "t")) == expected


def test_every_node_knows_its_line_and_column() -> None:
    node = compose("rows:\n  - no: 1\n    codes: {0: OFF}\n", "spec/t.yaml")
    assert isinstance(node, Table)
    (_, rows) = node.entries[0]
    assert isinstance(rows, Items)
    row = rows.nodes[0]
    assert isinstance(row, Table)
    key, codes = row.entries[1]
    assert isinstance(codes, Table)
    assert str(row.where) == "spec/t.yaml:2:5"
    assert str(key.where) == "spec/t.yaml:3:5"
    assert str(codes.entries[0][1].where) == "spec/t.yaml:3:16"


def test_a_byte_order_mark_and_dos_line_ends_do_no_harm(tmp_path: Path) -> None:
    path = tmp_path / "t.yaml"
    path.write_bytes("\ufeffa: 1\r\nb: 温度\r\n".encode())
    node = read_yaml(path, "t.yaml")
    assert plain(node) == {"a": "1", "b": "温度"}
    assert isinstance(node, Table)
    assert str(node.entries[0][0].where) == "t.yaml:1:1"


def test_every_tab_is_a_fault_even_where_yaml_allows_it() -> None:
    assert faults('a:\n\t- b\nc: "x\ty"\n') == [
        "spec/t.yaml:2:1: tab character: use spaces",
        "spec/t.yaml:3:6: tab character: use spaces",
    ]


def test_a_key_that_stands_twice_is_a_fault_at_its_second_place() -> None:
    assert faults("a: 1\nb: {c: 1, c: 2}\na: 3\n") == [
        "spec/t.yaml:2:11: key 'c' stands here twice",
        "spec/t.yaml:3:1: key 'a' stands here twice",
    ]


def test_anchors_and_aliases_are_faults() -> None:
    text = "YAML anchors and aliases are not used here"
    assert faults("a: &x 1\nb: *x\n") == [f"spec/t.yaml:1:4: {text}", f"spec/t.yaml:2:4: {text}"]
    assert faults("a: {<<: *base}\n") == [f"spec/t.yaml:1:9: {text}"]


def test_a_bomb_of_anchors_is_refused_before_it_unfolds() -> None:
    levels = [f"l{n}: &l{n} [{', '.join([f'*l{n - 1}'] * 9)}]" for n in range(1, 30)]
    assert "anchors" in faults("\n".join(["l0: &l0 x", *levels]))[0]


@pytest.mark.parametrize("tag", ["!!str", "!!python/object:os.system", "!mine", "!"])
def test_tags_are_faults(tag: str) -> None:
    (fault,) = faults(f"a: {tag} x\n")
    assert fault.startswith("spec/t.yaml:1:4: YAML tag ")


def test_a_key_that_is_a_list_is_a_fault() -> None:
    assert faults("? [a, b]\n: 1\n") == ["spec/t.yaml:1:3: a key must be plain text"]


@pytest.mark.parametrize("text", ["", "# only a comment\n", "\n\n"])
def test_an_empty_file_is_a_fault(text: str) -> None:
    assert faults(text) == ["spec/t.yaml:1:1: the file is empty"]


def test_a_second_document_is_a_fault_where_it_begins() -> None:
    assert faults("a: 1\n---\nb: 2\n") == [
        "spec/t.yaml:2:1: a second document begins: one file holds one"
    ]


@pytest.mark.parametrize("depth", [41, 1000, 200_000])
@pytest.mark.parametrize(
    ("opening", "column"), [("[", 41), ("[ ", 81), ("{a: ", 161), ("- ", 81), ("? ", 81)]
)
def test_text_nested_too_deeply_is_a_fault_where_it_is_and_no_crash(
    opening: str, column: int, depth: int
) -> None:
    assert faults(opening * depth) == [f"spec/t.yaml:1:{column}: nested too deeply"]


def test_text_nested_too_deeply_over_many_lines_is_a_fault_in_its_line() -> None:
    assert faults("a: 1\nb:" + "\n [" * 2000) == ["spec/t.yaml:42:2: nested too deeply"]


def test_text_nested_as_deeply_as_is_allowed_is_read() -> None:
    node = plain(compose("[" * 40 + "x" + "]" * 40, "t"))
    for _ in range(40):
        assert isinstance(node, list)
        (node,) = node
    assert node == "x"


@pytest.mark.parametrize(
    ("text", "place"),
    [("a: b: c\n", "1:5"), ("a: [1, 2\n", "2:1"), ("a: 'x\n", "2:1"), ("a: 1\n b: 2\n", "2:3")],
)
def test_broken_yaml_is_a_fault_with_its_place(text: str, place: str) -> None:
    (fault,) = faults(text)
    assert fault.startswith(f"spec/t.yaml:{place}: not YAML: ")


@pytest.mark.parametrize("code", [0, 7, 0x1B, 0x7F, 0x80, 0x9F, 0xFFFE, 0xFFFF, 0xD800])
def test_a_character_that_no_yaml_has_is_a_fault_with_its_place(code: int) -> None:
    assert faults(f"a: 1\nb: {chr(code)}\n") == [
        f"spec/t.yaml:2:4: not YAML: character U+{code:04X} is not allowed"
    ]


@given(st.characters(exclude_categories=[]), st.sampled_from(["{}", "'{}'", "# {}", "|\n  {}"]))
def test_no_character_raises_anything_else_than_a_fault(character: str, form: str) -> None:
    with suppress(SpecError):
        compose(f"a: {form.format(character)}\n", "t.yaml")


def test_bytes_that_are_not_utf_8_are_a_fault_with_their_place(tmp_path: Path) -> None:
    path = tmp_path / "t.yaml"
    path.write_bytes("a: 1\nb: 温".encode() + "温度".encode("gbk"))
    with pytest.raises(SpecError) as caught:
        read_yaml(path, "spec/t.yaml")
    assert str(caught.value) == "spec/t.yaml:2:5: not UTF-8: byte 0xCE"


def test_a_file_that_cannot_be_read_is_a_fault(tmp_path: Path) -> None:
    for path in (tmp_path / "missing.yaml", tmp_path):
        with pytest.raises(SpecError, match=r"^spec/t\.yaml:1:1: cannot be read: "):
            read_yaml(path, "spec/t.yaml")
