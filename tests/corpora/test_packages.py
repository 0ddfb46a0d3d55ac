"""A short version of the long run: databases that installed packages ship, and our own examples."""

from __future__ import annotations

from importlib.metadata import distributions
from pathlib import Path

import pytest

from corpora.packages import Outcome, databases_in, try_one

FIXTURES = Path(__file__).parent.parent / "fixtures"
KINDS = {".dbc", ".kcd", ".sym", ".arxml"}


def shipped() -> list[Path]:
    """The databases in installed packages; our own are tried elsewhere."""
    found = {
        Path(str(each.locate_file(file)))
        for each in distributions()
        if each.name != "swapcan"
        for file in each.files or ()
        if file.suffix.lower() in KINDS
    }
    return sorted(found)


OURS = [*databases_in(FIXTURES / "dbc"), *databases_in(FIXTURES / "other")]


@pytest.mark.parametrize("path", OURS, ids=lambda path: path.name)
def test_the_package_of_a_database_loads_and_does_what_cantools_does(path: Path) -> None:
    result = try_one(path)
    assert result.outcome is Outcome.SOUND, result.why


@pytest.mark.parametrize("path", shipped(), ids=lambda path: path.name)
def test_no_database_of_others_becomes_a_package_that_fails(path: Path) -> None:
    result = try_one(path)
    assert result.outcome is not Outcome.FAILED, result.why


def test_there_is_a_database_that_somebody_else_made() -> None:
    assert shipped()


def test_what_is_no_database_is_refused_with_a_reason(tmp_path: Path) -> None:
    path = tmp_path / "text.dbc"
    path.write_text("these are no messages")
    result = try_one(path)
    assert result.outcome is Outcome.REFUSED
    assert result.why.startswith(str(path))
