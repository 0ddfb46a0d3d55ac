"""A session on a clock set by hand, and the command line as users start it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from monitor.monitored import Monitored

import swapcan


@pytest.fixture
def monitored() -> Monitored:
    """A session that began at 0 s and heard nothing."""
    return Monitored()


@pytest.fixture
def environment() -> dict[str, str]:
    """For processes: the package under test, and nothing that changes it or python-can."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith("CAN_")
        and name not in ("PYTHONUNBUFFERED", "NO_COLOR", "COLUMNS", "LINES")
    }
    source = str(Path(swapcan.__file__).parents[1])
    return kept | {"PYTHONPATH": os.pathsep.join(filter(None, [source, kept.get("PYTHONPATH")]))}
