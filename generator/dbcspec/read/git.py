"""Files as they were at a git revision: ``HEAD~3:dbc/x.dbc``, ``v1.0:spec``."""

from __future__ import annotations

import os
import posixpath
import re
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from typedcan.model.errors import ReadError

_DRIVE = re.compile(r"[A-Za-z]:[\\/]")
_FILE_MODES = frozenset({"100644", "100755", "100664"})


def split_revision(argument: str) -> tuple[str, str] | None:
    """Revision and path of ``revision:path``, or None where the argument is not of that form.

    A Windows path that begins with its drive, such as ``C:/x.dbc``, is none.
    """
    revision, colon, path = argument.partition(":")
    if not colon or not revision or _DRIVE.match(argument):
        return None
    return revision, path


@contextmanager
def checked_out(revision: str, path: str, cwd: Path) -> Iterator[Path]:
    """The path as it was at the revision, in a temporary folder that goes away afterwards.

    Paths count from the top of the repository that ``cwd`` is in, as git's own do, or from
    ``cwd`` where they begin with ``./`` or ``../``. The pyproject.toml files above the path come
    along. Raises `ReadError` where there is no git, repository, revision or path.
    """
    repository = _Repository(cwd)
    tree = repository.tree(revision)
    inside = repository.inside(path)
    with TemporaryDirectory(prefix="dbcspec-", ignore_cleanup_errors=True) as folder:
        found = repository.copy(tree, inside, Path(folder))
        if not found:
            raise ReadError(f"{revision}:{path}: there is no such path at that revision")
        for parent in _parents(inside):
            repository.copy(tree, posixpath.join(parent, "pyproject.toml"), Path(folder))
        yield Path(folder, *inside.split("/"))


def _parents(path: str) -> Iterator[str]:
    while path:
        path = posixpath.dirname(path)
        yield path


class _Repository:
    """Runs git, never through a shell, and never with an option that a user wrote."""

    def __init__(self, cwd: Path) -> None:
        self._cwd = cwd
        top = self._git("rev-parse", "--show-prefix")
        if top is None:
            raise ReadError(f"{cwd}: is not in a git repository")
        self._prefix = top.decode("utf-8", "surrogateescape").strip("\r\n")

    def tree(self, revision: str) -> str:
        """The hash of the revision's tree."""
        if revision.startswith("-") or "\0" in revision:
            raise ReadError(f"{revision}: is no git revision")
        # "--end-of-options" keeps what follows from being an option, whatever it is.
        found = self._git(
            "rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{tree}}"
        )
        if found is None:
            raise ReadError(f"{revision}: there is no such git revision (and no such file)")
        return found.decode("ascii").split()[-1]

    def inside(self, path: str) -> str:
        """The path from the top of the repository."""
        relative = path.startswith(("./", "../")) or path in (".", "..")
        plain = posixpath.normpath(posixpath.join(self._prefix, path) if relative else path)
        if not path or plain.startswith(("/", "..")) or plain == ".":
            raise ReadError(f"{path!r}: give a path inside the repository after the revision")
        return plain

    def copy(self, tree: str, path: str, folder: Path) -> bool:
        """Write the file, or the files below the folder, of that path; whether there are any."""
        listing = self._git("ls-tree", "-r", "-z", "--full-tree", tree, "--", path) or b""
        entries = [entry for entry in os.fsdecode(listing).split("\0") if entry]
        for entry in entries:
            (mode, _, blob), name = entry.partition("\t")[0].split(), entry.partition("\t")[2]
            parts = name.split("/")
            if mode in _FILE_MODES and not {"", ".", ".."} & set(parts) and "\\" not in name:
                target = folder.joinpath(*parts)
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(self._git("cat-file", "blob", blob) or b"")
        return bool(entries)

    def _git(self, *arguments: str) -> bytes | None:
        """What git prints, None where it fails."""
        environment = {**os.environ, "GIT_TERMINAL_PROMPT": "0"}
        try:
            done = subprocess.run(
                ["git", *arguments],
                cwd=self._cwd,
                env=environment,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                check=False,
            )
        except FileNotFoundError:
            raise ReadError("a revision was given, but git is not installed") from None
        except (OSError, ValueError) as error:
            raise ReadError(f"git cannot be run in {self._cwd}: {error}") from None
        return done.stdout if done.returncode == 0 else None
