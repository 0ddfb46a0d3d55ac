"""Each promise on its case folder: what compare says of previous and current is expected.txt.

A folder has ``previous.dbc`` and ``current.dbc``, or two spec folders for what no DBC can say.
Each line of expected.txt: class, promise, message (or -), subject, text and who breaks.
"""

from __future__ import annotations

import pkgutil
import re
from importlib import import_module
from pathlib import Path

import pytest

import dbcspec.compare
from dbcspec.compare.promise import Promise
from dbcspec.compare.registry import PROMISES
from dbcspec.compare.run import RULES, compare
from dbcspec.config import Config
from dbcspec.project import load
from typedcan.databases.dbc import read_dbc
from typedcan.model.protocol import Protocol
from typedcan.report.item import LEVELS, Item

CASES = Path(__file__).with_name("cases")

over_all_promises = pytest.mark.parametrize("promise", PROMISES, ids=lambda promise: promise.id)


def protocol(folder: Path, side: str) -> Protocol:
    """One side of a case."""
    file = folder / f"{side}.dbc"
    if file.is_file():
        return read_dbc(file, "utf-8", shown_as=file.name)
    return load(Config(root=folder, name="case", spec=side)).protocol


def line(item: Item) -> str:
    group = item.group or "-"
    return f"{item.level} {item.rule} {group} {item.subject}: {item.text}, breaks {item.breaks}"


@over_all_promises
def test_a_broken_promise_gives_the_expected_lines_and_no_others(promise: Promise) -> None:
    folder = CASES / promise.id
    expected = (folder / "expected.txt").read_text("utf-8").splitlines()
    assert any(f" {promise.id} " in each for each in expected)
    items = compare(protocol(folder, "previous"), protocol(folder, "current"))
    assert list(map(line, items)) == expected


@over_all_promises
def test_a_change_taken_back_is_seen_by_a_promise_of_the_same_kind(promise: Promise) -> None:
    mirrored = {"present": "added", "added": "present", "free": "present"}
    first, _, last = promise.id.rpartition("-")
    back = {
        "signal-range-not-narrowed": "signal-range-not-widened",
        "signal-range-not-widened": "signal-range-not-narrowed",
        "signal-bits-free": "signal-present",
        "reserved-signal-present": "signal-added",
    }.get(promise.id, f"{first}-{mirrored.get(last, last)}")
    folder = CASES / promise.id
    items = compare(protocol(folder, "current"), protocol(folder, "previous"))
    assert back in {item.rule for item in items}


@pytest.mark.parametrize("side", ["previous", "current"])
@over_all_promises
def test_nothing_is_different_from_itself(promise: Promise, side: str) -> None:
    folder = CASES / promise.id
    assert compare(protocol(folder, side), protocol(folder, side)) == []


def test_every_promise_has_a_case_folder_and_every_folder_a_promise() -> None:
    assert {path.name for path in CASES.iterdir()} == {promise.id for promise in PROMISES}


def test_every_module_with_a_promise_is_registered_under_the_name_of_its_file() -> None:
    modules = {
        info.name: import_module(f"dbcspec.compare.{info.name}")
        for info in pkgutil.iter_modules(dbcspec.compare.__path__)
    }
    found = {
        name.replace("_", "-"): module.PROMISE.id
        for name, module in modules.items()
        if hasattr(module, "PROMISE")
    }
    assert set(found) == set(found.values()) == {promise.id for promise in PROMISES}


def test_promise_ids_are_kebab_case_and_unique() -> None:
    ids = [promise.id for promise in PROMISES]
    assert len(ids) == len(set(ids))
    assert all(re.fullmatch(r"[a-z]+(-[a-z]+)+", promise_id) for promise_id in ids)


def test_reports_list_every_promise_gravest_class_first() -> None:
    assert [rule.id for rule in RULES] == [promise.id for promise in PROMISES]
    assert [rule.level for rule in RULES] == sorted(
        (rule.level for rule in RULES), key=LEVELS.index
    )


def test_a_finding_names_the_line_of_the_new_file_or_of_the_old_one_where_it_is_gone() -> None:
    for promise_id, side, text in (
        ("signal-scale-same", "current", " SG_ Speed "),
        ("message-length-same", "current", "BO_ 512 "),
        ("signal-present", "previous", " SG_ Torque "),
        ("message-present", "previous", "BO_ 512 "),
    ):
        folder = CASES / promise_id
        (item,) = compare(protocol(folder, "previous"), protocol(folder, "current"))
        assert item.where.path == f"{side}.dbc"
        lines = (folder / item.where.path).read_text("utf-8").splitlines()
        assert lines[item.where.line - 1].startswith(text)
