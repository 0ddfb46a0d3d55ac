"""What all tests share: the project under test, and payloads that are the same on every run."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import settings

from dbcspec.config import find_config
from dbcspec.model import Protocol
from dbcspec.project import Project, load

# Many tests run commands as processes of their own: let those keep their bytecode.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

settings.register_profile(
    "repeatable", derandomize=True, database=None, deadline=None, max_examples=100
)
settings.load_profile("repeatable")


@pytest.fixture(scope="session")
def root() -> Path:
    """The folder of the checkout."""
    return Path(__file__).parent.parent


@pytest.fixture(scope="session")
def project(root: Path) -> Project:
    """The project's own spec, read, corrected and resolved."""
    return load(find_config(root))


@pytest.fixture(scope="session")
def protocol(project: Project) -> Protocol:
    """The model of the project's own spec."""
    return project.protocol
