"""Files appear whole or not at all; whatever stops a command is one line and exit status 2."""

from __future__ import annotations

import os
import resource
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from typedcan.shell.console import CommandError
from typedcan.shell.files import put_in_place

ROOT = Path(__file__).parents[2]
OURS = str(ROOT / "dbc" / "caamtb-swap.dbc")
COMMANDS = {
    "lint": ("lint", "bad.dbc"),
    "compare": ("compare", "bad.dbc", OURS),
    "show": ("show", "-C", str(ROOT), "B2V_ST2"),
    "textconv": ("textconv", "bad.dbc"),
    "load": ("load", "-C", str(ROOT)),
    "rules": ("rules",),
    "explain": ("explain", "signals-overlap"),
    "help": ("--help",),
}
BAD = (
    'VERSION ""\n\nBU_: AA\n\nBO_ 256 MSG: 8 AA\n SG_ Sxx : 0|8@1+ (1,0) [0|300] "" AA\n'
    ' SG_ Syy : 0|8@1+ (1,0) [0|255] "" AA\n'
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "bad.dbc").write_text(BAD, "utf-8")
    return tmp_path


def dbcspec(
    folder: Path, *words: str, stdout: int = subprocess.PIPE, largest: int = 0
) -> subprocess.CompletedProcess[str]:
    """Run it in a process of its own, which may make files of so many bytes, 0 for any."""

    def limited() -> None:
        if largest:
            resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))

    return subprocess.run(
        [sys.executable, "-m", "dbcspec", *words],
        stdout=stdout,
        stderr=subprocess.PIPE,
        cwd=folder,
        text=True,
        timeout=60,
        check=False,
        # A limit for files would cut what Python caches of its modules, for everybody.
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
        preexec_fn=limited,
    )


def files_in(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="has no file that takes nothing")
@pytest.mark.parametrize("words", COMMANDS.values(), ids=COMMANDS)
def test_a_full_disk_is_one_line_and_no_finding(words: tuple[str, ...], folder: Path) -> None:
    full = os.open("/dev/full", os.O_WRONLY)
    try:
        done = dbcspec(folder, *words, stdout=full)
    finally:
        os.close(full)
    said = "dbcspec: cannot write the output: No space left on device\n"
    assert (done.returncode, done.stderr) == (2, said)


@pytest.mark.parametrize("words", COMMANDS.values(), ids=COMMANDS)
def test_a_pipe_that_nobody_reads_is_one_line_and_no_finding(
    words: tuple[str, ...], folder: Path
) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    try:
        done = dbcspec(folder, *words, stdout=writing)
    finally:
        os.close(writing)
    assert (done.returncode, done.stderr) == (2, "dbcspec: nobody reads the output any more\n")


WRITING = {
    "report": ("lint", "bad.dbc", "--format", "html", "-o", "report.html"),
    "generate": ("generate", "--from", "bad.dbc", "--out", "."),
    "import": ("import", OURS, "--out", "spec"),
    "matrix": ("matrix", "export", "-C", str(ROOT), "--output", "{folder}/big.xlsx"),
    "plot": ("load", "-C", str(ROOT), "--plot", "{folder}/load.svg"),
}


@pytest.mark.parametrize("words", WRITING.values(), ids=WRITING)
def test_a_limit_for_files_leaves_nothing_half_written(
    words: tuple[str, ...], folder: Path
) -> None:
    before = files_in(folder)
    words = tuple(each.format(folder=folder) for each in words)
    done = dbcspec(folder, *words, largest=900)
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("\n") == 1
    assert "File too large" in done.stderr
    assert files_in(folder) == before


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="has no file that takes nothing")
def test_a_device_is_written_to_and_stays_what_it_is(folder: Path) -> None:
    done = dbcspec(folder, "lint", "bad.dbc", "-o", "/dev/full")
    said = "dbcspec: /dev/full: cannot be written: No space left on device\n"
    assert (done.returncode, done.stderr) == (2, said)
    assert stat.S_ISCHR(Path("/dev/full").stat().st_mode)


@pytest.mark.parametrize(
    "words",
    [
        ("lint", "loop.dbc"),
        ("compare", "loop.dbc", "bad.dbc"),
        ("lint", "loop/spec"),
        ("lint", "-C", "loop"),
        ("lint", "bad.dbc", "-o", "loop.dbc"),
        ("lint", "bad.dbc", "--config", "loop.dbc"),
        ("generate", "--from", "bad.dbc", "--out", "loop"),
        ("import", "bad.dbc", "--out", "loop"),
        ("matrix", "import", "loop.xlsx", "-C", str(ROOT)),
    ],
    ids=" ".join,
)
def test_links_in_a_circle_are_one_line(words: tuple[str, ...], folder: Path) -> None:
    for name in ("loop.dbc", "loop", "loop.xlsx"):
        (folder / name).symlink_to(name)
    done = dbcspec(folder, *words)
    assert done.returncode == 2, done
    assert done.stderr.count("\n") == 1, done.stderr
    assert (folder / "loop.dbc").is_symlink()


def test_a_file_that_is_replaced_keeps_its_mode_and_a_new_one_has_the_usual(tmp_path: Path) -> None:
    old, new = tmp_path / "old", tmp_path / "new"
    old.write_bytes(b"before")
    old.chmod(0o640)
    mask = os.umask(0o027)
    try:
        put_in_place({old: b"after", new: b"made"})
    finally:
        os.umask(mask)
    assert (old.read_bytes(), new.read_bytes()) == (b"after", b"made")
    assert [stat.S_IMODE(path.stat().st_mode) for path in (old, new)] == [0o640, 0o640]
    old.chmod(0o755)
    put_in_place({old: b"again"})
    assert stat.S_IMODE(old.stat().st_mode) == 0o755


def test_a_link_to_a_file_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    real = tmp_path / "there" / "real"
    real.write_bytes(b"before")
    link = tmp_path / "link"
    link.symlink_to("there/real")
    put_in_place({link: b"after"})
    assert link.is_symlink()
    assert real.read_bytes() == b"after"
    assert files_in(tmp_path) == {"there/real": b"after", "link": b"after"}


def test_a_link_that_somebody_has_laid_where_a_draft_goes_is_not_followed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("secrets.token_hex", lambda _: "guessed")
    victim = tmp_path / "victim"
    victim.write_bytes(b"mine")
    (tmp_path / ".made.guessed").symlink_to(victim)
    with pytest.raises(CommandError, match="made: cannot be written: File exists"):
        put_in_place({tmp_path / "made": b"theirs"})
    assert victim.read_bytes() == b"mine"


def test_of_several_files_none_is_replaced_where_one_cannot_be_written(tmp_path: Path) -> None:
    first = tmp_path / "first"
    first.write_bytes(b"before")
    with pytest.raises(CommandError, match="No such file or directory"):
        put_in_place({first: b"after", tmp_path / "missing" / "second": b""})
    assert files_in(tmp_path) == {"first": b"before"}


def test_drafts_have_other_names_each_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    drafts: list[str] = []
    replace = Path.replace

    def noted(self: Path, target: Path) -> Path:
        drafts.append(self.name)
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", noted)
    for _ in range(3):
        put_in_place({tmp_path / "made": b"x"})
    assert len(set(drafts)) == 3
    assert all(len(name) >= len(".made.") + 16 for name in drafts)
