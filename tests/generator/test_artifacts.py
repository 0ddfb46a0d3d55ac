"""Which files are generated, that writing is all or nothing, and what checking finds."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import IO, Any

import pytest
from generator.small_spec import write_project

from dbcspec.artifacts import Stale, artifacts, verify, write
from dbcspec.config import find_config
from dbcspec.project import Project, load
from dbcspec.spec.variants import with_variants
from typedcan.model.errors import ReadError
from typedcan.shell.console import CommandError

DBC_FILES = ("thermo.dbc", "thermo.zh.dbc", "thermo.zh-utf8.dbc", "thermo-house.dbc")


@pytest.fixture
def small(tmp_path: Path) -> Project:
    return load(find_config(write_project(tmp_path)))


def files_of(project: Project) -> dict[str, bytes]:
    editions = [edition.name for edition in project.printed.editions]
    return artifacts(
        with_variants(project.protocol, project.printed),
        project.config,
        {name: load(project.config, name).protocol for name in editions},
    )


def checked(project: Project) -> list[Stale]:
    return verify(project.config.root, files_of(project), project.protocol, project.config)


def on_disk(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_a_project_without_python_gets_dbc_files_and_schemas(small: Project) -> None:
    names = set(files_of(small))
    assert {name for name in names if name.startswith("out/")} == {
        f"out/{name}" for name in DBC_FILES
    }
    schemas = {name for name in names if name.startswith("spec/schema/")}
    assert names - schemas == {f"out/{name}" for name in DBC_FILES}
    assert len(schemas) == 8


def test_a_project_with_python_gets_stubs_and_its_main_dbc_beside_them(tmp_path: Path) -> None:
    write_project(tmp_path)
    with (tmp_path / "pyproject.toml").open("a", encoding="utf-8") as file:
        file.write('stubs = "src/thermo/_generated"\n')
    files = files_of(load(find_config(tmp_path)))
    folder = "src/thermo/_generated"
    assert {name for name in files if name.startswith(folder)} == {
        f"{folder}/{name}"
        for name in (
            "__init__.py",
            "model.py",
            "enums.py",
            "messages.py",
            "codec.py",
            "model.py",
            "protocol.json",
            "protocol.py",
            "protocol.json",
            "thermo.dbc",
        )
    }
    assert files[f"{folder}/thermo.dbc"] == files["out/thermo.dbc"]


def test_generating_again_makes_the_same_bytes(tmp_path: Path) -> None:
    folders = (tmp_path / "one", tmp_path / "other")
    for folder in folders:
        folder.mkdir()
        write_project(folder)
    one, other = (files_of(load(find_config(folder))) for folder in folders)
    assert one == other


def test_writing_makes_the_files_and_names_them(small: Project) -> None:
    files = files_of(small)
    assert write(small.config.root, files) == list(files)
    assert {name: (small.config.root / name).read_bytes() for name in files} == files
    assert checked(small) == []


def test_writing_twice_changes_nothing(small: Project) -> None:
    root, files = small.config.root, files_of(small)
    write(root, files)
    times = {name: (root / name).stat().st_mtime_ns for name in files}
    assert write(root, files) == []
    assert {name: (root / name).stat().st_mtime_ns for name in files} == times


def test_writing_touches_only_what_differs(small: Project) -> None:
    root, files = small.config.root, files_of(small)
    write(root, files)
    (root / "out" / "thermo.dbc").write_text("old")
    (root / "out" / "thermo.zh.dbc").unlink()
    assert write(root, files) == ["out/thermo.dbc", "out/thermo.zh.dbc"]


def test_writing_leaves_files_of_others_alone(small: Project) -> None:
    root, files = small.config.root, files_of(small)
    other = root / "out" / "notes.txt"
    other.parent.mkdir()
    other.write_text("mine")
    write(root, files)
    assert other.read_text() == "mine"
    assert {path.name for path in (root / "out").iterdir()} == {*DBC_FILES, "notes.txt"}


def test_a_write_that_fails_half_way_leaves_the_old_files_whole(
    small: Project, monkeypatch: pytest.MonkeyPatch
) -> None:
    root, files = small.config.root, files_of(small)
    write(root, dict.fromkeys(files, b"the last generation"))
    before = on_disk(root)
    opened, written = Path.open, list[Path]()

    def full_disk(path: Path, mode: str = "r", **options: Any) -> IO[Any]:
        written.extend([path] if mode == "xb" else [])
        if mode == "xb" and len(written) == 4:
            raise OSError(errno.ENOSPC, "full", str(path))
        return opened(path, mode, **options)

    monkeypatch.setattr(Path, "open", full_disk)
    with pytest.raises(CommandError, match=r"cannot be written: full$"):
        write(root, files)
    assert len(written) == 4
    assert on_disk(root) == before


def test_a_folder_where_a_file_belongs_is_refused_before_anything_is_written(
    small: Project,
) -> None:
    root = small.config.root
    (root / "spec" / "schema" / "table.json").mkdir(parents=True)
    before = on_disk(root)
    with pytest.raises(ReadError, match=r"table\.json: cannot be read: "):
        write(root, files_of(small))
    assert on_disk(root) == before


def test_a_missing_file_is_found(small: Project) -> None:
    assert {(each.path, each.why) for each in checked(small)} == {
        (name, "missing") for name in files_of(small)
    }


def test_a_file_edited_by_hand_is_found_with_what_was_changed(small: Project) -> None:
    write(small.config.root, files_of(small))
    path = small.config.root / "out" / "thermo.dbc"
    path.write_bytes(path.read_bytes().replace(b'"Temperature"', b'"Warmth"'))
    (stale,) = checked(small)
    assert (stale.path, stale.why) == ("out/thermo.dbc", "edited by hand")
    assert [line[0] for line in stale.diff] == ["-", "+"]
    assert "Warmth" in stale.diff[0]
    assert "Temperature" in stale.diff[1]


def test_a_file_of_an_older_spec_is_found(small: Project) -> None:
    write(small.config.root, files_of(small))
    path = small.config.root / "out" / "thermo.dbc"
    digest = small.protocol.digest.encode()
    path.write_bytes(path.read_bytes().replace(digest, b"0123456789abcdef"))
    (stale,) = checked(small)
    assert (stale.path, stale.why) == ("out/thermo.dbc", "stale")


def test_other_line_ends_are_found(small: Project) -> None:
    write(small.config.root, files_of(small))
    path = small.config.root / "out" / "thermo.dbc"
    path.write_bytes(path.read_bytes().replace(b"\r\n", b"\n"))
    (stale,) = checked(small)
    assert stale.diff == ("line ends or the end of the file differ",)


def test_a_long_difference_is_cut_short(small: Project) -> None:
    write(small.config.root, files_of(small))
    (small.config.root / "out" / "thermo.dbc").write_bytes(b"")
    (stale,) = checked(small)
    assert len(stale.diff) == 9
    assert stale.diff[-1].endswith(" more lines")


def test_a_file_that_is_no_longer_generated_is_found(small: Project) -> None:
    write(small.config.root, files_of(small))
    (small.config.root / "out" / "thermo-garden.dbc").write_bytes(b"")
    (small.config.root / "out" / "other.dbc").write_bytes(b"")
    (stale,) = checked(small)
    assert (stale.path, stale.why) == ("out/thermo-garden.dbc", "no longer generated: delete it")


def test_the_files_of_the_project_itself_are_current(project: Project) -> None:
    assert checked(project) == []
