"""What is generated is tried in a process of its own first: what is wrong is never written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from generator.small_spec import write_project

from dbcspec.artifacts import artifacts, foreign_artifacts
from dbcspec.cli import run
from dbcspec.commands import generate
from dbcspec.config import find_config
from dbcspec.project import load
from dbcspec.read.doors import open_side
from dbcspec.trial import try_package
from typedcan.model.errors import ReadError

CASE = Path(__file__).parent.parent / "fixtures" / "cases" / "gear_8.dbc"
Files = dict[str, bytes]
Spoil = Callable[[Files], None]


def broken_code(files: Files) -> None:
    files["gear_8/codec.py"] += b"\nraise KeyError('no such thing')\n"


def no_python(files: Files) -> None:
    files["gear_8/enums.py"] = b"class\n"


def other_values(files: Files) -> None:
    text = files["gear_8/codec.py"].decode()
    assert "_codes_Gear_8[d[0]]" in text
    files["gear_8/codec.py"] = text.replace("_codes_Gear_8[d[0]]", "d[0] ^ 1").encode()


def other_bits(files: Files) -> None:
    text = files["gear_8.dbc"].decode()
    assert "0|8@1+" in text
    files["gear_8.dbc"] = text.replace("0|8@1+", "8|8@1+").encode()


def no_message(files: Files) -> None:
    files["gear_8.dbc"] = files["gear_8.dbc"].replace(b"BO_ 256 ", b"BO_ 257 ", 1)


def an_exit(files: Files) -> None:
    files["gear_8/messages.py"] += b"\nimport os\nos._exit(3)\n"


WAYS = [broken_code, no_python, other_values, other_bits, no_message, an_exit]


def test_a_package_that_hangs_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    files = foreign_artifacts(open_side(str(CASE)).protocol, "gear_8")
    files["gear_8/messages.py"] += b"\nwhile True: pass\n"
    monkeypatch.setattr("dbcspec.trial._SECONDS", 1)
    with pytest.raises(ReadError, match="gear_8: is not imported and tried within 1 s"):
        try_package(files, "gear_8", "gear_8.dbc")


def test_a_sound_package_passes() -> None:
    files = foreign_artifacts(open_side(str(CASE)).protocol, "gear_8")
    try_package(files, "gear_8", "gear_8.dbc")


@pytest.mark.parametrize("spoil", WAYS)
def test_a_package_that_does_otherwise_is_refused_in_one_line(spoil: Spoil) -> None:
    files = foreign_artifacts(open_side(str(CASE)).protocol, "gear_8")
    spoil(files)
    with pytest.raises(ReadError) as caught:
        try_package(files, "gear_8", "gear_8.dbc")
    assert str(caught.value).startswith("nothing is written: ")
    assert "\n" not in str(caught.value)


def test_a_branch_is_tried_however_seldom_it_is_selected(tmp_path: Path) -> None:
    path = tmp_path / "rare.dbc"
    path.write_text(
        'VERSION ""\n\nBU_: A\nBO_ 1 Rare: 8 A\n'
        ' SG_ Page M : 0|32@1+ (1,0) [0|0] "" A\n'
        ' SG_ Value m123456789 : 32|8@1+ (2,0) [0|510] "x" A\n',
        "ascii",
    )
    files = foreign_artifacts(open_side(str(path)).protocol, "rare")
    try_package(files, "rare", "rare.dbc")
    text = files["rare/codec.py"].decode()
    assert "* 2.0" in text
    files["rare/codec.py"] = text.replace("* 2.0", "* 3.0").encode()
    with pytest.raises(ReadError, match="Rare: straight lines make"):
        try_package(files, "rare", "rare.dbc")


def test_generate_from_writes_nothing_of_a_package_that_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def spoilt(*arguments: object) -> Files:
        files = foreign_artifacts(*arguments)  # type: ignore[arg-type]
        other_values(files)
        return files

    monkeypatch.setattr(generate, "foreign_artifacts", spoilt)
    assert run(["generate", "--from", str(CASE), "--out", str(tmp_path / "out")]) == 2
    assert not (tmp_path / "out").exists()
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1


def test_generate_writes_nothing_of_a_project_whose_package_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_project(tmp_path)
    with (tmp_path / "pyproject.toml").open("a", encoding="utf-8") as file:
        file.write('stubs = "src/thermo/_generated"\n')
    before = sorted(path for path in tmp_path.rglob("*"))

    def spoilt(*arguments: object) -> Files:
        files = artifacts(*arguments)  # type: ignore[arg-type]
        files["src/thermo/_generated/messages.py"] += b"\n1 / 0\n"
        return files

    monkeypatch.setattr(generate, "artifacts", spoilt)
    assert run(["generate", "-C", str(tmp_path)]) == 2
    assert sorted(path for path in tmp_path.rglob("*")) == before
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_a_package_is_tried_whatever_lies_where_the_command_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "can.py").write_text("raise SystemExit(1)")
    (tmp_path / "typedcan.py").write_text("raise SystemExit(1)")
    monkeypatch.chdir(tmp_path)
    files = foreign_artifacts(open_side(str(CASE)).protocol, "gear_8")
    try_package(files, "gear_8", "gear_8.dbc")


def test_the_projects_own_package_is_tried_quickly_enough_to_be_tried_always(root: Path) -> None:
    project = load(find_config(root))
    files = artifacts(project.protocol, project.config)
    try_package(files, project.config.stubs, f"{project.config.dbc}/{project.config.name}.dbc")
