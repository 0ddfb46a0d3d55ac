"""A protocol with a transfer of every kind: a fixture, and the transfers that the docs show."""

from __future__ import annotations

import re
import shutil
import tempfile
from functools import cache
from pathlib import Path

from dbcspec.config import Config
from dbcspec.project import Project, load
from typedcan.dynamic import typed_protocol
from typedcan.wire.protocol import Protocol

TESTS = Path(__file__).parents[1]
DOCS = TESTS.parent / "docs" / "transfers.md"
FIXTURE = TESTS / "fixtures" / "transfers"
REQUESTS = """requests:
  - {signal: Ask_Serial, code: 1, withdraw: 2, answers: [SERIAL_1, SERIAL_2]}
  - {signal: Ask_Key, code: 1, withdraw: 2, answers: [KEY]}
"""


def examples() -> list[str]:
    """The transfers that the document shows."""
    return re.findall(r"```yaml\n(.*?)```", DOCS.read_text("utf-8"), re.DOTALL)


def write(folder: Path) -> Path:
    """The project, complete with the transfers of the document; gives its folder."""
    shutil.copytree(FIXTURE, folder, dirs_exist_ok=True)
    behaviour = "transfers:\n" + "".join(examples()) + REQUESTS
    (folder / "spec" / "behaviour.yaml").write_text(behaviour, "utf-8")
    return folder


@cache
def project() -> Project:
    """The spec of the rack."""
    with tempfile.TemporaryDirectory() as name:
        return load(Config(root=write(Path(name)), name="rack", spec="spec"))


@cache
def rack() -> Protocol:
    """The rack with its message classes."""
    return typed_protocol(project().protocol)
