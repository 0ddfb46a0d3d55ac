"""Records of packs and buses: what is to be told of them, and what nobody is to be accused of."""

from __future__ import annotations

from pathlib import Path

import pytest
from rules.in_blocks import NODES, broken

from swapcan.conform import Verdict, judge_log

RECORDS = Path(__file__).with_name("records")


@pytest.mark.parametrize(
    ("record", "nodes", "verdict", "rules"),
    [
        # Another ECU sends a proprietary PGN that A.1 uses too; there is no cooling unit.
        (
            "foreign_18FF45A8_no_tms_judge_BMU",
            ("BMU",),
            Verdict.CONFORMS,
            {"foreign-frames"},
        ),
        # The swap controller is silent for ten seconds while others are awake, high voltage off.
        ("bsu_silent_hv_off", NODES, Verdict.VIOLATES, {"node-awake"}),
        # The charger is on the powertrain's channel.
        ("charger_on_powertrain_bus", NODES, Verdict.VIOLATES, {"charger-own-bus"}),
    ],
)
def test_what_is_found_in_a_record(
    record: str, nodes: tuple[str, ...], verdict: Verdict, rules: set[str]
) -> None:
    judgement = judge_log(RECORDS / f"{record}.log.gz", nodes)
    assert broken(judgement) == rules
    assert judgement.verdict is verdict
