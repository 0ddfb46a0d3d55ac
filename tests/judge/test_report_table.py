"""The CSV report, read back."""

from __future__ import annotations

import csv
import io
from dataclasses import replace

import pytest
from judge.report_samples import EMPTY, GOOD, HOSTILE, PLAIN, hostile

from swapcan.conform import Judgement
from typedcan.judge.report import to_csv


def rows(*judgements: Judgement) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(to_csv(judgements, "en"), newline=""), strict=True))


def test_every_occurrence_is_a_row() -> None:
    found = rows(PLAIN, GOOD, EMPTY)
    assert [(row["rule"], row["severity"]) for row in found] == [
        ("answer-in-time", "must"),
        ("answer-in-time", "must"),
        ("period-mean", "should"),
        ("spare-bits", "info"),
        *[("never-seen", "must")] * 3,
    ]
    assert [row["status"] for row in found[:4]] == ["failed", "failed", "failed", "noted"]
    assert found[0] == {
        "log": "drive.blf",
        "rule": "answer-in-time",
        "severity": "must",
        "clause": "5.2.1, Table 14 row 3",
        "node": "BMU",
        "message": "B2V_ST2",
        "signal": "B2V_ST2_SOC",
        "detail": "frame 3",
        "start": "2.500000",
        "end": "2.750000",
        "start_utc": "2023-11-14T22:13:22.500000Z",
        "order": "250",
        "frames": "3",
        "measure": "1",
        "text": "step of 0.25 s",
        "status": "failed",
    }


def test_a_rule_that_was_not_judged_is_a_row_with_its_reason() -> None:
    (row,) = [each for each in rows(GOOD) if each["status"] == "not_judged"]
    assert row["rule"] == "never-seen"
    assert "nothing came that it could examine" in row["text"]
    assert {row[name] for name in ("node", "start", "end", "order", "frames", "measure")} == {""}


def test_a_log_without_dates_has_none() -> None:
    assert rows(replace(PLAIN, begin=1e8))[0]["start_utc"] == "1973-03-03T09:46:42.500000Z"
    assert rows(replace(PLAIN, begin=99_999_999.0))[0]["start_utc"] == ""


def test_lines_end_alike_and_names_come_first() -> None:
    text = to_csv([GOOD], "en")
    assert text.count("\n") == 2
    assert "\r" not in text
    assert text.startswith("log,rule,severity,")


@pytest.mark.parametrize("text", HOSTILE)
def test_any_text_arrives_on_one_line_with_what_can_be_seen_of_it(text: str) -> None:
    (row,) = rows(hostile(text))
    assert len(to_csv([hostile(text)], "en").splitlines()) == 2
    for cell in (row["log"], row["clause"], row["signal"], row["text"]):
        assert all(each in cell for each in text if each.isprintable())


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@SUM(A1)", '=HYPERLINK("x")'])
def test_no_cell_is_taken_for_a_formula(text: str) -> None:
    (row,) = rows(hostile(text))
    assert row["log"] == row["clause"] == row["message"] == f"'{text}"
    assert not [cell for cell in row.values() if cell.startswith(("=", "+", "-", "@"))]
