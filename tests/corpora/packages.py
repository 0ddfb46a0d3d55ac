"""A database to a package, and the package to what is wrong with it."""

from __future__ import annotations

import logging
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from enum import Enum
from functools import partial
from pathlib import Path

import cantools.database
from cantools.database.can import Database

from corpora.columns import ByIdentifier, column_faults
from dbcspec.artifacts import foreign_artifacts
from dbcspec.emit.stub_names import package_name
from dbcspec.read.doors import open_side
from typedcan.databases.dbc import FORMATS, read_dbc
from typedcan.model.errors import TypedcanError


class Outcome(Enum):
    """What became of a file."""

    SOUND = "packages imported and right"
    REFUSED = "refused, by cantools too"
    ALONE = "refused, but read by cantools"
    FAILED = "FAILED"


@dataclass(frozen=True, slots=True)
class Result:
    """A file, what became of it and why, and how many messages and values of columns were equal."""

    path: Path
    outcome: Outcome
    why: str = ""
    messages: int = 0
    values: int = 0


def databases_in(folder: Path) -> list[Path]:
    """The files of known formats in a folder, at any depth."""
    files = (path for path in folder.rglob("*") if path.suffix.lower() in FORMATS)
    return sorted(path for path in files if path.is_file())


def tried(paths: Iterable[Path], *, jobs: int = 2, seconds: float = 600) -> Iterator[Result]:
    """What becomes of each file, in their order."""
    with ProcessPoolExecutor(jobs, initializer=logging.disable) as pool:
        yield from pool.map(partial(try_one, seconds=seconds), paths)


def try_one(path: Path, *, seconds: float = 600) -> Result:
    """Make a package of a file, try it in another process, and its columns here."""
    name = package_name(path.stem)
    try:
        protocol = open_side(str(path)).protocol
        files = foreign_artifacts(protocol, name)
    except TypedcanError as error:
        return Result(path, _refusal(path), error.lines[0])
    except Exception as error:  # noqa: BLE001 - that is what is looked for
        return Result(path, Outcome.FAILED, f"not generated: {error!r}")
    with tempfile.TemporaryDirectory() as folder:
        for file, data in files.items():
            (Path(folder) / file).parent.mkdir(exist_ok=True)
            (Path(folder) / file).write_bytes(data)
        database = Path(folder) / f"{name}.dbc"
        fault = _package_fault(folder, name, database, seconds)
        if fault:
            return Result(path, Outcome.FAILED, fault)
        try:
            values, faults = column_faults(read_dbc(database, "utf-8"), _loaded(database))
        except Exception as error:  # noqa: BLE001 - that is what is looked for
            return Result(path, Outcome.FAILED, f"no columns: {error!r}")
    if faults:
        return Result(path, Outcome.FAILED, f"columns: {faults[0]} ({len(faults)} in all)")
    return Result(path, Outcome.SOUND, messages=len(protocol.messages), values=values)


def _package_fault(folder: str, name: str, database: Path, seconds: float) -> str:
    program = ["-m", "typedcan.trial", folder, name, str(database)]
    try:
        done = subprocess.run(
            [sys.executable, *program],
            capture_output=True,
            text=True,
            check=False,
            timeout=seconds,
        )
    except subprocess.TimeoutExpired:
        return f"no answer in {seconds} s"
    said = [*done.stdout.splitlines(), *done.stderr.splitlines()[-1:]]
    return "; ".join(said[:3]) + f" ({len(said)} in all)" if done.returncode else ""


def _loaded(path: Path) -> ByIdentifier:
    database = cantools.database.load_file(path, encoding="utf-8", strict=False)
    if not isinstance(database, Database):
        raise TypeError(f"{path}: is no CAN database")
    return {(each.is_extended_frame, each.frame_id): each for each in database.messages}


def _refusal(path: Path) -> Outcome:
    """Whether cantools refuses a file too."""
    try:
        cantools.database.load_file(path, strict=False)
    except Exception:  # noqa: BLE001 - cantools raises whatever its readers do
        return Outcome.REFUSED
    return Outcome.ALONE
