"""One argument of the command line to a protocol: spec folder, DBC, matrix, at any revision.

A spec folder is read in any edition and reading that it has.
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

from dbcspec.errors import Fault
from dbcspec.read.git import checked_out, split_revision
from dbcspec.spec.compiled import compile_spec
from dbcspec.spec.rows import Spec
from typedcan.databases.dbc import FORMATS, read_any
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol

MATRIX = ".xlsx"
"""How the name of a matrix ends."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Side:
    """A protocol, and what is known of it where its source is a spec.

    ``title`` is the argument that it was opened by, ``errata_faults`` the changes of its errata
    that could not be made.
    """

    protocol: Protocol
    title: str
    spec: Spec | None = None
    errata_faults: tuple[Fault, ...] = ()


def open_side(
    argument: str, *, encoding: str | None = None, cwd: Path | None = None, wide: bool = False
) -> Side:
    """Read a spec folder, a DBC, an .xlsx matrix or what else cantools reads.

    With ``revision:`` before it, the path is read as git has it; a path that exists goes first.
    After a spec folder ``@`` and an edition or readings choose those: ``spec@v4.6+E50b``.
    ``encoding`` is that of a text file, where it is not to be found out; relative paths start at
    ``cwd``. ``wide`` is for `typedcan.databases.dbc.read_any`.
    Raises `ReadError`, and `SpecError` for a spec folder with faults.
    """
    here = cwd or Path.cwd()
    path = here / argument
    if not argument:
        raise ReadError("neither a file nor a spec folder is named")
    if _exists(path):
        return _open(path, argument, encoding, wide=wide)
    argument, choice = _split_choice(argument, here)
    path = here / argument
    split = split_revision(argument) if not _exists(path) else None
    if split is None:
        return _open(path, argument, encoding, choice, wide=wide)
    with checked_out(*split, here) as found:
        return _open(found, argument, encoding, choice, wide=wide)


def _split_choice(argument: str, here: Path) -> tuple[str, str]:
    """A spec folder and the edition and readings after ``@``, where the argument has such."""
    before, _, choice = argument.rpartition("@")
    is_choice = before and choice and not set(choice) & set("/\\:{}")
    return (before, choice) if is_choice and not _exists(here / argument) else (argument, "")


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def _open(
    path: Path, title: str, encoding: str | None, choice: str = "", *, wide: bool = False
) -> Side:
    if _exists(path / "standard.yaml"):
        return _open_spec(path, title, choice)
    if choice and _exists(path):
        raise ReadError(f"{title}: only a spec folder has editions and readings, so no @{choice}")
    if _is_folder(path):
        raise ReadError(f"{title}: is a folder without a standard.yaml, so no spec")
    if path.suffix.lower() == MATRIX:
        return Side(protocol=_read_matrix(path, title), title=title)
    if not _exists(path):
        raise ReadError(f"{title}: there is no such file or folder")
    if path.suffix.lower() not in FORMATS:
        known = ", ".join((*FORMATS, MATRIX))
        raise ReadError(f"{title}: is neither a spec folder nor a file of a known kind ({known})")
    return Side(protocol=read_any(path, encoding, shown_as=title, wide=wide), title=title)


def _is_folder(path: Path) -> bool:
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


def _read_matrix(path: Path, title: str) -> Protocol:
    try:
        from dbcspec.matrix.read import read_matrix
    except ModuleNotFoundError as error:
        raise ReadError(f"a matrix needs {error.name}: pip install 'swapcan[generator]'") from None
    return read_matrix(path, shown_as=title)


def _open_spec(folder: Path, title: str, choice: str) -> Side:
    name = title.rstrip("/\\") or title
    made = compile_spec(folder, name, _project_name(folder), choice)
    shown = f"{title}@{choice}" if choice else title
    return Side(
        protocol=made.protocol, title=shown, spec=made.spec, errata_faults=made.errata_faults
    )


def _project_name(folder: Path) -> str:
    """The database's name where a project has this spec folder, else the folder's name."""
    folder = folder.resolve()
    for parent in folder.parents:
        table = _dbcspec_table(parent / "pyproject.toml")
        if table is not None:
            name, spec = table.get("name"), table.get("spec", "spec")
            if isinstance(name, str) and name and parent / str(spec) == folder:
                return name
            break
    return folder.name


def _dbcspec_table(path: Path) -> dict[str, object] | None:
    """The [tool.dbcspec] table, None where there is none; a file of another kind has none."""
    try:
        document = tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError):
        return None
    table = document.get("tool", {}).get("dbcspec")
    return table if isinstance(table, dict) else None
