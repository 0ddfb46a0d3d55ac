"""A database to a package, and the package to what is wrong with it."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from enum import Enum
from functools import partial
from pathlib import Path

from dbcspec.artifacts import foreign_artifacts
from dbcspec.emit.stub_names import package_name
from dbcspec.read.doors import open_side
from typedcan.databases.dbc import FORMATS
from typedcan.model.errors import TypedcanError


class Outcome(Enum):
    """What became of a file."""

    SOUND = "packages imported and right"
    REFUSED = "refused: cantools or we cannot say the file"
    FAILED = "FAILED"


@dataclass(frozen=True, slots=True)
class Result:
    """A file, what became of it and why, and how many messages its package has.

    Of ``untold`` messages cantools decodes no payload, so that there is nothing to compare.
    """

    path: Path
    outcome: Outcome
    why: str = ""
    messages: int = 0
    untold: int = 0


def databases_in(folder: Path) -> list[Path]:
    """The files of known formats in a folder, at any depth."""
    files = (path for path in folder.rglob("*") if path.suffix.lower() in FORMATS)
    return sorted(path for path in files if path.is_file())


def tried(paths: Iterable[Path], *, jobs: int = 2, seconds: float = 600) -> Iterator[Result]:
    """What becomes of each file, in their order."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from pool.map(partial(try_one, seconds=seconds), paths)


def try_one(path: Path, *, seconds: float = 600) -> Result:
    """Make a package of a file, and import and try it in another process."""
    name = package_name(path.stem)
    try:
        protocol = open_side(str(path)).protocol
        files = foreign_artifacts(protocol, name)
    except TypedcanError as error:
        return Result(path, Outcome.REFUSED, error.lines[0])
    except Exception as error:  # noqa: BLE001 - that is what is looked for
        return Result(path, Outcome.FAILED, f"not generated: {error!r}")
    with tempfile.TemporaryDirectory() as folder:
        for file, data in files.items():
            (Path(folder) / file).parent.mkdir(exist_ok=True)
            (Path(folder) / file).write_bytes(data)
        program = ["-m", "typedcan.trial", folder, name, str(Path(folder) / f"{name}.dbc")]
        try:
            done = subprocess.run(
                [sys.executable, *program],
                capture_output=True,
                text=True,
                check=False,
                timeout=seconds,
            )
        except subprocess.TimeoutExpired:
            return Result(path, Outcome.FAILED, f"no answer in {seconds} s")
    if done.returncode:
        said = [*done.stdout.splitlines(), *done.stderr.splitlines()[-1:]]
        return Result(path, Outcome.FAILED, "; ".join(said[:3]) + f" ({len(said)} in all)")
    return Result(
        path, Outcome.SOUND, messages=len(protocol.messages), untold=len(done.stdout.splitlines())
    )
