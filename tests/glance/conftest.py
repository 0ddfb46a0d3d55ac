"""A session with the glance at a pack, on a clock set by hand."""

from __future__ import annotations

import pytest
from monitor.monitored import Monitored


@pytest.fixture
def monitored() -> Monitored:
    """A session that began at 0 s and heard nothing."""
    return Monitored()
