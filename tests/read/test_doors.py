"""One argument, and what it opens: folders, files, and both as git has them."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from dbcspec.errors import SpecError
from dbcspec.read.doors import open_side
from dbcspec.read.git import split_revision
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol

DBC = """VERSION ""

BU_: A B
BO_ 1 {name}: 8 A
 SG_ One : 0|8@1+ (1,0) [0|255] "V" B
"""


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory, root: Path) -> Path:
    """Two commits: a DBC and the project's spec, then the DBC with a renamed message."""
    folder = tmp_path_factory.mktemp("repository")

    def git(*arguments: str) -> None:
        name = ("-c", "user.name=t", "-c", "user.email=t@t", "-c", "core.autocrlf=false")
        subprocess.run(["git", *name, *arguments], cwd=folder, check=True, capture_output=True)

    git("init", "-q")
    (folder / "dbc").mkdir()
    (folder / "dbc" / "x.dbc").write_text(DBC.format(name="Before"), "ascii")
    shutil.copytree(root / "spec", folder / "spec")
    (folder / "pyproject.toml").write_text('[tool.dbcspec]\nname = "renamed"\n', "ascii")
    git("add", ".")
    git("commit", "-q", "-m", "first")
    git("tag", "v1.0")
    (folder / "dbc" / "x.dbc").write_text(DBC.format(name="After"), "ascii")
    (folder / "pyproject.toml").unlink()
    git("commit", "-q", "-a", "-m", "second")
    return folder


@pytest.mark.parametrize(
    ("argument", "name"),
    [
        ("dbc/x.dbc", "After"),
        ("HEAD:dbc/x.dbc", "After"),
        ("HEAD~1:dbc/x.dbc", "Before"),
        ("v1.0:dbc/x.dbc", "Before"),
        ("v1.0:./dbc/x.dbc", "Before"),
    ],
)
def test_a_dbc_is_read_as_it_was_at_a_revision(repository: Path, argument: str, name: str) -> None:
    side = open_side(argument, cwd=repository)
    assert [message.name for message in side.protocol.messages] == [name]
    assert side.title == argument
    assert side.protocol.messages[0].where.path == argument
    assert side.spec is None


def test_paths_count_from_the_top_of_the_repository_or_from_here(repository: Path) -> None:
    below = repository / "dbc"
    for argument in ("v1.0:dbc/x.dbc", "v1.0:./x.dbc", "v1.0:../dbc/x.dbc"):
        assert open_side(argument, cwd=below).protocol.messages[0].name == "Before"


def test_a_spec_is_read_as_it_was_with_the_name_it_had(
    repository: Path, protocol: Protocol
) -> None:
    side = open_side("v1.0:spec", cwd=repository)
    assert side.protocol.name == "renamed"
    assert side.protocol.messages == protocol.messages
    assert side.protocol.messages[0].where.path == "v1.0:spec/messages.yaml"
    assert open_side("HEAD:spec", cwd=repository).protocol.name == "spec"


def test_a_spec_folder_is_opened_with_its_rows_and_errata(root: Path, protocol: Protocol) -> None:
    side = open_side("spec", cwd=root)
    assert side.protocol == protocol
    assert side.spec is not None
    assert side.errata_faults == ()


def test_a_spec_without_a_project_is_called_by_its_folder(root: Path, tmp_path: Path) -> None:
    shutil.copytree(root / "spec", tmp_path / "standard")
    assert open_side(str(tmp_path / "standard")).protocol.name == "standard"


def test_a_spec_with_faults_says_where(root: Path, tmp_path: Path) -> None:
    shutil.copytree(root / "spec", tmp_path / "standard")
    (tmp_path / "standard" / "messages.yaml").write_text("annex: [\n", "ascii")
    with pytest.raises(SpecError, match=r"messages\.yaml:"):
        open_side("standard", cwd=tmp_path)


def test_a_path_that_exists_goes_before_a_revision(repository: Path, tmp_path: Path) -> None:
    if not (tmp_path / "HEAD:x.dbc").drive:
        (tmp_path / "HEAD:x.dbc").write_text(DBC.format(name="File"), "ascii")
        assert open_side("HEAD:x.dbc", cwd=tmp_path).protocol.messages[0].name == "File"


@pytest.mark.parametrize("path", ["C:\\dbc\\x.dbc", "c:/dbc/x.dbc", "dbc/x.dbc", ":x.dbc"])
def test_a_windows_path_or_a_plain_one_is_no_revision(path: str) -> None:
    assert split_revision(path) is None


def test_a_revision_ends_at_the_first_colon() -> None:
    assert split_revision("v1.0:a:b") == ("v1.0", "a:b")
    assert split_revision("x:spec") == ("x", "spec")


@pytest.mark.parametrize(
    ("argument", "text"),
    [
        ("nope:dbc/x.dbc", "nope: there is no such git revision"),
        ("HEAD:nope.dbc", "HEAD:nope.dbc: there is no such path at that revision"),
        ("HEAD:", "give a path inside the repository"),
        ("HEAD:../../etc/passwd", "give a path inside the repository"),
        ("HEAD:/etc/passwd", "give a path inside the repository"),
        ("--output=x:dbc/x.dbc", "--output=x: is no git revision"),
        ("-h:dbc/x.dbc", "-h: is no git revision"),
        ("HEAD:dbc", "HEAD:dbc: is a folder without a standard.yaml"),
        ("dbc", "dbc: is a folder without a standard.yaml"),
        ("nope.dbc", "nope.dbc: there is no such file or folder"),
        ("C:\\nope.dbc", "there is no such file or folder"),
        ("HEAD:pyproject.toml", "there is no such path"),
        ("v1.0:pyproject.toml", "is neither a spec folder nor a file of a known kind"),
        ("", "neither a file nor a spec folder is named"),
        ("\0", "there is no such file or folder"),
        ("\0:x", "is no git revision"),
    ],
)
def test_what_cannot_be_opened_says_why_in_one_line(
    repository: Path, argument: str, text: str
) -> None:
    with pytest.raises(ReadError) as caught:
        open_side(argument, cwd=repository)
    assert text in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_folder_outside_any_repository_says_so(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="is not in a git repository"):
        open_side("HEAD:x.dbc", cwd=tmp_path)


def test_a_machine_without_git_says_so(
    repository: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ReadError, match="git is not installed"):
        open_side("HEAD:dbc/x.dbc", cwd=repository)


def test_nothing_of_a_revision_stays_behind(
    repository: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    open_side("v1.0:dbc/x.dbc", cwd=repository)
    assert list(tmp_path.iterdir()) == []
