"""A package's own way into another reading or edition gives what the toolchain compiles."""

from __future__ import annotations

import dataclasses
from itertools import combinations
from pathlib import Path

import pytest

from dbcspec.spec.compiled import compile_rows
from dbcspec.spec.folder import read_spec
from dbcspec.spec.readings import choice_of
from dbcspec.spec.rows import Spec
from dbcspec.spec.variants import with_variants
from typedcan.model.errors import ReadError
from typedcan.model.protocol import Protocol
from typedcan.model.variants import choose


@pytest.fixture(scope="module")
def printed(root: Path) -> Spec:
    return read_spec(root / "spec", "spec")


@pytest.fixture(scope="module")
def usual(printed: Spec) -> Protocol:
    return with_variants(compile_rows(printed, "caamtb-swap").protocol, printed)


def names(printed: Spec) -> list[str]:
    readings = [each.id for erratum in printed.errata for each in erratum.alternatives]
    return readings + [edition.name for edition in printed.editions]


def tidied(protocol: Protocol) -> Protocol:
    """Without the order of value tables, which says nothing, and the words of the choice."""
    tables = sorted(protocol.value_tables, key=lambda table: table.name)
    return dataclasses.replace(protocol, value_tables=tuple(tables), chosen="")


def test_every_reading_and_edition_is_what_the_toolchain_compiles(
    printed: Spec, usual: Protocol
) -> None:
    for name in names(printed):
        compiled = compile_rows(printed, usual.name, choice_of(printed, name)).protocol
        assert choose(usual, [name]) == compiled, name
        assert compiled != usual, name


def test_two_choices_are_what_the_toolchain_compiles_or_are_refused(
    printed: Spec, usual: Protocol
) -> None:
    for pair in combinations(names(printed), 2):
        try:
            chosen = choose(usual, pair)
        except ReadError:
            continue
        compiled = compile_rows(printed, usual.name, choice_of(printed, "+".join(pair))).protocol
        assert tidied(chosen) == tidied(compiled), pair


def test_the_number_of_an_erratum_takes_back_what_an_edition_reads(
    printed: Spec, usual: Protocol
) -> None:
    compiled = compile_rows(printed, usual.name, choice_of(printed, "v4.6+E50")).protocol
    assert tidied(choose(usual, ["v4.6", "E50"])) == tidied(compiled)
    numbering = {each.name: each.numbering.value for each in compiled.transfers}
    assert numbering["cell_voltages"] == "within_group"


@pytest.mark.parametrize(
    ("chosen", "said"),
    [
        (["E50z"], "has no reading or edition 'E50z'; did you mean 'E50b'?"),
        (["V4.6"], "has no reading or edition 'V4.6'; did you mean 'v4.6'?"),
        (["E50", "E50b"], "E50 and E50b are two readings of one erratum"),
    ],
)
def test_what_cannot_be_chosen_is_said(usual: Protocol, chosen: list[str], said: str) -> None:
    with pytest.raises(ReadError) as caught:
        choose(usual, chosen)
    assert said in str(caught.value)


def test_a_choice_is_named_and_the_usual_readings_have_no_name(usual: Protocol) -> None:
    assert choose(usual, []) is usual
    assert choose(usual, ["v4.6", "E50b"]).chosen == "v4.6+E50b"
