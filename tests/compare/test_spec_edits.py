"""One edit of a spec is one finding, though much in the model follows from it."""

from __future__ import annotations

import dataclasses
import re
import shutil
from pathlib import Path

import pytest

from dbcspec.compare.run import compare
from dbcspec.config import Config
from dbcspec.project import load
from typedcan.model.protocol import Aspect, Protocol
from typedcan.report.item import Item

BASE = Path(__file__).with_name("cases") / "bus-present" / "previous"
ACTS = "acts:\n  - {signal: LAMP, codes: [15], safe: 0, cite: here}\nrequests:"
TIMING = "timing:\n  - {name: always, condition: always, messages: [STATE]}\n"


def protocol(folder: Path, *edits: tuple[str, str]) -> Protocol:
    """The small spec, with each pattern replaced in all its files; it must be in one at least."""
    shutil.copytree(BASE, folder)
    files = sorted(folder.rglob("*.yaml"))
    with (folder / "behaviour.yaml").open("a", encoding="utf-8") as behaviour:
        behaviour.write(TIMING)
    for pattern, new in edits:
        texts = {path: path.read_text("utf-8") for path in files}
        changed = {path: re.sub(pattern, new, text) for path, text in texts.items()}
        assert changed != texts, pattern
        for path, text in changed.items():
            path.write_text(text, "utf-8")
    return load(Config(root=folder.parent, name="case", spec=folder.name)).protocol


def findings(folder: Path, *edits: tuple[str, str]) -> list[Item]:
    return compare(protocol(folder / "old"), protocol(folder / "new", *edits))


def word(old: str, new: str) -> tuple[str, str]:
    return rf"\b{old}\b", new


@pytest.mark.parametrize(
    ("edits", "rule", "subject"),
    [
        ([word("SUM", "CRC")], "signal-name-same", "CRC"),
        ([word("ALIVE", "LIFE")], "signal-name-same", "LIFE"),
        ([word("FIRST", "BEGIN")], "signal-name-same", "BEGIN"),
        ([word("ASK", "WANT")], "signal-name-same", "WANT"),
        ([word("TEXT", "WORDS")], "message-name-same", "WORDS"),
        ([word("HMI", "DISPLAY")], "node-name-same", "DISPLAY"),
        ([("period: 100", "period: 200")], "message-period-same", "STATE"),
        ([("On, 15: Signal Invalid", "On, 15: Broken")], "code-meaning-same", "LAMP"),
        ([(", 15: Signal Invalid", "")], "signal-invalid-code-same", "LAMP"),
        ([("LampState", "LampCode")], "value-table-name-same", "LAMP"),
        ([("condition: always", "condition: sometimes")], "comment-same", "STATE"),
        ([("title: 灯", "title: 车灯")], "comment-same", "LAMP"),
        ([("0x18FF0001", "0x18FF0009")], "message-identifier-same", "STATE"),
        ([(r"\bxor\b", "crc8")], "message-checksum-same", "STATE"),
        ([("items: .FIRST, SECOND.", "items: [SECOND, FIRST]")], "transfer-layout-same", "text"),
        ([("bit_rate: 250000", "bit_rate: 500000")], "bus-bit-rate-same", "body"),
        ([("requests:", ACTS)], "signal-acts-same", "LAMP"),
        (
            [
                (r" +- \{name: SUM,.*\n", ""),
                (r" +- \{no: 1, .*\n", ""),
                (r"checksums:\n.*\n", ""),
            ],
            "signal-present",
            "SUM",
        ),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_follows_from_an_edit_is_not_told_again(
    edits: list[tuple[str, str]], rule: str, subject: str, tmp_path: Path
) -> None:
    found = [(item.rule, item.subject) for item in findings(tmp_path, *edits)]
    assert found == [(rule, subject)]


@pytest.mark.parametrize(
    ("edit", "rule", "text"),
    [
        (("safe: 0", "safe: 1"), "signal-acts-same", "codes that act 15 as command, safe 0 → "),
        (("cite: here", "cite: there"), "reference-same", "acts by here → "),
    ],
)
def test_another_safe_code_or_clause_of_what_acts_is_told_once(
    edit: tuple[str, str], rule: str, text: str, tmp_path: Path
) -> None:
    old = protocol(tmp_path / "old", ("requests:", ACTS))
    [item] = compare(old, protocol(tmp_path / "new", ("requests:", ACTS), edit))
    assert (item.rule, item.subject) == (rule, "LAMP")
    assert text in item.text


def test_a_start_value_that_does_not_follow_from_what_acts_is_told_as_well(tmp_path: Path) -> None:
    fixed = ("name: LAMP, length: 4, start: 12", "name: LAMP, length: 4, start: 12, initial: 3")
    items = findings(tmp_path, ("requests:", ACTS), fixed)
    assert {item.rule for item in items} == {"signal-acts-same", "signal-start-value-same"}


@pytest.mark.parametrize(
    ("edit", "silent"),
    [
        (("requests:", ACTS), Aspect.ACTS),
        (("1: On, 15: Signal Invalid", "1: Signal Invalid, 15: On"), Aspect.PROTECTION),
    ],
)
def test_a_start_value_is_told_where_one_side_does_not_say_what_it_follows_from(
    edit: tuple[str, str], silent: Aspect, tmp_path: Path
) -> None:
    old, new = protocol(tmp_path / "old"), protocol(tmp_path / "new", edit)
    told = {item.rule for item in compare(old, new)}
    assert "signal-start-value-same" not in told
    old = dataclasses.replace(old, carries=frozenset(Aspect) - {silent})
    for items in (compare(old, new), compare(new, old)):
        assert "signal-start-value-same" in {item.rule for item in items}


def test_a_new_name_of_a_node_that_nothing_tells_of_is_another_node(tmp_path: Path) -> None:
    items = findings(tmp_path, word("LOG", "RECORDER"))
    assert {(item.rule, item.subject) for item in items} == {
        ("node-present", "LOG"),
        ("node-added", "RECORDER"),
    }


def test_the_same_change_of_codes_that_signals_share_is_told_once(tmp_path: Path) -> None:
    same = 'route: "ECU>HMI", codes: {0: Off, 1: On}}'
    shared = (r'(name: (?:FIRST|SECOND), .*)route: "ECU>HMI"\}', rf"\1{same}")
    old = protocol(tmp_path / "old", shared)
    new = protocol(tmp_path / "new", shared, ("1: On}", "1: Bright}"))
    (item,) = compare(old, new)
    assert (item.rule, item.subject) == ("code-meaning-same", "FIRST")
    assert item.text.endswith("also of 1 more signal")


def test_signals_renamed_and_moved_are_gone_and_new(tmp_path: Path) -> None:
    items = findings(
        tmp_path,
        ("name: SECOND, length: 8, start: 16", "name: THIRD, length: 8, start: 24"),
        word("SECOND", "THIRD"),
    )
    rules = {(item.rule, item.subject) for item in items}
    assert {("signal-present", "SECOND"), ("signal-added", "THIRD")} <= rules


def test_a_message_renamed_under_another_identifier_is_gone_and_new(tmp_path: Path) -> None:
    items = findings(tmp_path, word("TEXT", "WORDS"), ("0x18FF0002", "0x18FF0003"))
    rules = {(item.rule, item.subject) for item in items}
    assert {("message-present", "TEXT"), ("message-added", "WORDS")} <= rules
