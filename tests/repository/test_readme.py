"""What the README prints works: its Python, its commands, and the two that CI runs as printed."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import can
import pytest

import swapcan
from swapcan.messages import B2V_ST2

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")


def blocks(language: str) -> list[str]:
    """The fenced blocks of one language."""
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.DOTALL | re.MULTILINE)


def commands(block: str) -> list[str]:
    return [line.removeprefix("$ ") for line in block.splitlines() if line.startswith("$ ")]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A copy of what the commands read and write, with the log that they name."""
    for part in ("spec", "dbc", "src/swapcan/_generated"):
        shutil.copytree(ROOT / part, tmp_path / part)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    frame = can.Message(
        timestamp=1.0, arbitration_id=B2V_ST2.FRAME_ID, data=swapcan.encode(B2V_ST2(soc=80.0))
    )
    with can.Logger(str(tmp_path / "drive.asc")) as log:
        log.on_message_received(frame)
    for arguments in (["init", "-q"], ["add", "."], ["commit", "-q", "-m", "first"]):
        identity = ["-c", "user.name=x", "-c", "user.email=x@example.org"]
        subprocess.run(["git", *identity, *arguments], cwd=tmp_path, check=True)
    return tmp_path


@pytest.mark.parametrize("block", blocks("console"), ids=lambda block: block.splitlines()[0])
def test_the_commands_of_a_block_run_one_after_the_other(block: str, project: Path) -> None:
    for command in commands(block):
        name, *arguments = shlex.split(command)
        done = subprocess.run(
            [sys.executable, "-m", name, *arguments],
            cwd=project,
            env={**os.environ, "PYTHONIOENCODING": "utf-8"},
            capture_output=True,
            encoding="utf-8",
            timeout=60,
            check=False,
        )
        assert done.returncode == 0, f"{command}: {done.stderr}{done.stdout}"


def printed_by(snippet: str, folder: Path) -> list[str]:
    """The lines that a snippet of the README prints."""
    script = folder / "readme.py"
    script.write_text(snippet, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_each_python_snippet_of_the_readme_is_looked_at_here() -> None:
    assert len(blocks("python")) == 5


def test_the_snippet_for_links_prints_what_was_sent(tmp_path: Path) -> None:
    first, second = printed_by(blocks("python")[0], tmp_path)
    assert first.split()[:2] == ["80.0", "-120.5"]
    assert "Signal Invalid" in first
    assert "HV_ON" in second
    assert "vehicle_speed=42.0" in second


def test_the_snippet_for_editions_says_weld_as_the_edition_does(tmp_path: Path) -> None:
    sent, heard = printed_by(blocks("python")[1], tmp_path)
    assert bytes.fromhex(sent)[4] >> 4 & 3 == 2
    assert "ContactorFault.WELD" in heard


def test_the_snippet_for_nodes_gets_the_pack_code_of_the_simulated_pack(tmp_path: Path) -> None:
    lines = printed_by(blocks("python")[2], tmp_path)
    assert "B2V_ST2: never seen -> alive" in lines
    *_, code, soc, message = (line for line in lines if "->" not in line)
    assert len(code) == 24
    assert 0 <= float(soc) <= 100
    assert "'name': '" in message


def test_the_snippet_for_simulations_ends_with_the_high_voltage_off(tmp_path: Path) -> None:
    (line,) = printed_by(blocks("python")[3], tmp_path)
    assert "PRECHARGE" in line
    assert "HV_CLOSED" in line


def test_the_snippet_for_conformance_judges_the_log_beside_it(
    project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(project)
    assert printed_by(blocks("python")[4], project) == ["conforms"]


def test_ci_runs_the_two_commands_as_the_readme_prints_them() -> None:
    script = (ROOT / ".ci" / "run").read_text("utf-8")
    for name in ("main", "tests"):
        assert f"<!-- command: {name} -->\n```sh\n" in README
        assert f"readme_command {name}" in script


def test_every_file_that_the_readme_names_is_there() -> None:
    named = re.findall(r"`((?:dbc|spec)/[\w./-]+)`|\]\(([\w/.]+)\)", README)
    assert named
    assert [name for names in named for name in names if not (ROOT / name).exists()] == []
