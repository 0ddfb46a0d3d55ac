"""The scenarios by name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from swapcan.nodes.faults import planned_fault
from swapcan.nodes.plan import plan_of
from swapcan.rules import rule_of
from swapcan.rules.charging import charge_stops_on_fault
from swapcan.rules.voltage import hv_off_in_time
from swapcan.scenarios.reactions.charging import CHARGE_BEGINS, CHARGE_ENDS, CHARGE_RESUMES
from swapcan.scenarios.reactions.high_voltage import HV_ON, HV_REACHED
from swapcan.scenarios.reactions.troubled_commands import SILENT_VCU, STUCK_COUNTER, WRONG_CHECKSUM
from swapcan.scenarios.scenario import Scenario, ScenarioError
from typedcan.report.language import Text

SCENARIOS: Mapping[str, Scenario] = MappingProxyType(
    {
        scenario.name: scenario
        for scenario in (
            Scenario(
                name="hv-on-off",
                title=Text("high voltage is switched on, and off again", "上高压,再下高压"),
                plays=("VCU",),
                plan=plan_of("hv_on@1s, hv_off@13s"),
                seconds=14.0,
                rules=(HV_ON, HV_REACHED, hv_off_in_time.RULE),
            ),
            Scenario(
                name="requests",
                title=Text(
                    "the pack is asked for its code and its basic data",
                    "请求电池包编码和基本参数",
                ),
                plays=("VCU",),
                plan=plan_of("ask@0.5s"),
                seconds=4.0,
                rules=(rule_of("answer-in-time"),),
            ),
            Scenario(
                name="silent-vcu",
                title=Text(
                    "the VCU falls silent with high voltage closed", "高压闭合后 VCU 停止发送"
                ),
                plays=("VCU",),
                plan=plan_of("hv_on@1s, hv_off@27s"),
                faults=(planned_fault("VCU.bus_silence@12s+15s"),),
                seconds=28.0,
                rules=(HV_ON, HV_REACHED, SILENT_VCU),
            ),
            Scenario(
                name="wrong-checksum",
                title=Text(
                    "high voltage on is commanded with wrong checksums only",
                    "仅以错误校验和发送上电命令",
                ),
                plays=("VCU",),
                plan=plan_of("hv_on@1.5s, hv_off@7s"),
                # Longer than the commands for high voltage on, at both ends.
                faults=(planned_fault("V2B_CMD.wrong_checksum@1s+7s"),),
                seconds=9.0,
                rules=(WRONG_CHECKSUM,),
            ),
            Scenario(
                name="stuck-counter",
                title=Text(
                    "the counter of V2B_CMD stands still with high voltage closed",
                    "高压闭合后 V2B_CMD 生命信号停止变化",
                ),
                plays=("VCU",),
                plan=plan_of("hv_on@1s, hv_off@28s"),
                faults=(planned_fault("V2B_CMD.stuck_counter@12s+15s"),),
                seconds=29.0,
                rules=(HV_ON, HV_REACHED, STUCK_COUNTER),
            ),
            Scenario(
                name="charge",
                title=Text(
                    "a charger is connected, has a fault for a while, and is taken off",
                    "连接充电机,出现短时故障,然后断开",
                ),
                plays=("CHG",),
                may_play=("VCU",),
                plan=plan_of("charge@1s+29s"),
                faults=(planned_fault("CHG.charger_hardware@15s+5s"),),
                seconds=37.0,
                rules=(
                    CHARGE_BEGINS,
                    charge_stops_on_fault.RULE,
                    CHARGE_RESUMES,
                    CHARGE_ENDS,
                ),
            ),
        )
    }
)
"""All of them, in the order in which they are best played."""


def scenarios_of(names: Iterable[str]) -> tuple[Scenario, ...]:
    """The scenarios of those names; raises `ScenarioError`."""
    chosen = tuple(dict.fromkeys(names))
    for name in chosen:
        if name not in SCENARIOS:
            raise ScenarioError(f"there is no scenario {name!r}; known: {', '.join(SCENARIOS)}")
    return tuple(SCENARIOS[name] for name in chosen)
