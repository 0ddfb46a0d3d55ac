"""Where output goes: a file or a folder, that appears complete or not at all."""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pyarrow as pa

from typedcan.logs.write.arrow import ArrowFile
from typedcan.logs.write.csv import CsvFile
from typedcan.logs.write.mf4 import Mf4File
from typedcan.logs.write.parquet import ParquetFile
from typedcan.logs.write.sink import Files, OpenTable, Sink
from typedcan.model.errors import TypedcanError

_TABLES: dict[str, OpenTable] = {
    ".parquet": ParquetFile,
    ".arrow": ArrowFile,
    ".feather": ArrowFile,
    ".csv": CsvFile,
}
_MF4 = ".mf4"
_DEFAULT = ".parquet"


class OutputError(TypedcanError):
    """The output cannot be written there."""


@dataclass(frozen=True, slots=True)
class Target:
    """Where the tables go.

    Parameters
    ----------
    path
        The file, or the folder with a file per table.
    suffix
        Which kind of file.
    folder
        Whether it is a folder.
    """

    path: Path
    suffix: str
    folder: bool


def target_of(output: Path, *, single: bool) -> Target:
    """Where an output of that name goes.

    Parameters
    ----------
    output
        A name whose suffix says which kind of file; without one, a folder of Parquet files.
    single
        Whether there is one table only. Else the output is a folder, named without the suffix;
        MF4 holds all tables in one file.

    Raises
    ------
    OutputError
        The suffix is none that is known.
    """
    if not output.name:  # such as "."
        output = output.resolve()
    suffix = output.suffix.lower()
    if not suffix or output.is_dir():
        return Target(output, _DEFAULT, folder=True)
    if suffix == _MF4:
        return Target(output, suffix, folder=False)
    if suffix not in _TABLES:
        known = ", ".join((*_TABLES, _MF4))
        raise OutputError(f"{output}: the name must end in one of {known}, or be a folder's")
    return Target(output if single else output.with_suffix(""), suffix, folder=not single)


@contextmanager
def writing(
    target: Target, schemas: dict[str, pa.Schema], *, force: bool = False
) -> Iterator[Sink]:
    """A sink whose files take their place once the block ends well, and vanish if it does not.

    Parameters
    ----------
    target
        Where the output goes.
    schemas
        The tables there can be. Where the target is one file, it is written even without rows.
    force
        Replace what is there: a file, or a folder with files of the same kind and nothing else.

    Raises
    ------
    OutputError
        Something is there that is not to be replaced, or it cannot be written there.
    Mf4Error
        asammdf is missing.
    """
    _check(target, force=force)
    token = secrets.token_hex(4)
    draft = target.path.with_name(f".{target.path.name}.{token}{target.suffix}")
    try:
        sink = _sink(target, draft, schemas)
        try:
            yield sink
            sink.close()
        except BaseException:
            sink.abort()
            raise
        _put(draft, target, token)
    finally:
        _remove(draft)


def _sink(target: Target, draft: Path, schemas: dict[str, pa.Schema]) -> Sink:
    try:
        target.path.parent.mkdir(parents=True, exist_ok=True)
        if target.folder:
            draft.mkdir()
        elif target.suffix != _MF4:
            draft.touch()
    except OSError as error:
        raise OutputError(f"{target.path}: {error.strerror or error}") from None
    if target.suffix == _MF4:
        return Mf4File(draft)
    if target.folder:
        tables = dict.fromkeys(schemas)

        def path_of(name: str) -> Path:
            tables.setdefault(name)  # what some tables are called, their rows tell
            return draft / f"{file_names(tables)[name]}{target.suffix}"

        return Files(_TABLES[target.suffix], path_of)
    files = Files(_TABLES[target.suffix], lambda _: draft)
    for name, schema in schemas.items():
        files.open(name, schema)
    return files


def file_names(tables: Iterable[str]) -> dict[str, str]:
    """What the files of tables are called: no two alike where case does not count in names."""
    names: dict[str, str] = {}
    taken: set[str] = set()
    for table in tables:
        name, number = table, 1
        while name.casefold() in taken:
            number += 1
            name = f"{table}_{number}"
        taken.add(name.casefold())
        names[table] = name
    return names


def _check(target: Target, *, force: bool) -> None:
    path = target.path
    try:
        str(path).encode()  # pyarrow opens no other
    except UnicodeEncodeError:
        raise OutputError(f"{path}: the name is no text, choose another") from None
    if not path.exists():
        return
    if target.folder and path.is_dir():
        others = [each for each in path.iterdir() if each.suffix.lower() != target.suffix]
        if others:
            raise OutputError(f"{path}: the folder holds other files ({others[0].name})")
        if not any(path.iterdir()):
            return
    elif path.is_dir() or target.folder:
        kind = "a folder" if path.is_dir() else "a file"
        raise OutputError(f"{path}: there is {kind} of that name")
    if not force:
        raise OutputError(f"{path}: exists; --force replaces it")


def _put(draft: Path, target: Target, token: str) -> None:
    """Move the finished output to its place."""
    if not target.folder or not target.path.exists():
        draft.replace(target.path)
        return
    old = target.path.with_name(f".{target.path.name}.{token}.old")
    target.path.rename(old)
    try:
        draft.rename(target.path)
    except OSError:
        old.rename(target.path)
        raise
    shutil.rmtree(old)


def _remove(draft: Path) -> None:
    if draft.is_dir():
        shutil.rmtree(draft, ignore_errors=True)
    elif draft.exists():
        draft.unlink()
