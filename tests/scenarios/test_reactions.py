"""The rules of scenarios on records by hand, with bytes by cantools: what breaks each, and not."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from scenarios.lines import charger, commands, control, judged, line, said, states

from swapcan.conform import RULES, Judge, Judgement, Rule, Status
from swapcan.scenarios.reactions.charging import CHARGE_BEGINS, CHARGE_ENDS, CHARGE_RESUMES
from swapcan.scenarios.reactions.high_voltage import HV_ON, HV_REACHED
from swapcan.scenarios.reactions.troubled_commands import SILENT_VCU, STUCK_COUNTER, WRONG_CHECKSUM
from swapcan.scenarios.scenarios import SCENARIOS
from typedcan.logs.read import open_log

OPEN, PRECHARGE, CLOSED, FAILED = range(4)
ON, OFF = 1, 2
START, STOP = 0, 1

REACTIONS = tuple(
    dict.fromkeys(rule for each in SCENARIOS.values() for rule in each.rules if rule not in RULES)
)


@pytest.fixture
def judge(tmp_path: Path) -> Callable[[Rule, Sequence[str]], Judgement]:
    """Judges lines by one rule."""
    return lambda rule, lines: judged(lines, tmp_path / "record.log", [rule])


Judging = Callable[[Rule, Sequence[str]], Judgement]

TOLD_ON = [*commands(0, 1, OFF), *states(0, 1, OPEN), *commands(1, 14, ON)]
"""A pack is told to switch high voltage on at 1 s, for 13 s."""

LIVE = [*commands(0, 2, ON), *states(0, 2, CLOSED)]
"""Two seconds of a pack with high voltage."""

FAILS: dict[str, tuple[Rule, Sequence[str], list[str]]] = {
    "nothing comes of the command": (
        HV_ON,
        [*TOLD_ON, *states(1, 14, OPEN)],
        [
            (
                '1.00 s: B2V_ST1_BMS: still "HV open" 9.92 s after the command, and nothing said'
                " why; 10 s are allowed"
            )
        ],
    ),
    "a precharge never ends": (
        HV_ON,
        [*TOLD_ON, *states(1, 14, PRECHARGE)],
        [
            (
                '1.00 s: B2V_ST1_BMS: still "Precharge" 9.92 s after the command, and nothing said'
                " why; 10 s are allowed"
            )
        ],
    ),
    "the pack says that it failed": (
        HV_REACHED,
        [*TOLD_ON, *states(1, 4, PRECHARGE), *states(4, 14, FAILED)],
        [
            (
                "4.02 s: B2V_ST1_BMS: high voltage does not come on; 3.02 s after the command the"
                ' pack says B2V_ST1_BMS "Fail to HV on"'
            )
        ],
    ),
    "the pack says that it has a grave fault": (
        HV_REACHED,
        [*TOLD_ON, *states(1, 14, OPEN, level=3)],
        [
            (
                "1.02 s: B2V_ST1_BMS: high voltage does not come on; 0.02 s after the command the"
                ' pack says B2V_ST1_Fault_Levl "Level3-Most severe fault"'
            )
        ],
    ),
    "high voltage opens after three seconds of silence": (
        SILENT_VCU,
        [*LIVE, *states(2, 5, CLOSED), *states(5, 9, OPEN), *commands(9, 10, OFF)],
        ["5.02 s: B2V_ST1_BMS: high voltage opens 3.07 s after the last V2B_CMD"],
    ),
    "high voltage stays, and a fault is reported": (
        SILENT_VCU,
        [*LIVE, *states(2, 5, CLOSED), *states(5, 9, CLOSED, level=1), *commands(9, 10, OFF)],
        [
            "5.02 s: B2V_ST1_Fault_Levl: fault level 1 is reported 3.07 s after the last V2B_CMD",
            "8.92 s: B2V_ST1_BMS: high voltage stays closed for the 6.97 s after the last V2B_CMD",
        ],
    ),
    "high voltage opens when the counter stands still": (
        STUCK_COUNTER,
        # The last counter at 1.95 s is 39 % 15 = 9: the frame at 2 s is the first to repeat it.
        [*LIVE, *commands(2, 6, ON, counter=9), *states(2, 4, CLOSED), *states(4, 7, OPEN)],
        [
            (
                "4.02 s: B2V_ST1_BMS: high voltage opens 2.02 s after the counter of V2B_CMD began"
                " to stand still"
            )
        ],
    ),
    "spoilt commands are obeyed": (
        WRONG_CHECKSUM,
        [*commands(0.5, 3, ON, spoilt=True), *states(0, 1, OPEN), *states(1, 3, PRECHARGE)],
        [
            (
                '1.00 s: B2V_ST1_BMS: reports "Precharge" 0.52 s after the first of 50 commands for'
                " high voltage on whose checksum is wrong"
            )
        ],
    ),
    "charging does not begin": (
        CHARGE_BEGINS,
        [*control(0, 14, STOP), *charger(1, 14)],
        [
            (
                '0.90 s: B2V_S_ChargeControl: still "Normal Stop to charge" 9.6 s after the charger'
                " was ready, 10 s are allowed"
            )
        ],
    ),
    "charging does not begin again": (
        CHARGE_RESUMES,
        [
            *(*charger(0, 5), *charger(5, 8, fault=1), *charger(8, 16)),
            *(*control(0, 5.5, START), *control(5.5, 16, STOP)),
        ],
        [
            (
                '8.00 s: B2V_S_ChargeControl: still "Normal Stop to charge" 4.6 s after the'
                " charger's fault was gone, 5 s are allowed"
            )
        ],
    ),
    "charging does not end": (
        CHARGE_ENDS,
        [*charger(0, 5), *control(0, 12, START)],
        [
            (
                '4.50 s: B2V_S_ChargeControl: still "Start to charge" 4.6 s after the'
                " charger's last report, 5 s are allowed"
            )
        ],
    ),
}


@pytest.mark.parametrize(("rule", "lines", "expected"), FAILS.values(), ids=FAILS)
def test_what_breaks_a_reaction_is_said(
    rule: Rule, lines: Sequence[str], expected: list[str], judge: Judging
) -> None:
    found = judge(rule, lines)
    assert said(found, rule) == expected
    for occurrence in found.result(rule.id).occurrences:
        assert re.search(r"[\u4e00-\u9fff]", occurrence.says("zh"))


PASSES: dict[str, tuple[Rule, Sequence[str]]] = {
    "closed just before the limit": (
        HV_ON,
        [*TOLD_ON, *states(1, 10.9, PRECHARGE), *states(10.9, 14, CLOSED)],
    ),
    "failing is an answer": (HV_ON, [*TOLD_ON, *states(1, 3, PRECHARGE), *states(3, 14, FAILED)]),
    "a grave fault is an answer": (HV_ON, [*TOLD_ON, *states(1, 14, OPEN, level=3)]),
    "the request for high voltage off is an answer": (
        HV_ON,
        [*TOLD_ON, *states(1, 14, OPEN), line(1.5, "B2V_RQ", HVOff=1)],
    ),
    "closed, and a grave fault later": (
        HV_REACHED,
        [*TOLD_ON, *states(1, 5, CLOSED), *states(5, 14, CLOSED, level=3)],
    ),
    "spoilt commands are not obeyed": (
        WRONG_CHECKSUM,
        [*commands(0.5, 3, ON, spoilt=True), *states(0, 4, OPEN)],
    ),
    "charging begins just in time": (
        CHARGE_BEGINS,
        [*control(0, 10.5, STOP), *control(10.5, 14, START), *charger(1, 14)],
    ),
    "charging begins again": (
        CHARGE_RESUMES,
        [
            *(*charger(0, 5), *charger(5, 8, fault=1), *charger(8, 16)),
            *(*control(0, 5.5, START), *control(5.5, 12.5, STOP), *control(12.5, 16, START)),
        ],
    ),
    "charging ends just in time": (
        CHARGE_ENDS,
        [*charger(0, 5), *control(0, 9, START), *control(9, 12, STOP)],
    ),
}


@pytest.mark.parametrize(("rule", "lines"), PASSES.values(), ids=PASSES)
def test_a_near_miss_passes(rule: Rule, lines: Sequence[str], judge: Judging) -> None:
    found = judge(rule, lines)
    assert said(found, rule) == []
    assert found.result(rule.id).status is Status.PASSED


UNJUDGED: dict[str, tuple[Rule, Sequence[str]]] = {
    "no command": (HV_ON, [*commands(0, 14, OFF), *states(0, 14, OPEN)]),
    "no pack": (HV_ON, TOLD_ON),
    "a command that is withdrawn too early": (
        HV_ON,
        [*commands(0, 9, ON), *commands(9, 14, OFF), *states(0, 14, OPEN)],
    ),
    "a record that ends too early": (HV_ON, [*commands(0, 9, ON), *states(0, 9, PRECHARGE)]),
    "spoilt commands only": (
        HV_ON,
        [*commands(0, 14, ON, spoilt=True), *states(0, 14, OPEN)],
    ),
    "nothing comes of the command, which another rule finds": (
        HV_REACHED,
        [*TOLD_ON, *states(1, 14, OPEN)],
    ),
    "silence without high voltage": (
        SILENT_VCU,
        [*commands(0, 2, OFF), *states(0, 9, OPEN), *commands(9, 10, OFF)],
    ),
    "no silence": (SILENT_VCU, [*commands(0, 5, ON), *states(0, 5, CLOSED)]),
    "no commands at all": (SILENT_VCU, states(0, 5, CLOSED)),
    "no counter that stands still": (
        STUCK_COUNTER,
        [*commands(0, 5, ON), *states(0, 5, CLOSED)],
    ),
    "a pack without commands": (STUCK_COUNTER, states(0, 5, CLOSED)),
    "a right command among spoilt ones": (
        WRONG_CHECKSUM,
        [
            *(*commands(0, 2, ON, spoilt=True), *commands(2, 2.1, ON)),
            *(*commands(2.1, 4, ON, spoilt=True), *states(0, 2, OPEN), *states(2, 4, PRECHARGE)),
        ],
    ),
    "high voltage that was there before": (
        WRONG_CHECKSUM,
        [*LIVE, *commands(2, 4, ON, spoilt=True), *states(2, 4, CLOSED)],
    ),
    "no charger": (CHARGE_BEGINS, control(0, 14, STOP)),
    "a charger that was not there for long": (
        CHARGE_BEGINS,
        [*charger(0, 5), *control(0, 9, STOP)],
    ),
    "a fault before charging began": (
        CHARGE_RESUMES,
        [*charger(0, 5, fault=1), *charger(5, 14), *control(0, 14, STOP)],
    ),
    "a charger that goes without charging": (
        CHARGE_ENDS,
        [*charger(0, 5), *control(0, 14, STOP)],
    ),
}


@pytest.mark.parametrize(("rule", "lines"), UNJUDGED.values(), ids=UNJUDGED)
def test_without_evidence_nothing_is_judged(
    rule: Rule, lines: Sequence[str], judge: Judging
) -> None:
    assert judge(rule, lines).result(rule.id).status is Status.NOT_JUDGED


@pytest.mark.parametrize("case", FAILS)
@pytest.mark.parametrize("size", [7, 100])
def test_where_a_record_is_cut_does_not_matter(case: str, size: int, tmp_path: Path) -> None:
    rule, lines, _ = FAILS[case]
    path = tmp_path / "record.log"
    whole = judged(lines, path, [rule])
    judge = Judge(["BMU"], [rule])
    with open_log(path, size) as source:
        for block in source:
            judge.feed(block)
    assert judge.finish().result(rule.id).occurrences == whole.result(rule.id).occurrences


def test_reactions_are_named_as_such_and_told_in_both_languages() -> None:
    assert {rule.id for rule in REACTIONS} == {rule.id for rule, *_ in FAILS.values()}
    for rule in REACTIONS:
        assert rule.id.startswith("reaction-")
        assert rule.judges == ("BMU",)
        for text in (rule.title, rule.purpose, *(each.text for each in rule.tolerances)):
            assert re.search(r"[\u4e00-\u9fff]", text.zh)
            assert text.en.isascii()
        assert all(each.name.startswith(f"{rule.id}.") for each in rule.tolerances)
