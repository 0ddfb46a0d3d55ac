"""The house rules that a reader relies on and no linter checks."""

from __future__ import annotations

import ast
import json
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


def test_nothing_is_printed_but_by_the_functions_that_make_it_printable() -> None:
    """`print`, and whatever is given or told to write to a stream, stand in one package alone."""
    found = [
        f"{path.relative_to(ROOT).as_posix()}:{node.lineno}: {ast.unparse(node)}"
        for path in SOURCES
        if path.parent != ROOT / "src" / "typedcan" / "shell"
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Call) and _prints(node)
    ]
    assert found == []


def _prints(call: ast.Call) -> bool:
    function = ast.unparse(call.func)
    if function == "print" or re.search(r"\bstd(out|err)\b.*\.write(lines)?$", function):
        return True
    given = (ast.unparse(each) for each in (*call.args, *(word.value for word in call.keywords)))
    is_stream = any(re.fullmatch(r"sys\.std(out|err)(\.buffer)?", each) for each in given)
    return is_stream and function not in ("isinstance", "parser.print_help")


@pytest.mark.parametrize(
    ("code", "prints"),
    [
        ("print(x)", True),
        ("print(x, file=sys.stderr)", True),
        ("sys.stdout.write(x)", True),
        ("sys.stderr.buffer.write(x)", True),
        ("stdout.writelines(x)", True),
        ("json.dump(x, sys.stdout)", True),
        ("csv.writer(sys.stdout)", True),
        ("sys.stdout.isatty()", False),
        ("parser.print_help(sys.stderr)", False),
        ("file.write(x)", False),
    ],
)
def test_what_prints_is_told_from_what_does_not(code: str, *, prints: bool) -> None:
    (call,) = (node for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Call))
    assert _prints(call) is prints


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


# What serves any CAN protocol: no message, signal or node of this standard is named there.
_SHIPPED = {".py", ".j2", ".js", ".css", ".tcss", ".html", ".json"}
_LONG = 8
"""A shorter title may be any word."""


def test_what_serves_any_protocol_names_nothing_of_this_one() -> None:
    document = json.loads((ROOT / "src/swapcan/_generated/protocol.json").read_text("utf-8"))
    files = [
        path
        for folder in (ROOT / "src/typedcan", ROOT / "generator")
        for path in folder.rglob("*")
        if path.suffix in _SHIPPED and path.is_file()
    ]
    titled = [
        document,
        *document["nodes"],
        *(each for message in document["messages"] for each in (message, *message["signals"])),
    ]
    titles = {each.get(key, "") for each in titled for key in ("title", "english")}
    titles = {title for title in titles if len(title) >= _LONG} - {"Frame number"}
    assert len(titles) > 300
    names = {node["name"] for node in document["nodes"]} | {
        named["name"]
        for message in document["messages"]
        for named in (message, *message["signals"])
    }
    assert len(names) > 200
    assert len(files) > 500
    word = re.compile(rf"(?<!\w)({'|'.join(map(re.escape, names))})(?!\w)")
    assert [
        f"{path.relative_to(ROOT)}: {found}"
        for path in files
        for text in [path.read_text("utf-8")]
        for found in (*word.findall(text), *(title for title in titles if title in text))
    ] == []


def test_the_thin_runtime_stays_thin() -> None:
    files = (ROOT / "src" / "typedcan" / "wire").glob("*.py")
    assert sum(len(path.read_text("utf-8").splitlines()) for path in files) < 2_000
