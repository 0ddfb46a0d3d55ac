"""The wheel: built from this tree, installed into an empty virtual environment, and used there."""

from __future__ import annotations

import subprocess
import sys
import venv
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "pip", "wheel", "-q", "--no-deps", "-w", str(folder), str(ROOT)],
        check=True,
    )
    return next(folder.glob("*.whl"))


def test_the_wheel_has_all_packages_their_data_and_no_tests(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    assert {
        "typedcan/py.typed",
        "swapcan/py.typed",
        "swapcan/_generated/caamtb-swap.dbc",
        "swapcan/_generated/messages.py",
        "dbcspec/emit/templates/dbc.j2",
        "dbcspec/cli.py",
    } <= names
    tops = {name.split("/")[0] for name in names if ".dist-info" not in name}
    assert tops == {"typedcan", "swapcan", "dbcspec"}


def test_the_installed_wheel_decodes_with_its_own_dbc(wheel: Path, tmp_path: Path) -> None:
    venv.create(tmp_path / "venv", with_pip=True)
    scripts = tmp_path / "venv" / ("Scripts" if sys.platform == "win32" else "bin")
    python = str(scripts / "python")
    subprocess.run([python, "-m", "pip", "install", "-q", str(wheel)], check=True, cwd=tmp_path)
    program = "import swapcan; print(swapcan.decode(0x1882D0F3, bytes([200] + [0] * 7)).soc)"
    done = subprocess.run(
        [python, "-c", program],
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path,
    )
    assert done.stdout.strip() == "80.0"
    missing = subprocess.run(
        [str(scripts / "dbcspec"), "check"],
        capture_output=True,
        text=True,
        check=False,
        cwd=tmp_path,
    )
    assert missing.returncode == 2
    assert "swapcan[generator]" in missing.stderr
    assert "Traceback" not in missing.stderr
