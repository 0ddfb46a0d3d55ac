"""What `swapcan.logs` offers, and what it does not import before it is used."""

from __future__ import annotations

import ast
import subprocess
import sys
from importlib.util import resolve_name
from pathlib import Path

import pytest

from swapcan import logs


def test_the_stub_gives_every_public_name_its_type() -> None:
    source = Path(logs.__file__).with_suffix(".pyi").read_text(encoding="utf-8")
    homes = {
        alias.name: node.module
        for node in ast.parse(source).body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert homes == {
        name: resolve_name(home, "swapcan.logs") for name, home in vars(logs)["_HOMES"].items()
    }


def test_every_public_name_is_there() -> None:
    for name in dir(logs):
        assert getattr(logs, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        getattr(logs, "nonsense")  # noqa: B009  (the stub knows no such name)


def test_the_command_line_starts_without_what_is_an_extra() -> None:
    program = (
        "import sys\n"
        "sys.modules['asammdf'] = None  # python-can imports it where it is installed\n"
        "import swapcan.cli, typedcan.commands.convert, swapcan.logs\n"
        "print({'numpy', 'pyarrow', 'pandas'} & {n for n in sys.modules})"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], check=True, capture_output=True, text=True
    )
    assert done.stdout.strip() == "set()"
