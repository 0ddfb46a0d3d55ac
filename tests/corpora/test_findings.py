"""Findings drawn from a folder of databases: each content once, the same for a seed, with lines."""

from __future__ import annotations

from pathlib import Path

import pytest

from corpora.findings import linted, main

TEXT = 'VERSION ""\n\nBU_: AA\n\nBO_ 256 MSG: 8 AA\n'
LINES = "".join(f' SG_ S{at:02} : {8 * at}|8@1+ (1,0) [0|30{at}] "" AA\n' for at in range(8))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "a.dbc").write_text(TEXT + LINES, "utf-8")
    (tmp_path / "again.dbc").write_text(TEXT + LINES, "utf-8")
    (tmp_path / "sound.dbc").write_text(TEXT, "utf-8")
    (tmp_path / "torn.dbc").write_text(f"{TEXT} SG_ S : 0|", "utf-8")
    return tmp_path


def test_each_content_is_linted_once_and_a_refusal_keeps_nothing_back(folder: Path) -> None:
    corpus = linted(folder)
    assert corpus.rules() == {"range-fits-bits": 8}
    assert [path.name for path in corpus.refused] == ["torn.dbc"]
    assert {path.name for path in corpus.seconds} == {"a.dbc", "sound.dbc", "torn.dbc"}


def test_what_is_drawn_is_the_same_for_the_same_seed(folder: Path) -> None:
    corpus = linted(folder)
    assert corpus.drawn(3, 1) == corpus.drawn(3, 1) != corpus.drawn(3, 2)
    assert len(corpus.drawn(30, 1)) == 8


def test_what_is_drawn_is_printed_with_its_lines(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(folder), "--count", "1", "--slow", "0"]) == 0
    printed = capsys.readouterr().out
    assert "     3 files, 1 refused\n     8 range-fits-bits\n\n1. a.dbc\n" in printed
    assert " | SG_ S" in printed.replace("|  SG_", "| SG_")
    assert printed.count("slow: ") == 3
