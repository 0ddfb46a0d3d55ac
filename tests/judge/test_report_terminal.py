"""What the terminal says of a judgement."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import replace

import pytest
from judge.report_samples import DELAY, EMPTY, GOOD, HOSTILE, PLAIN, hostile, result, rule

from swapcan.conform import Judgement, Severity, Verdict
from typedcan.judge.report import overall, summary


def said(*judgements: Judgement, verbose: bool = False) -> str:
    return "\n".join(summary(judgements, "en", colour=False, verbose=verbose))


def test_each_log_begins_with_its_verdict() -> None:
    text = said(PLAIN, GOOD, EMPTY)
    first, good, empty = (
        text.index(line)
        for line in (
            "Does not conform: drive.blf\n",
            "Conforms: good.log\n",
            "Could not be judged: empty.log\n",
        )
    )
    assert first == 0 < good < empty


def test_a_failed_rule_shows_how_often_and_the_first_and_the_worst() -> None:
    lines = said(PLAIN).splitlines()
    place = lines.index("  must  answer-in-time: Title of answer-in-time")
    assert lines[place + 1 : place + 4] == [
        "    found: 1,234, frames: 3,702 (5.2.1, Table 14 row 3)",
        "    First 2.500 s  BMU B2V_ST2_SOC frame 3: step of 0.25 s",
        "    Worst 5.000 s  BMU B2V_ST2_SOC frame 3: step of 0.25 s",
    ]


def test_demands_come_before_recommendations_and_these_before_notes() -> None:
    turned = replace(PLAIN, results=PLAIN.results[::-1])
    text = said(turned)
    places = [text.index(f"  {word}  ") for word in ("must", "should", "note")]
    assert places == sorted(places)


def test_the_worst_is_left_out_where_it_is_the_first() -> None:
    (only,) = PLAIN.results[1].occurrences
    judgement = replace(PLAIN, results=(result(rule("late", Severity.MUST, DELAY), only),))
    assert "First 1.000 s" in said(judgement)
    assert "Worst" not in said(judgement)


def test_what_was_not_judged_is_counted_and_named_when_asked() -> None:
    assert "Rules passed: 1, not judged: 1" in said(PLAIN)
    assert "never-seen" not in said(PLAIN)
    assert "lacked a message: never-seen" in " ".join(said(PLAIN, verbose=True).split())
    assert "passed: checksum" in said(PLAIN, verbose=True)
    assert "Judged, but not seen: VCU" in said(PLAIN)
    assert "damaged at byte 17" in said(PLAIN)


def test_the_load_stands_beside_what_is_expected() -> None:
    expected = (
        "  Bus load on can0: 25.0 % measured, 21.0 % expected; with all stuff bits 30.0 %, 26.0 %"
    )
    assert expected in said(PLAIN).splitlines()
    unnamed = replace(PLAIN, load=(replace(PLAIN.load[0], channel=""),))
    assert "Bus load on (unnamed): 25.0 % measured" in said(unnamed)


@pytest.mark.parametrize(
    ("judgements", "verdict", "last"),
    [
        ([GOOD], Verdict.CONFORMS, "Exit status 0: every log conforms."),
        ([GOOD, PLAIN, EMPTY], Verdict.VIOLATES, "Exit status 1: a log does not conform."),
        (
            [GOOD, EMPTY],
            Verdict.NOT_JUDGED,
            "Exit status 2: a log could not be judged, or not all of it.",
        ),
    ],
)
def test_the_last_line_says_what_the_exit_status_means(
    judgements: list[Judgement], verdict: Verdict, last: str
) -> None:
    assert overall(judgements) is verdict
    assert said(*judgements).splitlines()[-1] == last


def test_the_exit_status_may_be_graver_than_the_verdict() -> None:
    (*_, last) = summary([GOOD], "en", colour=False, status=1)
    assert last == "Exit status 1: a log does not conform."


def test_colours_change_nothing_but_colours() -> None:
    coloured = "\n".join(summary([PLAIN], "en", colour=True))
    assert re.sub(r"\x1b\[[0-9;]*m", "", coloured) == said(PLAIN)
    assert coloured.startswith("\x1b[1;31mDoes not conform\x1b[0m")


@pytest.mark.parametrize("text", HOSTILE)
def test_no_text_reaches_the_terminal_as_a_control_sequence(text: str) -> None:
    for line in summary([hostile(text)], "zh", colour=False, verbose=True):
        assert not [each for each in line if unicodedata.category(each) in ("Cc", "Cf", "Cs")]


def test_long_texts_are_wrapped() -> None:
    long = replace(PLAIN, damage=("many words " * 60,))
    assert max(map(len, said(long).splitlines())) <= 100


def test_all_of_it_is_in_chinese_where_that_is_asked_for() -> None:
    text = "\n".join(summary([PLAIN, GOOD, EMPTY], "zh", colour=False))
    for word in ("不符合标准：drive.blf", "符合标准：good.log", "首次 2.500 s", "退出码 1"):
        assert word in text
    assert not re.search(r"\b(found|First|must|Bus load|passed)\b", text)
