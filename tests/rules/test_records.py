"""Records of packs and buses: what is to be told of them, and what nobody is to be accused of."""

from __future__ import annotations

from pathlib import Path

import pytest
from rules.alterations import BMU, CSCS, PLAN, SECONDS
from rules.altered import Alteration, added, again, both, lost_between, on_channel, signals
from rules.habits import answers_always, counts, filled, numbered_through, one_each_period, summed
from rules.in_blocks import NODES, broken, judged_by_all
from rules.recorded import recorded

from swapcan.conform import Judgement, Severity, Status, Verdict, judge_log

RECORDS = Path(__file__).with_name("records")


def demands(judgement: Judgement) -> set[str]:
    """The rules of which a demand is broken."""
    failed = judgement.of_status(Status.FAILED)
    return {each.rule.id for each in failed if each.severity is Severity.MUST}


@pytest.mark.parametrize(
    ("record", "nodes", "told"),
    [
        ("frame_no_counts_through_pack", NODES, set()),
        ("ucell_one_frame_per_period", NODES, set()),
        ("battinfo_syscode_always", NODES, set()),
        ("bsu_live_1_255", NODES, set()),
        ("syscode_checksum_sum", NODES, set()),
        ("charging_by_charge_contactors_mainpos_open", NODES, set()),
        # Another ECU sends a proprietary PGN that A.1 uses too; there is no cooling unit.
        ("foreign_18FF45A8_no_tms_judge_BMU", ("BMU",), {"foreign-frames"}),
    ],
)
def test_a_pack_with_a_good_reason_breaks_no_demand(
    record: str, nodes: tuple[str, ...], told: set[str]
) -> None:
    judgement = judge_log(RECORDS / f"{record}.log.gz", nodes)
    assert judgement.verdict is Verdict.CONFORMS
    assert broken(judgement) <= told


@pytest.mark.parametrize(
    ("record", "rule"),
    [
        # The swap controller is silent for ten seconds while others are awake, high voltage off.
        ("bsu_silent_hv_off", "node-awake"),
        # The charger is on the powertrain's channel.
        ("charger_on_powertrain_bus", "charger-own-bus"),
    ],
)
def test_what_breaks_a_demand_is_told(record: str, rule: str) -> None:
    judgement = judge_log(RECORDS / f"{record}.log.gz")
    assert broken(judgement) == demands(judgement) == {rule}
    assert judgement.verdict is Verdict.VIOLATES


OPEN_POSITIVE = both(
    signals("B2V_ST0", 15.0, 24.6, B2V_ST0_ST_MainPos=1),
    signals("B2V_ST0", 14.6, 22.1, B2V_ST0_ST_ChgNeg1=2),
)


@pytest.mark.parametrize("cscs", [1, 2, 5])
@pytest.mark.parametrize(
    ("habit", "told"),
    [
        (numbered_through, set()),
        (one_each_period, set()),
        (both(numbered_through, one_each_period), set()),
        (answers_always, set()),
        (summed, set()),
        (counts("BSU_BMS_0", 0, 1, 255), set()),
        (counts("BSU_BMS_0", 0, 0, 254), {"counter-sequence"}),
        (filled("BSU_BMS_0", 1, 0x50), {"reserved-bits"}),
        (filled("B2V_RQ", 0, 0x10), {"reserved-bits"}),
        (OPEN_POSITIVE, set()),
        (again("B2V_RQ", 0.02, times=290, every=0.1), {"event-repeated"}),
    ],
)
def test_further_packs_with_such_habits_break_no_demand(
    cscs: int, habit: Alteration, told: set[str]
) -> None:
    judgement = judged_by_all(habit(recorded(PLAN, seconds=SECONDS, cscs=cscs)))
    assert demands(judgement) == set()
    assert broken(judgement) <= told
    assert judgement.verdict is Verdict.CONFORMS


SILENT = {
    "BMU": BMU,
    "BSU": ("BSU_BMS_0",),
    "TMS": ("TMS_BMS_0",),
    "VCU": ("V2B_CMD", "V2B_RQData", "V2B_VIN"),
}
"""The messages of nodes; a BMU that was switched off may sleep, as the others may not."""


@pytest.mark.parametrize("node", SILENT)
@pytest.mark.parametrize("plan", ["ask@1s", "hv_on@1.5s, ask@1s, drive@3s+7s"])
@pytest.mark.parametrize("begin", [3.0, 12.0])
def test_a_node_that_is_silent_for_ten_seconds_is_told(node: str, plan: str, begin: float) -> None:
    frames = recorded(plan, seconds=SECONDS, cscs=CSCS)
    judgement = judged_by_all(lost_between(SILENT[node], begin, begin + 10.5)(frames))
    told = {"node-awake", "node-silence"}
    assert broken(judgement) & told
    if node != "BMU" or "hv_on" in plan:
        assert demands(judgement) & told
        assert judgement.verdict is Verdict.VIOLATES


def test_a_pack_that_is_off_the_truck_is_not_missed() -> None:
    frames = recorded("ask@1s", seconds=SECONDS, cscs=CSCS)
    gone = lost_between(BMU, 3.0, 13.5)(frames)
    off = signals("BSU_BMS_0", 4.0, 12.0, BSU_Lock=1, BSU_ConnectSt=2)(gone)
    assert broken(judged_by_all(gone)) == {"node-awake"}
    assert broken(judged_by_all(off)) == set()


@pytest.mark.parametrize("channel", ["vehicle", "charger"])
def test_a_charger_on_the_channel_of_the_powertrain_is_told_and_on_its_own_not(
    channel: str,
) -> None:
    frames = on_channel("C2B_ACStatus", channel)(recorded(PLAN, seconds=SECONDS, cscs=CSCS))
    found = {"charger-own-bus"} if channel == "vehicle" else set[str]()
    assert demands(judged_by_all(frames)) == found


PROPRIETARY = {"TMS_BMS_0": 0x18FFC13A, "BMS_TMS_0": 0x18FF45F4, "BSU_BMS_0": 0x18FFF8A7}


@pytest.mark.parametrize("address", [0x00, 0x21, 0xA8, 0xFE])
@pytest.mark.parametrize("message", PROPRIETARY)
def test_a_proprietary_pgn_of_nobody_is_foreign_whether_the_log_has_its_message_or_not(
    message: str, address: int
) -> None:
    number = PROPRIETARY[message]
    frames = recorded(PLAN, seconds=SECONDS, cscs=CSCS)
    other = added(message, 1.0, arbitration_id=number & ~0xFF | address)(frames)
    without = tuple(frame for frame in other if frame.arbitration_id != number)
    assert broken(judged_by_all(other)) == {"foreign-frames"}
    found = broken(judged_by_all(without))
    assert "foreign-frames" in found
    assert "source-address" not in found
