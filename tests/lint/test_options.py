"""What a project asks of the linter: rules, waivers and limits, and where it may say so."""

from __future__ import annotations

from pathlib import Path

import pytest

from dbcspec.config import find_config, read_lint_config
from dbcspec.lint.options import Options
from dbcspec.lint.registry import ALL_RULES
from dbcspec.lint.rule import Finding, Settings, Subject, Waiver
from dbcspec.lint.run import lint_with
from typedcan.model.errors import Location, ReadError
from typedcan.model.protocol import Message, Protocol

HERE = Location("pyproject.toml", 3)


def lint_rules(*select: str, ignore: tuple[str, ...] = ()) -> set[str]:
    return {rule.id for rule in Options(select=select, ignore=ignore).rules()}


def findings(options: Options) -> list[Finding]:
    """Of a protocol whose two messages have a sender that is no node."""
    messages = tuple(
        Message(name=name, english="x", frame_id=number, length=8, sender="GONE")
        for number, name in enumerate(("STATE", "LIMITS"))
    )
    return lint_with(Subject(protocol=Protocol(name="x", messages=messages)), options)


def waiver(rule: str = "node-declared", subject: str = "GONE", message: str = "*") -> Waiver:
    return Waiver(rule=rule, subject=subject, reason="because", where=HERE, message=message)


def read(folder: Path, toml: str) -> Options:
    path = folder / "lint.toml"
    path.write_text(toml, "utf-8")
    return read_lint_config(path)


def test_unasked_all_rules_run_but_those_that_only_some_files_mean() -> None:
    opt_in = {"pgn-unique", "broadcast-receivers"}
    assert {rule.id for rule in Options().rules()} == {rule.id for rule in ALL_RULES} - opt_in


def test_rules_are_selected_by_group_and_by_name_and_ignored_from_these() -> None:
    everything = {rule.id for rule in ALL_RULES}
    assert lint_rules("ALL") == everything
    assert lint_rules("name-case", "bus-load") == {"name-case", "bus-load"}
    assert lint_rules("DEFAULT", "pgn-unique") == everything - {"broadcast-receivers"}
    assert lint_rules("ALL", ignore=("name-case",)) == everything - {"name-case"}
    assert lint_rules("ALL", ignore=("DEFAULT",)) == {"pgn-unique", "broadcast-receivers"}


def test_only_selected_rules_run() -> None:
    assert {each.rule for each in findings(Options())} == {"node-declared"}
    assert findings(Options(ignore=("node-declared",))) == []


def test_a_waiver_accepts_a_subject_with_wildcards() -> None:
    assert findings(Options(waivers=(waiver(subject="G*"),))) == []


def test_a_waiver_of_one_message_leaves_the_others() -> None:
    left = findings(Options(waivers=(waiver(message="ST*"),)))
    assert [(each.rule, each.message) for each in left] == [("node-declared", "LIMITS")]


def test_a_waiver_that_accepts_nothing_is_a_finding_unless_its_rule_did_not_run() -> None:
    idle = waiver(rule="bus-load")
    unused = [each for each in findings(Options(waivers=(idle,))) if each.rule == "waiver-used"]
    assert [(each.where, each.subject) for each in unused] == [(HERE, "GONE")]
    kept = Options(ignore=("bus-load", "node-declared"), waivers=(idle,))
    assert findings(kept) == []


def test_a_file_of_its_own_has_the_same_tables(tmp_path: Path) -> None:
    tables = (
        '[{0}lint]\nselect = ["ALL"]\nignore = ["name-case"]\nbus_load = 50\nunits = ["apples"]\n'
        '[[{0}waivers]]\nrule = "bus-load"\nsubject = "b*"\nmessage = "M"\nreason = "because"\n'
    )
    own = read(tmp_path, tables.format(""))
    assert own == Options(
        select=("ALL",),
        ignore=("name-case",),
        waivers=(Waiver("bus-load", "b*", "because", Location("lint.toml", 6), "M"),),
        settings=Settings(bus_load=50, units=frozenset({"apples"})),
    )
    prefix = "tool.dbcspec."
    assert read(tmp_path, tables.format(prefix)) == own
    (tmp_path / "pyproject.toml").write_text(
        '[tool.dbcspec]\nname = "x"\n' + tables.format(prefix), "utf-8"
    )
    project = find_config(tmp_path)
    assert (project.lint.select, project.lint.settings) == (own.select, own.settings)
    assert [each.where.line for each in project.waivers] == [8]


def test_an_empty_file_asks_for_what_runs_unasked(tmp_path: Path) -> None:
    assert read(tmp_path, "") == Options()


@pytest.mark.parametrize(
    ("toml", "fault"),
    [
        ("[lint]\nselect = ['bus-laod']", "there is no rule 'bus-laod'; did you mean 'bus-load'?"),
        ("[lint]\nignore = ['xyz']", "there is no rule 'xyz'"),
        ("[lint]\nselect = 'ALL'", "select must be a list of texts"),
        ("[lint]\nselect = [1]", "select must be a list of texts"),
        ("[lint]\nunits = 'km'", "units must be a list of texts"),
        ("[lint]\nbus_load = 0", "bus_load must be a percentage"),
        ("[lint]\nbus_load = 101", "bus_load must be a percentage"),
        ("[lint]\nbus_load = nan", "bus_load must be a percentage"),
        ("[lint]\nbus_load = true", "bus_load must be a percentage"),
        ("[lint]\nbusload = 5", "unknown key 'busload'"),
        ("lint = 5", "lint must be a table"),
        ("[lnit]", "unknown key 'lnit'"),
        ("waivers = {a = 1}", "waivers must be tables"),
        (
            "[[waivers]]\nrule = 'bus-load'\nsubject = 'x'",
            "waiver 1 needs rule, subject and reason",
        ),
        (
            "[[waivers]]\nrule = 'bus-laod'\nsubject = 'x'\nreason = 'y'",
            "waiver 1 is of no use: there is no rule 'bus-laod'",
        ),
        (
            "[[waivers]]\nrule = 'ALL'\nsubject = 'x'\nreason = 'y'",
            "waiver 1 is of no use: there is no rule 'ALL'",
        ),
        ("[[waivers", "lint.toml: "),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(toml: str, fault: str, tmp_path: Path) -> None:
    with pytest.raises(ReadError) as caught:
        read(tmp_path, toml)
    assert fault in str(caught.value)
    assert str(tmp_path / "lint.toml") in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"none\.toml"):
        read_lint_config(tmp_path / "none.toml")
