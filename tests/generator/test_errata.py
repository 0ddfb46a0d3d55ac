"""Errata change what is printed, say where they did, and are refused where they change nothing."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path

import pytest
from generator.small_spec import write_spec

from dbcspec.spec.errata import apply_errata
from dbcspec.spec.folder import read_spec
from dbcspec.spec.rows import SignalRow, Spec

HEAD = "kind: typo, place: p, printed: q, reading: r, because: b"


def erratum(change: str, number: str = "E1") -> str:
    return f"  - {{id: {number}, {HEAD}, change: [{change}]}}\n"


def applied(folder: Path, *errata: str) -> tuple[Spec, list[str]]:
    spec = write_spec(folder, errata="errata:\n" + "".join(errata))
    corrected, faults = apply_errata(read_spec(spec, "spec"))
    return corrected, [str(fault) for fault in faults]


def sound(folder: Path, *changes: str) -> Spec:
    """The corrected rows, after errata that must all be applicable."""
    numbered = [erratum(change, f"E{n}") for n, change in enumerate(changes, start=1)]
    spec, faults = applied(folder, *numbered)
    assert faults == []
    return spec


def rows(spec: Spec) -> Mapping[str, SignalRow]:
    return {row.name: row for _, row in spec.rows()}


def test_set_gives_keys_new_values_and_marks_the_row(tmp_path: Path) -> None:
    spec = sound(tmp_path, "{at: [tables/01-heater/4], set: {range: -40~80, unit: K}}")
    row = rows(spec)["H_Temp"]
    assert row.range == (Decimal(-40), Decimal(80))
    assert (row.unit, row.factor, row.marks) == ("K", Decimal("0.5"), ("E1",))
    assert [row.marks for name, row in rows(spec).items() if name != "H_Temp"] == [()] * 4


def test_a_fault_in_a_corrected_value_is_looked_for_in_the_erratum(tmp_path: Path) -> None:
    spec = sound(tmp_path, "{at: [tables/01-heater/4], set: {unit: K}}")
    row = rows(spec)["H_Temp"]
    assert row.where_is("unit").path == "spec/errata.yaml"
    assert row.where_is("range").path == "spec/tables/01-heater.yaml"


def test_set_gives_a_missing_key_a_value(tmp_path: Path) -> None:
    spec = sound(tmp_path, "{at: [messages], set: {annex: B}}", "{at: [standard], set: {part: 3}}")
    assert (spec.messages.annex, spec.standard.part) == ("B", 3)


def test_a_path_may_lead_to_a_field_of_the_annex_or_an_entry_of_behaviour(tmp_path: Path) -> None:
    spec = sound(
        tmp_path,
        "{at: [messages/Heater/H_Temp], set: {start: 24}}",
        "{at: [messages/Panel], set: {byte_order: Intel}}",
        "{at: [behaviour/checksums/H_Sum], set: {bytes: 2~7}}",
        "{at: [standard/nodes/PANEL], set: {address: 0x11}}",
    )
    starts = {field.name: field.start for _, field in spec.fields()}
    assert starts["H_Temp"] == 24
    assert spec.messages.messages[1].byte_order == "Intel"
    assert spec.behaviour.checksums[0].bytes == "2~7"
    assert spec.standard.nodes[0].address == 0x11


def test_one_change_may_go_to_several_places(tmp_path: Path) -> None:
    spec = sound(tmp_path, "{at: [tables/01-heater/4, tables/02-panel/1], set: {unit: K}}")
    assert {row.name for row in rows(spec).values() if row.unit == "K"} == {
        "H_Temp",
        "P_WantedTemp",
    }


def test_a_later_erratum_sees_what_an_earlier_one_renamed(tmp_path: Path) -> None:
    spec = sound(
        tmp_path,
        "{at: [messages/Heater/H_Temp], set: {name: H_Warmth}}",
        "{at: [messages/Heater/H_Warmth], set: {start: 32}}",
    )
    field = next(field for _, field in spec.fields() if field.name == "H_Warmth")
    assert (field.start, field.marks) == (32, ("E1", "E2"))


def test_add_appends_entries_and_marks_them_but_not_their_list(tmp_path: Path) -> None:
    spec = sound(
        tmp_path,
        "{at: [behaviour], add: {counters: [{signal: H_Mode, modulus: 3}]}}",
        "{at: [standard/buses/house], add: {nodes: [THIRD]}}",
    )
    assert [counter.signal for counter in spec.behaviour.counters] == ["H_Live", "H_Mode"]
    assert [counter.marks for counter in spec.behaviour.counters] == [(), ("E1",)]
    assert spec.behaviour.marks == ()
    bus = spec.standard.buses[0]
    assert (bus.nodes, bus.marks) == (("PANEL", "HEATER", "THIRD"), ("E2",))


def test_relabel_reaches_every_row_below_its_path_and_no_other(tmp_path: Path) -> None:
    everywhere = sound(tmp_path, "{at: [tables], relabel: {Invalid: No value}}")
    assert rows(everywhere)["H_Mode"].labels == {0: "关", 1: "开", 2: "ECO", 3: "No value"}
    assert rows(everywhere)["H_Temp"].labels == {254: "Broken", 255: "No value"}
    assert [name for name, row in rows(everywhere).items() if row.marks] == ["H_Mode", "H_Temp"]
    one = sound(tmp_path, "{at: [tables/01-heater/3], relabel: {Invalid: No value}}")
    assert rows(one)["H_Temp"].labels == {254: "Broken", 255: "Invalid"}


def test_keep_changes_nothing_and_marks_the_row(tmp_path: Path) -> None:
    before = rows(sound(tmp_path, "{at: [tables], relabel: {ECO: eco}}"))["H_Temp"]
    after = rows(sound(tmp_path, "{at: [tables/01-heater/4], keep: [range, codes]}"))["H_Temp"]
    assert (after.range, after.labels, after.unit) == (before.range, before.labels, before.unit)
    assert after.marks == ("E1",)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ("{at: [annex], set: {x: 1}}", "a path begins with standard, messages, tables or"),
        ("{at: [errata/E1], set: {id: E2}}", "a path begins with standard, messages, tables or"),
        ("{at: [tables/03-roof/1], set: {unit: K}}", "nothing named '03-roof'"),
        ("{at: [tables/01-heater/9], set: {unit: K}}", "nothing named '9'"),
        ("{at: [messages/Heater/Reserved], set: {start: 8}}", "2 entries named 'Reserved'"),
        ("{at: [standard/buss/house], set: {bit_rate: 1}}", "there is no 'buss' in Standard"),
        ("{at: [tables/01-heater/4/unit/x], set: {a: 1}}", "nothing below it is named 'x'"),
        ("{at: [tables/01-heater/4/unit], set: {a: 1}}", "does not lead to an entry with keys"),
        ("{at: [tables], set: {a: 1}}", "does not lead to an entry with keys"),
        ("{at: [tables/01-heater/4], set: {unti: K}}", "unknown key 'unti'"),
        ("{at: [tables/01-heater/4], set: {unit: ℃}}", "unit is '℃' already: nothing changes"),
        ("{at: [tables/01-heater/4], set: {factor: 0.50}}", "factor is 0.5"),
        ("{at: [tables/01-heater/4], set: {}}", "nothing changes"),
        ("{at: [tables/01-heater/4], set: {codes: {same_as: H_Mode}}}", "give the codes"),
        ("{at: [tables/01-heater/4]}", "exactly one of set, add, remove, relabel, keep"),
        ("{at: [tables/01-heater/4], set: {unit: K}, keep: [unit]}", "exactly one of set, add"),
        ("{at: [tables/01-heater/4], add: {unit: K}}", "'unit' is not a list"),
        ("{at: [standard/buses/house], add: {nodes: [PANEL]}}", "nodes has that already"),
        ("{at: [standard/buses/house], add: {nodes: []}}", "nothing changes"),
        ("{at: [behaviour], add: {}}", "nothing changes"),
        ("{at: [tables], relabel: {Unknown: X}}", "no code is labelled 'Unknown' there"),
        ("{at: [tables/02-panel/1], relabel: {Invalid: X}}", "no code is labelled 'Invalid'"),
        ("{at: [tables], relabel: {ECO: ECO}}", "nothing changes"),
        ("{at: [tables/01-heater/1], keep: [codes]}", "nothing is printed for 'codes'"),
    ],
)
def test_a_change_that_cannot_be_made_is_a_fault_and_leaves_the_rows_alone(
    change: str, why: str, tmp_path: Path
) -> None:
    spec, faults = applied(tmp_path, erratum(change))
    (fault,) = faults
    assert fault.startswith("spec/errata.yaml:2:")
    assert "erratum E1, " in fault
    assert why in fault
    untouched = read_spec(write_spec(tmp_path / "untouched"), "spec")
    assert (spec.standard, spec.messages, spec.behaviour, spec.tables) == (
        untouched.standard,
        untouched.messages,
        untouched.behaviour,
        untouched.tables,
    )


def test_a_new_value_of_the_wrong_kind_is_a_fault_at_its_place(tmp_path: Path) -> None:
    _, faults = applied(tmp_path, erratum("{at: [tables/01-heater/4], set: {range: 0-9}}"))
    (fault,) = faults
    assert fault.endswith("expected a range such as 0~255, not '0-9'")


def test_an_erratum_without_a_place_is_a_fault(tmp_path: Path) -> None:
    nowhere = erratum("{at: [], set: {unit: K}}")
    nothing = erratum("", "E2")
    _, faults = applied(tmp_path, nowhere, nothing)
    assert [fault.split(": ", 1)[1] for fault in faults] == [
        "erratum E1: names nothing to change",
        "erratum E2: names nothing to change",
    ]


def test_a_number_given_twice_is_a_fault(tmp_path: Path) -> None:
    first = erratum("{at: [tables/01-heater/4], set: {unit: K}}")
    second = erratum("{at: [tables/02-panel/1], set: {unit: K}}")
    _, faults = applied(tmp_path, first, second)
    (fault,) = faults
    assert fault.startswith("spec/errata.yaml:3:10: ")
    assert fault.endswith("erratum E1 stands here twice")


def test_one_change_that_fails_does_not_keep_the_others_from_being_made(tmp_path: Path) -> None:
    spec, faults = applied(
        tmp_path,
        erratum("{at: [tables/01-heater/9, tables/01-heater/4], set: {unit: K}}"),
        erratum("{at: [tables/02-panel/1], set: {unit: K}}", "E2"),
    )
    assert len(faults) == 1
    assert (rows(spec)["H_Temp"].unit, rows(spec)["P_WantedTemp"].unit) == ("K", "K")


def test_every_erratum_of_the_project_takes_effect(root: Path) -> None:
    printed = read_spec(root / "spec", "spec")
    corrected, faults = apply_errata(printed)
    assert faults == ()
    assert len(corrected.errata) == len({erratum.id for erratum in corrected.errata}) > 50
