"""Every dbcspec command that docs/ci.md shows is one that the command line accepts."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from dbcspec.cli import PROGRAM

GUIDE = (Path(__file__).parents[2] / "docs" / "ci.md").read_text("utf-8")
GUIDE = GUIDE.replace("$accepted", "--approvals approvals.toml")  # as the guide sets it
GUIDE = re.sub(r"\\\n *", "", GUIDE)
COMMANDS = sorted(
    set(re.findall(r"^ *(?:- )?(?:run: )?(dbcspec .+?)(?: \|\| .*)?$", GUIDE, re.MULTILINE))
)


def test_the_guide_shows_commands() -> None:
    assert len(COMMANDS) > 8


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_of_the_guide_is_accepted(command: str) -> None:
    options = PROGRAM.parser().parse_args(shlex.split(command)[1:])
    assert callable(options.run)
