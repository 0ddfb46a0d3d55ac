"""The acts of behaviour.yaml in the model: which signals, which start values, what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest
from generator.command import dbcspec
from generator.small_spec import FILES, edited, write_project, write_spec

from dbcspec.errors import SpecError
from dbcspec.spec.errata import apply_errata
from dbcspec.spec.folder import read_spec
from dbcspec.spec.resolve import resolve
from typedcan.model.acting import ActingCodes
from typedcan.model.protocol import Protocol, Signal


def acts(*rows: str) -> str:
    return FILES["behaviour.yaml"] + "acts:\n" + "".join(f"  - {{{row}}}\n" for row in rows)


def resolved(folder: Path, **changed: str) -> Protocol:
    spec, faults = apply_errata(read_spec(write_spec(folder, **changed), "spec"))
    assert faults == ()
    return resolve(spec, "thermo")


def mode(protocol: Protocol) -> Signal:
    [found] = [each for _, each in protocol.signals() if each.name == "H_Mode"]
    return found


def test_a_row_becomes_codes_that_act_ascending_with_kind_and_clause(tmp_path: Path) -> None:
    row = "signal: H_Mode, codes: [2, 1], safe: 0, kind: report, cite: 5.1"
    signal = mode(resolved(tmp_path, behaviour=acts(row)))
    assert signal.acting == ActingCodes(codes=(1, 2), safe=0, reports=True, reference="5.1")
    plain = mode(resolved(tmp_path, behaviour=acts("signal: H_Mode, codes: [0x1], safe: 0")))
    assert plain.acting == ActingCodes(codes=(1,), safe=0)
    assert mode(resolved(tmp_path)).acting is None


@pytest.mark.parametrize(
    ("codes", "initial", "start"),
    [
        ("[1]", "", 3),
        ("[3]", "", 2),
        ("[0]", "", 3),
        ("[3]", ", initial: 1", 1),
        ("[1]", ", initial: 1", 1),
    ],
)
def test_a_signal_starts_at_its_safe_code_where_its_invalid_code_acts(
    codes: str, initial: str, start: int, tmp_path: Path
) -> None:
    messages = edited("messages.yaml", "name: H_Mode", f"name: H_Mode{initial}")
    behaviour = acts(f"signal: H_Mode, codes: {codes}, safe: 2")
    assert mode(resolved(tmp_path, messages=messages, behaviour=behaviour)).start_value == start


def test_a_signal_without_an_invalid_code_starts_at_its_safe_code_where_0_acts(
    tmp_path: Path,
) -> None:
    table = edited("tables/01-heater.yaml", "2: ECO, 3: Invalid", "2: ECO, 3: FULL")
    behaviour = acts("signal: H_Mode, codes: [0], safe: 2")
    signal = mode(resolved(tmp_path, **{"01-heater": table, "behaviour": behaviour}))
    assert (signal.start_value, signal.must_be_given) == (2, True)
    assert not mode(resolved(tmp_path, behaviour=behaviour)).must_be_given


def test_a_row_may_be_for_the_signal_of_one_message(tmp_path: Path) -> None:
    wanted, again = "P_WantedTemp, length: 16, start: 7", "H_Mode, length: 2, start: 7"
    messages = edited("messages.yaml", wanted, again)
    behaviour = acts(
        "signal: H_Mode, codes: [1], safe: 0", "signal: Panel.H_Mode, codes: [2], safe: 0"
    )
    spec = {"messages": messages, "behaviour": behaviour}
    found = [
        (message.name, each.acting and each.acting.codes)
        for message, each in resolved(tmp_path, **spec).signals()
        if each.name == "H_Mode"
    ]
    assert found == [("Heater", (1,)), ("Panel", (2,))]
    only = acts("signal: Panel.H_Mode, codes: [2], safe: 0")
    found = [
        (message.name, each.acting and each.acting.codes)
        for message, each in resolved(tmp_path, messages=messages, behaviour=only).signals()
        if each.name == "H_Mode"
    ]
    assert found == [("Heater", None), ("Panel", (2,))]


@pytest.mark.parametrize(
    ("rows", "faults"),
    [
        (["signal: H_Mod, codes: [1], safe: 0"], ["9:14: signal: there is no 'H_Mod'"]),
        (["signal: Pan.H_Mode, codes: [1], safe: 0"], ["9:14: signal: there is no 'Pan.H_Mode'"]),
        (
            ["signal: Panel.H_Mode, codes: [1], safe: 0"],
            ["9:14: signal: there is no 'Panel.H_Mode'"],
        ),
        (["signal: Reserved, codes: [1], safe: 0"], ["9:14: signal: there is no 'Reserved'"]),
        (
            ["signal: H_Mode, codes: [], safe: 0"],
            ["9:29: H_Mode: no code acts; leave the row out"],
        ),
        (
            ["signal: H_Mode, codes: [1, 2], safe: 2"],
            ["9:43: H_Mode: the safe code 2 acts itself"],
        ),
        (
            ["signal: H_Mode, codes: [2, 2, 1], safe: 0"],
            ["9:29: H_Mode: code 2 stands here twice"],
        ),
        (
            ["signal: H_Mode, codes: [1], safe: 0", "signal: H_Mode, codes: [2], safe: 0"],
            ["10:14: H_Mode: a second row of codes that act; put them into one"],
        ),
        (
            ["signal: H_Mode, codes: [1, 1], safe: 1"],
            [
                "9:29: H_Mode: code 1 stands here twice",
                "9:43: H_Mode: the safe code 1 acts itself",
            ],
        ),
    ],
)
def test_a_row_that_cannot_be_is_refused_at_its_place(
    rows: list[str], faults: list[str], tmp_path: Path
) -> None:
    with pytest.raises(SpecError) as caught:
        resolved(tmp_path, behaviour=acts(*rows))
    assert [str(fault) for fault in caught.value.faults] == [
        f"spec/behaviour.yaml:{fault}" for fault in faults
    ]


@pytest.mark.parametrize(
    ("row", "word"),
    [
        ("signal: H_Mode, codes: [1]", "key 'safe' is missing"),
        ("signal: H_Mode, safe: 1", "key 'codes' is missing"),
        ("signal: H_Mode, codes: 1, safe: 0", "expected a list"),
        ("signal: H_Mode, codes: [on], safe: 0", "expected a whole number, not 'on'"),
        ("signal: H_Mode, codes: [1], safe: 0, kind: order", "expected one of command, report"),
    ],
)
def test_a_row_of_another_form_is_refused(row: str, word: str, tmp_path: Path) -> None:
    with pytest.raises(SpecError, match=word.replace("[", r"\[")):
        resolved(tmp_path, behaviour=acts(row))


def test_an_erratum_may_settle_what_acts(tmp_path: Path) -> None:
    head = "kind: gap, place: p, printed: q, reading: r, because: b"
    errata = (
        f"errata:\n"
        f"  - {{id: E1, {head}, change: [{{at: [behaviour/acts/H_Mode], set: {{safe: 2}}}}]}}\n"
    )
    behaviour = acts("signal: H_Mode, codes: [1], safe: 0")
    signal = mode(resolved(tmp_path, behaviour=behaviour, errata=errata))
    assert signal.acting == ActingCodes(codes=(1,), safe=2)


def test_show_says_which_codes_act_and_which_is_safe(tmp_path: Path) -> None:
    rows = (
        "signal: H_Mode, codes: [1, 2], safe: 0, cite: 5.1",
        "signal: H_Temp, codes: [254], safe: 7, kind: report",
    )
    write_project(tmp_path, behaviour=acts(*rows))
    lines = dbcspec(tmp_path, "show", "Heater").stdout.splitlines()
    assert "H_Mode makes its receiver act: 1 On, 2 ECO; safe: 0 Off (5.1)" in lines
    assert "H_Temp says that something is on: 254 Broken; safe: 7" in lines
    assert not any("makes its" in line for line in dbcspec(tmp_path, "show", "Panel").stdout)
