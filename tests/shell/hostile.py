"""Texts that a terminal would obey, and what may be seen of them."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import unicodedata
from collections.abc import Sequence
from pathlib import Path

import pytest

NAME = "a\x1b]0;PWN\x07\x1b[2J\r\nforged line\u202e\x9b\udcff"
"""A file name: sets the title, clears the screen, begins a line, turns texts, is no text at all."""

HIDDEN = frozenset({"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"})
"""Categories of Unicode whose characters nobody sees."""

needs_any_file_name = pytest.mark.skipif(
    sys.platform in ("win32", "darwin"), reason="names of files have no such characters here"
)


def hidden(text: str) -> list[str]:
    """The characters of a text that must not reach a terminal."""
    return [each for each in text if each != "\n" and unicodedata.category(each) in HIDDEN]


def esc_dbc(path: Path, *changed: tuple[bytes, bytes]) -> Path:
    """A copy of the DBC whose unit, comments and labels hold control sequences."""
    shutil.copy(Path(__file__).parent / "esc.dbc", path)
    for old, new in changed:
        path.write_bytes(path.read_bytes().replace(old, new))
    return path


# Many commands in one process, since starting one takes longer than most of them.
_PROGRAM = """
import json, sys
from importlib import import_module
cli, (_, package, commands) = import_module(f"{sys.argv[1]}.cli"), sys.argv
for words in json.loads(commands):
    try:
        cli.run(words)
    except SystemExit:
        pass
    print(end="\\f", flush=True)
"""


def printed(folder: Path, package: str, *commands: Sequence[str]) -> list[str]:
    """All that each command prints to both streams, every byte looked at; no traceback."""
    done = subprocess.run(
        [
            sys.executable,
            "-X",
            "utf8",
            "-W",
            "default",
            "-c",
            _PROGRAM,
            package,
            json.dumps(commands),
        ],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=120,
        check=False,
    )
    texts = done.stdout.decode("utf-8").split("\f")
    assert (len(texts), texts.pop()) == (len(commands) + 1, "")
    for text in texts:
        assert hidden(text) == [], text
        assert [line for line in text.split("\n") if line.startswith("forged")] == [], text
        assert "Traceback" not in text, text
    return texts
