"""Generated packages are tried in a process of their own before anything is written."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import typedcan
from typedcan.model.errors import ReadError

_PROGRAM = "typedcan.trial"
_SECONDS = 600


def try_package(files: Mapping[str, bytes], package: str, dbc: str) -> None:
    """Import the package that is in a folder of the files, and hold its messages against cantools.

    ``dbc`` is its DBC among the files. Raises `ReadError`, in one line, where it cannot be
    imported or a message is encoded or decoded otherwise.
    """
    folder, name = os.path.split(package)
    own = {path: data for path, data in files.items() if os.path.split(path)[0] == package}
    with tempfile.TemporaryDirectory() as temporary:
        root = Path(temporary)
        for path, data in {**own, dbc: files[dbc]}.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_bytes(data)
        faults = _run(root / folder, name, root / dbc)
    if faults:
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        raise ReadError(f"nothing is written: what is generated is wrong: {faults[0]}{more}")


def _run(folder: Path, package: str, dbc: Path) -> list[str]:
    """The faults that the program prints, a line each."""
    paths = (str(Path(typedcan.__file__).parents[1]), os.environ.get("PYTHONPATH", ""))
    # -P: what lies in the folder where the command is run must not stand before what is imported.
    command = [sys.executable, "-P", "-m", _PROGRAM, str(folder), package, str(dbc)]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            check=False,
            timeout=_SECONDS,
            env={
                **os.environ,
                "PYTHONPATH": os.pathsep.join(filter(None, paths)),
                "PYTHONIOENCODING": "utf-8",
            },
        )
    except subprocess.TimeoutExpired:
        return [f"{package}: is not imported and tried within {_SECONDS} s"]
    if done.returncode == 0:
        return []
    if done.returncode == 1 and done.stdout:
        return done.stdout.splitlines()
    return done.stderr.splitlines()[-1:] or ["it cannot be tried"]
