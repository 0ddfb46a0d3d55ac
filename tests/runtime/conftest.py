"""The command line as users start it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import swapcan

SOURCE = Path(swapcan.__file__).parents[1]


@pytest.fixture
def environment() -> dict[str, str]:
    """For processes: the package under test, and nothing that changes it or python-can."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith("CAN_") and name != "PYTHONUNBUFFERED"
    }
    paths = [str(SOURCE), *filter(None, [os.environ.get("PYTHONPATH")])]
    return kept | {"PYTHONPATH": os.pathsep.join(paths)}


@pytest.fixture
def swapcan_command(environment: dict[str, str]) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs `python -m swapcan` to its end."""

    def run(*arguments: str, **variables: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "swapcan", *arguments],
            env=environment | variables,
            capture_output=True,
            encoding="utf-8",
            timeout=30,
            check=False,
        )

    return run
