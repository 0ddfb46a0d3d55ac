"""Accepted findings: taken out, unless the approval itself is at fault."""

from __future__ import annotations

import datetime
import errno
import os
from pathlib import Path

import pytest

from dbcspec.compare.approvals import APPROVAL_USED, Approval, apply_approvals, read_approvals
from typedcan.model.errors import Location, ReadError
from typedcan.report.item import Item

FACTOR = Item(
    rule="signal-scale-same",
    level="wire",
    group="Motion",
    subject="Speed",
    text="factor 0.1 → 1",
    where=Location("new.dbc", 12),
    old="0.1",
    new="1",
)
UNIT = Item(
    rule="signal-unit-same",
    level="wire",
    group="Motion",
    subject="Speed",
    text="unit km/h → mph",
    where=Location("new.dbc", 12),
    old="km/h",
    new="mph",
)
REASON = 'reason = "Measured again."\ndate = 2031-04-30\n'


def approvals(folder: Path, text: str) -> tuple[Approval, ...]:
    path = folder / "approvals.toml"
    path.write_text(text, "utf-8")
    return read_approvals(path, "approvals.toml")


def accepted(fingerprint: str, more: str = REASON) -> str:
    return f'[[accepted]]\nfingerprint = "{fingerprint}"\n{more}'


def fault(folder: Path, text: str) -> str:
    with pytest.raises(ReadError) as caught:
        approvals(folder, text)
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_an_accepted_finding_is_taken_out_and_others_stay(tmp_path: Path) -> None:
    found = approvals(tmp_path, accepted(FACTOR.fingerprint))
    assert apply_approvals([FACTOR, UNIT], found) == [UNIT]


def test_an_approval_holds_when_only_the_line_has_moved(tmp_path: Path) -> None:
    found = approvals(tmp_path, accepted(FACTOR.fingerprint))
    moved = Item(
        rule="signal-scale-same",
        level="wire",
        group="Motion",
        subject="Speed",
        text="factor 0.1 → 1",
        where=Location("elsewhere.dbc", 99),
        old="0.1",
        new="1",
    )
    assert apply_approvals([moved], found) == []


def test_another_value_is_not_what_was_accepted(tmp_path: Path) -> None:
    found = approvals(tmp_path, accepted(FACTOR.fingerprint))
    other = Item(
        rule="signal-scale-same",
        level="wire",
        group="Motion",
        subject="Speed",
        text="factor 0.1 → 10",
        where=Location("new.dbc", 12),
        old="0.1",
        new="10",
    )
    assert other in apply_approvals([other], found)


def test_an_approval_that_matches_nothing_is_an_error_at_its_own_line(tmp_path: Path) -> None:
    text = "# Accepted for the pilot.\n\n" + accepted(FACTOR.fingerprint) + accepted("00000000")
    (stale,) = apply_approvals([FACTOR], approvals(tmp_path, text))
    assert (stale.rule, stale.level) == (APPROVAL_USED.id, "error")
    assert "00000000" in stale.text
    assert stale.where == Location("approvals.toml", 7)


def test_rule_and_subject_are_for_the_reader_and_must_be_right(tmp_path: Path) -> None:
    right = REASON + 'rule = "signal-scale-same"\nsubject = "Speed"\n'
    wrong = REASON + 'rule = "signal-unit-same"\n'
    found = approvals(tmp_path, accepted(FACTOR.fingerprint, right))
    assert apply_approvals([FACTOR], found) == []
    found = approvals(tmp_path, accepted(FACTOR.fingerprint, wrong))
    rules = [item.rule for item in apply_approvals([FACTOR], found)]
    assert rules == ["signal-scale-same", "approval-used"]


def test_the_reason_and_the_date_are_kept(tmp_path: Path) -> None:
    for date in ("2031-04-30", '"2031-04-30"', "2031-04-30T10:00:00Z"):
        (found,) = approvals(tmp_path, accepted("0a1b2c3d", f'reason = "So."\ndate = {date}\n'))
        assert found.reason == "So."
        assert found.date == datetime.date(2031, 4, 30)


def test_a_file_without_approvals_has_none(tmp_path: Path) -> None:
    assert approvals(tmp_path, "") == ()


@pytest.mark.parametrize("key", ["fingerprint", "reason", "date"])
def test_what_is_missing_is_named_with_the_line_of_the_approval(key: str, tmp_path: Path) -> None:
    complete = accepted("0a1b2c3d").splitlines(keepends=True)
    text = "\n" + "".join(line for line in complete if not line.startswith(key))
    message = fault(tmp_path, text)
    assert message.startswith("approvals.toml:2:1: ")
    assert f"{key} is missing" in message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (accepted("0a1b2c3d", 'reason = ""\ndate = 2031-04-30\n'), "reason is missing"),
        (accepted("0a1b2c3d", 'reason = "  "\ndate = 2031-04-30\n'), "reason must be text"),
        (accepted("0a1b2c3d", "reason = 5\ndate = 2031-04-30\n"), "reason must be text"),
        (accepted("0a1b2c3d", 'reason = "So."\ndate = "soon"\n'), "date must be"),
        (accepted("0a1b2c3d", 'reason = "So."\ndate = 5\n'), "date must be"),
        (accepted("0A1B"), "fingerprint is 8"),
        (accepted("0a1b2c3d", REASON + "who = 1\n"), "unknown key 'who'"),
        (accepted("0a1b2c3d") + accepted("0a1b2c3d"), "accepted in line 1 already"),
        ("[accepted]\n" + REASON, "write [[accepted]]"),
        ("accepted = [1]\n", "write [[accepted]]"),
        ("[[approved]]\n" + REASON, "unknown key 'approved'"),
        ("[[accepted\n", "is not TOML: "),
    ],
)
def test_a_fault_is_one_line_that_says_what_to_do(text: str, words: str, tmp_path: Path) -> None:
    message = fault(tmp_path, text)
    assert message.startswith("approvals.toml:")
    assert words in message


def test_a_file_that_is_not_there_or_not_text_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=f"^none.toml: {os.strerror(errno.ENOENT)}$"):
        read_approvals(tmp_path / "none.toml", "none.toml")
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ReadError, match=r"^binary\.toml: is not UTF-8"):
        read_approvals(tmp_path / "binary.toml", "binary.toml")
