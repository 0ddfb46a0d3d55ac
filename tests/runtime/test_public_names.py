"""The names of the package: all there, with a type each, and the heavy ones only when used."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import swapcan

STUB = ast.parse(Path(swapcan.__file__).with_suffix(".pyi").read_text("utf-8"))
NAMES = vars(swapcan)["__all__"]


def test_the_stub_has_the_public_names_each_from_where_it_is_defined() -> None:
    homes = {
        alias.name: node.module
        for node in STUB.body
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
    }
    assert sorted(homes) == sorted(NAMES)
    for name, home in homes.items():
        __import__(home)
        assert getattr(swapcan, name) is getattr(sys.modules[home], name)


def test_the_package_lists_its_names_before_they_are_used() -> None:
    program = "import swapcan; print({*swapcan.__all__} <= {*dir(swapcan)}, len(swapcan.__all__))"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == ["True", str(len(NAMES))]
    assert {"PROTOCOL", "Link", "Node", "EncodeError", "decode"} <= {*dir(swapcan)}


def test_there_is_no_other_name() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Nodes'"):
        getattr(swapcan, "Nodes")  # noqa: B009  (the stub knows no such name)


def test_importing_the_package_imports_no_live_node_and_no_extra() -> None:
    program = (
        "import sys, swapcan\n"
        "heavy = {'swapcan.node', 'swapcan.transfer', 'swapcan.simulate', 'numpy', 'textual'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\n"
