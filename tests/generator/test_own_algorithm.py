"""A spec that names an algorithm of its users': what checks it is told by --algorithm."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from dbcspec.cli import run

Capture = pytest.CaptureFixture[str]

CASE = Path(__file__).parent.parent / "lint" / "cases" / "checksum-algorithm-known" / "fires"
GIVEN = ["--algorithm", "crc8_of_somebody=commands.crc_of_ours:inverted_sum"]


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project whose only fault is that nothing computes its checksum."""
    shutil.copytree(CASE, tmp_path / "spec")
    table = tmp_path / "spec" / "tables" / "01-state.yaml"
    text = table.read_text("utf-8")
    table.write_text(
        text.replace("    name: PUMP\n", "    name: PUMP\n    english: Pump\n"), "utf-8"
    )
    tables = 'name = "probe"\nspec = "spec"\ndbc = "dbc"\nstubs = ""\n'
    (tmp_path / "pyproject.toml").write_text(f"[tool.dbcspec]\n{tables}", "utf-8")
    return tmp_path


def test_what_a_user_computes_is_no_finding(project: Path, capsys: Capture) -> None:
    assert run(["lint", "-C", str(project)]) == 1
    assert "checksum-algorithm-known" in capsys.readouterr().out
    assert run(["lint", "-C", str(project), *GIVEN]) == 0
    assert run(["lint", str(project / "spec"), *GIVEN]) == 0


@pytest.mark.parametrize("command", ["generate", "check"])
def test_files_are_made_and_checked_with_it_and_not_without(
    command: str, project: Path, capsys: Capture
) -> None:
    assert run(["generate", "-C", str(project), *GIVEN]) == 0
    assert run([command, "-C", str(project), *GIVEN]) == 0
    capsys.readouterr()
    assert run([command, "-C", str(project)]) == 1
    assert "nothing here computes 'crc8_of_somebody'" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["lint", "generate", "check"])
def test_a_name_that_the_spec_has_not_is_one_clear_line(
    command: str, project: Path, capsys: Capture
) -> None:
    option = ["--algorithm", "crc8=commands.crc_of_ours:inverted_sum"]
    assert run([command, "-C", str(project), *option]) == 2
    line = "dbcspec: no message has the algorithm 'crc8'; known: crc8_of_somebody\n"
    assert capsys.readouterr().err == line
