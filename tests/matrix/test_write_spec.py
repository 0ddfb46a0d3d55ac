"""A changed model becomes a change of the spec: exact lines, nothing else."""

from __future__ import annotations

from decimal import Decimal
from pathlib import Path
from typing import Any

import pytest
from matrix.small_spec import applied, changed, codes, lines, model

from dbcspec.spec.write import Proposal, propose_spec
from typedcan.model.protocol import Protocol


def test_without_a_change_nothing_is_proposed(spec: Path) -> None:
    assert propose_spec(spec, model(spec), model(spec)) == Proposal({}, ())


def test_without_a_change_nothing_is_proposed_for_the_project(
    root: Path, protocol: Protocol, project_back: Protocol
) -> None:
    assert propose_spec(root / "spec", protocol, project_back) == Proposal({}, ())


@pytest.mark.parametrize(
    ("signal", "values", "wanted"),
    [
        ("Temp", {"factor": Decimal("0.25")}, ["-    factor:   0.5", "+    factor:   0.25"]),
        ("Temp", {"offset": Decimal("-50.5")}, ["-    offset: -40", "+    offset: -50.5"]),
        ("Temp", {"unit": "V"}, ["-    unit: ℃", "+    unit: V"]),
        ("Mode", {"unit": "%"}, ['-    unit: ""', '+    unit: "%"']),
        ("Mode", {"unit": "degC"}, ['-    unit: ""', "+    unit: ℃"]),
        ("Temp", {"maximum": Decimal("1E+2")}, ["-    range: -40~87.5", "+    range: -40~100"]),
        (
            "Temp",
            {"title": "温度: 新 # 1"},
            ["-    title: '温度'  # as printed", '+    title: "温度: 新 # 1"  # as printed'],
        ),
        (
            "Temp",
            {"english": "Pack, hot"},
            [
                "-    english: >-",
                "-      Temperature",
                "-      of the pack",
                '+    english: "Pack, hot"',
            ],
        ),
        ("Mode", {"title": "模式"}, ["+    title: 模式"]),
        (
            "Temp",
            {"start": 16},
            [
                "-      - {name: Temp, length: 8, start: 0}   # in front",
                "+      - {name: Temp, length: 8, start: 16}   # in front",
            ],
        ),
        ("Temp", {"receivers": ("B", "A")}, ["-    route: A>B", "+    route: A>B,A"]),
    ],
)
def test_a_changed_value_changes_in_its_place_and_nowhere_else(
    signal: str, values: dict[str, Any], wanted: list[str], spec: Path
) -> None:
    old = model(spec)
    proposal = propose_spec(spec, old, changed(old, {signal: values}))
    assert lines(spec, proposal) == wanted
    assert proposal.not_written == ()


def test_a_changed_length_changes_in_annex_and_table(spec: Path) -> None:
    old = model(spec)
    new = changed(old, {"Temp": {"length": 7}})
    proposal = propose_spec(spec, old, new)
    assert lines(spec, proposal) == [
        "-      - {name: Temp, length: 8, start: 0}   # in front",
        "+      - {name: Temp, length: 7, start: 0}   # in front",
        "-    length: 8",
        "+    length: 7",
    ]


def test_facts_of_a_message_change_in_the_annex(spec: Path) -> None:
    old = model(spec)
    facts = {"period": 50, "length": 7, "frame_id": 0x18FF0003, "english": "One"}
    proposal = propose_spec(spec, old, changed(old, {}, {"First": facts}))
    assert sorted(lines(spec, proposal)) == sorted(
        [
            "-  - id: 0x18FF0001   # first",
            "+  - id: 0x18FF0003   # first",
            "+    english: One",
            "-    length: 8",
            "+    length: 7",
            "-    period: 100      # ms",
            "+    period: 50      # ms",
        ]
    )
    assert proposal.not_written == ()


def test_a_changed_label_leaves_the_other_labels_alone(spec: Path) -> None:
    old = model(spec)
    table = codes((0, "OFF"), (1, "ON"))
    proposal = propose_spec(
        spec, old, changed(old, {"Mode": {"value_table": table}, "Copy": {"value_table": table}})
    )
    assert lines(spec, proposal) == ['-      1: "on: yes"', "+      1: ON"]
    assert proposal.not_written == ()


def test_a_new_code_stands_in_its_order(spec: Path) -> None:
    old = model(spec)
    table = codes((0, "OFF"), (1, "on: yes"), (2, "no"))
    proposal = propose_spec(
        spec, old, changed(old, {"Mode": {"value_table": table}, "Copy": {"value_table": table}})
    )
    made = applied(spec, proposal)
    assert "      2: no" in (spec / "tables/01-only.yaml").read_text("utf-8").splitlines()
    [mode] = [each for _, each in made.signals() if each.name == "Mode"]
    assert mode.value_table
    assert mode.value_table.labels() == {0: "OFF", 1: "on: yes", 2: "no"}


def test_a_row_that_repeats_codes_gets_its_own_where_only_one_changes(spec: Path) -> None:
    old = model(spec)
    table = codes((0, "OFF"), (3, "three"))
    proposal = propose_spec(spec, old, changed(old, {"Mode": {"value_table": table}}))
    assert proposal.not_written == ()
    labels = {
        each.name: each.value_table.labels() if each.value_table else {}
        for _, each in applied(spec, proposal).signals()
    }
    assert labels["Mode"] == {0: "OFF", 3: "three"}
    assert labels["Copy"] == {0: "OFF", 1: "on: yes"}


@pytest.mark.parametrize(
    ("values", "what"),
    [({"offset": Decimal(5)}, "offset"), ({"maximum": Decimal(99)}, "range")],
    ids=["set", "kept"],
)
def test_what_an_erratum_settles_is_reported_and_not_written(
    values: dict[str, Any], what: str, spec: Path
) -> None:
    old = model(spec)
    proposal = propose_spec(spec, old, changed(old, {"Kept": values}))
    assert proposal.files == {}
    [line] = proposal.not_written
    assert line.startswith(f"Kept: {what} is ")
    assert line.endswith(f"tables/01-only/4: erratum E01 settles {what}; change the erratum")


@pytest.mark.parametrize(
    ("values", "word"),
    [
        ({"name": "Renamed"}, "name is Temp, not Renamed"),
        ({"signed": True}, "type is unsigned, not signed"),
        ({"is_selector": True}, "multiplexing"),
    ],
)
def test_what_the_spec_cannot_say_is_reported(
    values: dict[str, Any], word: str, spec: Path
) -> None:
    old = model(spec)
    proposal = propose_spec(spec, old, changed(old, {"Temp": values}))
    assert proposal.files == {}
    assert [word in line for line in proposal.not_written] == [True]
