"""The house rules that a reader relies on and no linter checks."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = [
    path
    for folder in ("src", "generator")
    for path in sorted((ROOT / folder).rglob("*.py"))
    if "_generated" not in path.parts
]
LONGEST_FILE = 300
LONGEST_FUNCTION = 60


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: path.stem)
def test_a_source_file_is_short_and_says_what_it_is_for(path: Path) -> None:
    text = path.read_text("utf-8")
    tree = ast.parse(text)
    assert ast.get_docstring(tree)
    assert len(text.splitlines()) <= LONGEST_FILE
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            assert (node.end_lineno or 0) - node.lineno < LONGEST_FUNCTION, node.name


def test_the_toolchain_knows_no_name_of_this_standard() -> None:
    names = re.compile(r"B2V|V2B|B2C|C2B|CAAMTB|\bBMU\b|\bVCU\b", re.IGNORECASE)
    docs_and_examples = re.compile(r'""".*?"""|#.*|show B2V_ST2|route such as BMU>VCU', re.DOTALL)
    found = {
        path.name: names.findall(docs_and_examples.sub("", path.read_text("utf-8")))
        for path in (ROOT / "generator").rglob("*.py")
    }
    assert {name: hits for name, hits in found.items() if hits} == {}


def test_generator_is_a_source_root_and_no_package() -> None:
    assert not (ROOT / "generator" / "__init__.py").exists()


def test_no_file_is_a_symbolic_link() -> None:
    kept = ("src", "generator", "spec", "dbc", "tests")
    assert [str(p) for folder in kept for p in (ROOT / folder).rglob("*") if p.is_symlink()] == []
