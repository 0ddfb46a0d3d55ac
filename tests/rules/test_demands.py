"""A demand is only what the standard prints and what has one reading."""

from __future__ import annotations

import pytest
from rules.alterations import CSCS, PLAN, SECONDS
from rules.altered import Alteration, added, byte, signals
from rules.in_blocks import judged_by_all
from rules.recorded import recorded

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import RULES, Rule, Severity, Status, rule_of
from swapcan.rules import SCOPE

ERRATA = {each.id: each for each in PROTOCOL.model.errata}

OPEN_KINDS = {"gap", "choice"}

over_demands = pytest.mark.parametrize(
    "rule", [each for each in RULES if each.severity is Severity.MUST], ids=lambda rule: rule.id
)


@over_demands
def test_no_demand_rests_on_a_gap_or_a_choice_nor_on_what_is_read_in_two_ways(rule: Rule) -> None:
    for number in rule.errata:
        assert ERRATA[number].kind not in OPEN_KINDS
        assert not ERRATA[number].alternatives


def test_the_errata_that_rules_name_are_there() -> None:
    named = {number for rule in RULES for number in rule.errata}
    named |= {number for rule in RULES for each in rule.left_open for number in each.errata}
    assert named <= ERRATA.keys()


@pytest.mark.parametrize(
    ("rule", "errata"),
    [
        ("reserved-bits", {"E07", "E08"}),
        ("answer-unasked", {"E56"}),
        ("cell-count-announced", {"E50"}),
        ("probe-count-announced", {"E50"}),
        ("cell-extremes-place", {"E50"}),
        ("temperature-extremes-place", {"E50"}),
        ("cooling-told-voltage", {"E36"}),
        ("discharge-limit", {"E61"}),
        ("feedback-limit", {"E61"}),
        # The times and shares by which they decide are not printed.
        ("start-state", set()),
        ("hv-off-in-time", set()),
        ("hv-off-requested", set()),
        ("charger-voltage-limit", set()),
        ("charger-current-limit", set()),
        ("cooling-voltage-asked", set()),
    ],
)
def test_what_rests_on_more_than_print_is_a_recommendation(rule: str, errata: set[str]) -> None:
    assert rule_of(rule).severity is Severity.SHOULD
    assert set(rule_of(rule).errata) == errata


def test_what_is_left_open_belongs_to_a_message_or_a_signal_that_there_is() -> None:
    names = {message.NAME for message in PROTOCOL.messages}
    names |= {signal.name for _, signal in PROTOCOL.model.signals()}
    for rule in RULES:
        assert {each.name.partition(" ")[0] for each in rule.left_open} <= names
    assert set(SCOPE.open_codes) <= names


@pytest.mark.parametrize(
    ("rule", "alter", "errata"),
    [
        ("checksum", byte("B2V_SysCode2", 1.0, 7, 0x01), ("E46",)),
        ("source-address", added("V2B_RQData", 1.0, arbitration_id=0x1801F3D0), ("E41",)),
        ("counter-sequence", signals("BSU_BMS_0", 9.0, BSU_Live=200), ("E49",)),
        ("counter-sequence", signals("BMS_TMS_0", 9.0, BMS_Life=200), ("E49",)),
        ("code-defined", signals("B2V_ST0", 9.0, B2V_ST0_Flt_ChgPlugOT=3), ("E54",)),
        ("code-defined", signals("B2V_BattInfo1", 1.0, B2V_BI1_BattType=0), ()),
        ("code-defined", signals("V2B_RQData", 1.0, V2B_RD_RQSysCode=0), ()),
        ("code-defined", signals("BSU_BMS_0", 9.0, BSU_ConnectSt=0), ("E20",)),
    ],
)
def test_a_part_that_is_left_open_breaks_no_demand(
    rule: str, alter: Alteration, errata: tuple[str, ...]
) -> None:
    judgement = judged_by_all(alter(recorded(PLAN, seconds=SECONDS, cscs=CSCS)))
    result = judgement.result(rule)
    assert result.status is Status.FAILED
    assert result.rule.severity is Severity.MUST
    assert result.severity is Severity.SHOULD
    assert {(each.is_open, each.errata) for each in result.occurrences} == {(True, errata)}
    assert judgement.result(rule).rule == rule_of(rule)


@pytest.mark.parametrize(
    ("rule", "alter"),
    [
        ("checksum", byte("B2V_ST1", 9.0, 7, 0x01)),
        ("counter-sequence", signals("V2B_CMD", 9.0, V2B_CMD_ALIV=7)),
        ("code-defined", signals("BSU_BMS_0", 9.0, BSU_ConnectSt=3)),
    ],
)
def test_the_printed_part_of_the_same_rule_is_a_demand(rule: str, alter: Alteration) -> None:
    result = judged_by_all(alter(recorded(PLAN, seconds=SECONDS, cscs=CSCS))).result(rule)
    assert result.severity is Severity.MUST
    assert not result.open_count


def test_an_open_finding_does_not_soften_another_one_of_its_rule() -> None:
    frames = byte("B2V_SysCode2", 1.0, 7, 0x01)(recorded(PLAN, seconds=SECONDS, cscs=CSCS))
    result = judged_by_all(byte("B2V_ST1", 9.0, 7, 0x01)(frames)).result("checksum")
    assert (result.count, result.open_count) == (2, 1)
    assert result.severity is Severity.MUST
