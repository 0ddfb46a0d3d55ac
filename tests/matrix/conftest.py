"""The project's matrix, made and read once for all tests."""

from __future__ import annotations

from pathlib import Path

import pytest
from matrix.small_spec import FILES

from dbcspec.matrix.read import read_matrix
from dbcspec.matrix.write import emit_matrix
from typedcan.model.protocol import Protocol


@pytest.fixture(scope="session")
def project_matrix(protocol: Protocol) -> bytes:
    """The bytes of the project's workbook."""
    return emit_matrix(protocol)


@pytest.fixture(scope="session")
def project_back(project_matrix: bytes, tmp_path_factory: pytest.TempPathFactory) -> Protocol:
    """The project as its workbook says it."""
    path = tmp_path_factory.mktemp("project") / "matrix.xlsx"
    path.write_bytes(project_matrix)
    return read_matrix(path)


@pytest.fixture
def spec(tmp_path: Path) -> Path:
    """The folder of the small spec."""
    folder = tmp_path / "spec"
    (folder / "tables").mkdir(parents=True)
    for name, text in FILES.items():
        (folder / name).write_bytes(text.encode())
    return folder
