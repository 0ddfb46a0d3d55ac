"""Generated packages load wherever they lie, several in one process, without any DBC."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from dbcspec.artifacts import foreign_artifacts
from dbcspec.read.doors import open_side

CASES = Path(__file__).parent.parent / "fixtures" / "cases"

Files = dict[str, bytes]


@pytest.fixture(scope="module")
def files() -> Files:
    """Two packages with no DBC beside them: messages of both widths, and codes."""
    found: Files = {}
    for name in ("both", "gear_8"):
        protocol = open_side(str(CASES / f"{name}.dbc")).protocol
        made = foreign_artifacts(protocol, name)
        found |= {path: data for path, data in made.items() if path.startswith(f"{name}/")}
    return found


def put(folder: Path, files: Files) -> Path:
    for path, data in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
    return folder


def zipped(folder: Path, files: Files) -> Path:
    with zipfile.ZipFile(folder / "packages.zip", "w") as archive:
        for path, data in files.items():
            archive.writestr(path, data)
    return folder / "packages.zip"


def beside_modules_of_such_names(folder: Path, files: Files) -> Path:
    for name in ("messages", "model", "codec", "enums", "protocol", "bind"):
        (folder / f"{name}.py").write_text("raise SystemExit('this one is of others')\n", "utf-8")
    return put(folder, files)


PLACES: dict[str, Callable[[Path, Files], Path]] = {
    "an odd folder": lambda folder, files: put(folder / "my cars-v1.2 (新)", files),
    "a zip file": zipped,
    "a zip file, in a folder of it": lambda folder, files: (
        zipped(folder, {f"python/{path}": data for path, data in files.items()}) / "python"
    ),
    "beside modules of such names": beside_modules_of_such_names,
}

TWO = """
import sys
from importlib import import_module
from typedcan.wire.codec import Codec
names = ("both", "gear_8")
both, gear = (import_module(f"{sys.argv[1]}{name}.protocol").PROTOCOL for name in names)
short, long = both.messages
print(both, Codec(both).encode(long(right=7)).hex(), Codec(both).decode(0x100, b"\\5"))
print(gear, gear.messages[0].MODEL.signals[0].start, Codec(gear).decode(256, b"\\1" + bytes(7)))
"""
# 0x100 is asked for without a width: that of 29 bits, LONGID with its signal Right, is meant.
SAID = ["07 LONGID(right=5)", "0 GEAR_8(gear=<Gear.D: 1>)"]


def said(text: str) -> list[str]:
    """What was printed after each protocol, which is one line too."""
    lines = text.splitlines()
    assert all(line.startswith("<Protocol ") for line in lines)
    return [line.partition("> ")[2] for line in lines]


def run(path: Path, program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    known = os.environ.get("PYTHONPATH", "")
    return subprocess.run(
        [sys.executable, "-c", program, *arguments],
        capture_output=True,
        encoding="utf-8",
        check=False,
        env={**os.environ, "PYTHONPATH": f"{path}{os.pathsep}{known}", "PYTHONUTF8": "1"},
    )


@pytest.mark.parametrize("place", PLACES)
def test_two_packages_load_and_work_in(place: str, files: Files, tmp_path: Path) -> None:
    done = run(PLACES[place](tmp_path, files), TWO, "")
    assert done.returncode == 0, done.stderr
    assert said(done.stdout) == SAID


def test_packages_load_as_parts_of_another_one(files: Files, tmp_path: Path) -> None:
    put(tmp_path, {f"ours/vendor/{path}": data for path, data in files.items()})
    (tmp_path / "ours" / "__init__.py").write_text("from .vendor.both.messages import *\n", "utf-8")
    done = run(tmp_path, TWO, "ours.vendor.")
    assert done.returncode == 0, done.stderr
    assert said(done.stdout) == SAID


def test_the_command_line_takes_a_package_that_lies_in_a_zip_file(
    files: Files, tmp_path: Path
) -> None:
    (tmp_path / "drive.log").write_text("(1.0) can0 100#01\n", "ascii")
    program = "import sys; from typedcan.__main__ import main; sys.exit(main())"
    log = str(tmp_path / "drive.log")
    done = run(zipped(tmp_path, files), program, "--protocol", "both", "decode", log)
    assert done.returncode == 0, done.stderr
    assert "SHORTID  left=1" in done.stdout


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda data: None, "No such file"),
        (lambda data: b"", "protocol.json"),
        (lambda data: data[:-9], "protocol.json"),
        (lambda data: data.replace(b'"digest":"', b'"digest":"0'), "run `dbcspec generate`"),
        (lambda data: b"\xff", "protocol.json"),
    ],
)
def test_a_package_with_another_model_beside_it_is_refused(
    spoil: Callable[[bytes], bytes | None], says: str, files: Files, tmp_path: Path
) -> None:
    changed = {**files, "both/protocol.json": spoil(files["both/protocol.json"])}
    put(tmp_path, {path: data for path, data in changed.items() if data is not None})
    done = run(tmp_path, TWO, "")
    assert done.returncode == 1
    last = done.stderr.splitlines()[-1]
    assert last.startswith("typedcan.model.errors.DatabaseError: ")
    assert says in last
