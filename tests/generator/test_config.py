"""The [tool.dbcspec] table: what it may say, and one line for what it may not."""

from __future__ import annotations

from pathlib import Path

import pytest

from dbcspec.config import Config, find_config
from typedcan.model.errors import ReadError


def configured(folder: Path, toml: str) -> Config:
    (folder / "pyproject.toml").write_text(toml, "utf-8")
    return find_config(folder)


def test_a_name_is_enough(tmp_path: Path) -> None:
    expected = Config(root=tmp_path, name="x", spec="spec", dbc="dbc", stubs="", runtime="")
    assert configured(tmp_path, '[tool.dbcspec]\nname = "x"\n') == expected


def test_every_path_can_be_given(tmp_path: Path) -> None:
    keys = {"name": "x", "spec": "a", "dbc": ".", "stubs": "p/_generated", "runtime": "p"}
    toml = "[tool.dbcspec]\n" + "".join(f'{key} = "{value}"\n' for key, value in keys.items())
    assert configured(tmp_path, toml) == Config(root=tmp_path, **keys)  # type: ignore[arg-type]


def test_the_nearest_configuration_above_is_taken(tmp_path: Path) -> None:
    inner = tmp_path / "inner"
    (inner / "spec").mkdir(parents=True)
    configured(tmp_path, '[tool.dbcspec]\nname = "outer"\n')
    assert find_config(inner / "spec").name == "outer"
    configured(inner, "[tool.other]\n")
    assert find_config(inner / "spec").name == "outer"
    configured(inner, '[tool.dbcspec]\nname = "inner"\n')
    assert find_config(inner / "spec") == Config(root=inner, name="inner")


def test_a_waiver_knows_its_line(tmp_path: Path) -> None:
    keys = 'rule = "signals-overlap"\nsubject = "S_*"\nreason = "because"\n'
    header = "[[tool.dbcspec.waivers]]\n"
    config = configured(tmp_path, f'[tool.dbcspec]\nname = "x"\n\n{header}{keys}{header}{keys}')
    assert [str(waiver.where) for waiver in config.waivers] == [
        "pyproject.toml:4:1",
        "pyproject.toml:8:1",
    ]
    assert {(waiver.rule, waiver.subject) for waiver in config.waivers} == {
        ("signals-overlap", "S_*")
    }


@pytest.mark.parametrize(
    ("toml", "fault"),
    [
        ("", "no pyproject.toml with a [tool.dbcspec] table in "),
        ("tool = 3", "no pyproject.toml with a [tool.dbcspec] table in "),
        ("[tool]\ndbcspec = 3", "no pyproject.toml with a [tool.dbcspec] table in "),
        ("[tool.dbcspec", "pyproject.toml: "),
        ("[tool.dbcspec]\nspec = 'spec'", "needs a name for the database"),
        ("[tool.dbcspec]\nname = ''", "needs a name for the database"),
        ("[tool.dbcspec]\nname = 3", "name must be text"),
        ("[tool.dbcspec]\nname = 'x'\ndbc = ''", "dbc is empty"),
        ("[tool.dbcspec]\nname = 'x'\nspec = ''", "spec is empty"),
        ("[tool.dbcspec]\nname = 'x'\nspce = 'y'", "has an unknown key 'spce'"),
        ("[tool.dbcspec]\nname = 'x'\nwaivers = 3", "waivers must be tables"),
        ("[tool.dbcspec]\nname = 'x'\nwaivers = ['y']", "waiver 1 needs rule, subject and reason"),
        (
            "[tool.dbcspec]\nname = 'x'\nwaivers = [{rule = 'r', subject = 's', reason = ''}]",
            "waiver 1 needs rule, subject and reason",
        ),
        (
            "[tool.dbcspec]\nname = 'x'\nwaivers = [{rule = 'r', subject = 's', reason = 1}]",
            "waiver 1 needs rule, subject and reason",
        ),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(toml: str, fault: str, tmp_path: Path) -> None:
    with pytest.raises(ReadError) as caught:
        configured(tmp_path, toml)
    assert fault in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_utf_8_is_refused(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_bytes("[tool.dbcspec]\nname = '温'".encode("gbk"))
    with pytest.raises(ReadError, match=r"pyproject\.toml: is not UTF-8$"):
        find_config(tmp_path)
