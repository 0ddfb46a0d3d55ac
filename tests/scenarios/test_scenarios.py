"""Scenarios with a simulated pack on the simulated clock: what is sent, and how it is judged."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import can
import pytest
from node.rough_bus import HEAT_LEFT
from rules.recorded import written
from scenarios.lines import said, values
from scenarios.rig import Altered, believe_any_checksum, bench, take_off_for_on

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import RULES, Judgement, Status, Verdict, judge_log, rule_of
from swapcan.messages import (
    V2B_CMD,
    B2V_BattInfo1,
    C2B_ACStatus,
    HvCommand,
    V2B_RQData,
)
from swapcan.rules.voltage import hv_off_in_time
from swapcan.scenarios.announcement import announcement
from swapcan.scenarios.reactions.high_voltage import HV_ON, HV_REACHED
from swapcan.scenarios.reactions.troubled_commands import SILENT_VCU, STUCK_COUNTER, WRONG_CHECKSUM
from swapcan.scenarios.scenario import Scenario, ScenarioError
from swapcan.scenarios.scenarios import SCENARIOS, scenarios_of
from swapcan.scenarios.stage import LOOK_OUT, Left

over_all_scenarios = pytest.mark.parametrize("name", SCENARIOS)


@dataclass(frozen=True, slots=True)
class Played:
    """A scenario with a pack that does all right: how it left it, the record, and the wire."""

    left: Left
    frames: tuple[can.Message, ...]
    on_wire: tuple[can.Message, ...]


@cache
def played(name: str) -> Played:
    """Play it, once for all tests."""
    with bench() as rig:
        left = rig.play(SCENARIOS[name]).left
        return Played(left, tuple(rig.frames), tuple(rig.heard()))


def judgement_of(scenario: Scenario, frames: Sequence[can.Message], folder: Path) -> Judgement:
    """What the pack is judged to have done."""
    for frame in frames:
        frame.channel = "can0"
    path = written(frames, folder / "record.log")
    return judge_log(path, ["BMU"], rules=tuple(dict.fromkeys((*RULES, *scenario.rules))))


@over_all_scenarios
def test_a_pack_that_does_all_right_conforms_and_every_expectation_is_judged(
    name: str, tmp_path: Path
) -> None:
    scenario = SCENARIOS[name]
    assert played(name).left is Left.SAFE
    judgement = judgement_of(scenario, played(name).frames, tmp_path)
    assert judgement.verdict is Verdict.CONFORMS
    assert judgement.of_status(Status.FAILED) == ()
    for rule in scenario.rules:
        assert judgement.result(rule.id).status is not Status.NOT_JUDGED, rule.id


@over_all_scenarios
def test_the_record_has_what_was_on_the_wire_and_says_who_sent_it(name: str) -> None:
    run = played(name)
    on_wire = sorted((frame.arbitration_id, bytes(frame.data)) for frame in run.on_wire)
    recorded = sorted((frame.arbitration_id, bytes(frame.data)) for frame in run.frames)
    assert recorded == on_wire
    senders = {kind.FRAME_ID: kind.SENDER for kind in PROTOCOL.messages}
    for frame in run.frames:
        assert frame.is_rx is (senders[frame.arbitration_id] == "BMU")
    times = [frame.timestamp for frame in run.frames]
    assert times == sorted(times)


@over_all_scenarios
def test_nothing_is_sent_that_was_not_announced(name: str) -> None:
    scenario = SCENARIOS[name]
    text = "\n".join(announcement(scenario, scenario.plays))
    own = [frame for frame in played(name).frames if not frame.is_rx]
    assert min(frame.timestamp for frame in own) > LOOK_OUT - 0.001  # in the pack's time
    for frame in own:
        assert f"0x{frame.arbitration_id:08X}" in text
    commands = [values(frame) for frame in own if frame.arbitration_id == V2B_CMD.FRAME_ID]
    on = any(each["V2B_CMD_HV_OnOff"] == HvCommand.HV_ON for each in commands)
    assert on == ("HV_OnOff = HV On" in text) == ("THE PACK MAY CLOSE ITS CONTACTORS" in text)
    asked = [values(frame) for frame in own if frame.arbitration_id == V2B_RQData.FRAME_ID]
    assert any(each["V2B_RD_RQSysCode"] == 1 for each in asked) == ("Request SysCode" in text)
    wrong = [each for each in own if _is_spoilt(each)]
    assert bool(wrong) == ("every checksum is wrong" in text)


def _is_spoilt(frame: can.Message) -> bool:
    if frame.arbitration_id != V2B_CMD.FRAME_ID:
        return False
    makes = 0
    for byte in frame.data[1:]:
        makes ^= byte
    return makes != frame.data[0]


def test_switching_on_and_off_sends_exactly_what_its_announcement_says() -> None:
    sent = [
        (frame.timestamp - LOOK_OUT, values(frame))
        for frame in played("hv-on-off").frames
        if not frame.is_rx and frame.arbitration_id == V2B_CMD.FRAME_ID
    ]
    closing = ("AttRelayST", "MainMotorConST", "AttConST1")
    changes: list[tuple[float, tuple[object, ...]]] = []
    for second, signals in sent:
        short = {name.removeprefix("V2B_CMD_"): value for name, value in signals.items()}
        assert short["VehicleSpeed"] == 0
        assert short["Heat_OnOff"] in (2, HEAT_LEFT)
        assert {short[f"{each}RelayST"] for each in ("MainPos", "MainNeg", "Prechg")} == {3}
        assert {short[f"AttConST{number}"] for number in (2, 3, 4)} == {1}
        assert {short[f"AttConFlt{number}"] for number in (1, 2, 3, 4)} == {0}
        state = (short["HV_OnOff"], short["HV_ACC_OnOff"], *(short[name] for name in closing))
        if not changes or changes[-1][1] != state:
            changes.append((second, state))
    assert [state for _, state in changes] == [
        (2, 2, 1, 1, 1),
        (2, 2, 2, 2, 2),
        (1, 1, 2, 2, 2),
        (2, 2, 1, 1, 1),
    ]
    first, reported, on, off = (second for second, _ in changes)
    assert first < 0.1
    assert 1.0 <= reported < 1.1
    assert on - reported == pytest.approx(0.1, abs=0.02)  # two frames
    assert 13.0 <= off < 13.1


def test_how_a_pack_reacts_to_silence_is_told_with_its_time(tmp_path: Path) -> None:
    scenario = SCENARIOS["silent-vcu"]
    judgement = judgement_of(scenario, played(scenario.name).frames, tmp_path)
    # The simulated pack takes a command for 0.25 s, and opens after 10 s without any.
    assert judgement.result(SILENT_VCU.id).status is Status.NOTED
    (text,) = said(judgement, SILENT_VCU)
    assert "high voltage opens 10.3 s after the last V2B_CMD" in text


def test_how_a_pack_reacts_to_a_counter_that_stands_still_is_told(tmp_path: Path) -> None:
    scenario = SCENARIOS["stuck-counter"]
    judgement = judgement_of(scenario, played(scenario.name).frames, tmp_path)
    (text,) = said(judgement, STUCK_COUNTER)
    assert "high voltage opens 10.3 s after the counter of V2B_CMD began to stand still" in text


def test_a_pack_that_obeys_spoilt_commands_is_found(tmp_path: Path) -> None:
    scenario = SCENARIOS["wrong-checksum"]
    with bench(lambda bus: Altered(bus, believe_any_checksum)) as rig:
        assert rig.play(scenario).left is Left.SAFE
        judgement = judgement_of(scenario, rig.frames, tmp_path)
    assert judgement.result(WRONG_CHECKSUM.id).status is Status.FAILED
    (text,) = said(judgement, WRONG_CHECKSUM)
    assert 'reports "Precharge"' in text


def test_a_pack_that_does_not_switch_off_is_found_and_not_called_safe(tmp_path: Path) -> None:
    scenario = SCENARIOS["hv-on-off"]
    with bench(lambda bus: Altered(bus, take_off_for_on)) as rig:
        assert rig.play(scenario).left is Left.UNKNOWN
        assert rig.clock.now() == pytest.approx(LOOK_OUT + scenario.seconds + 5.0, abs=0.1)
        judgement = judgement_of(scenario, rig.frames, tmp_path)
    assert judgement.result(hv_off_in_time.RULE.id).status is Status.FAILED


def test_a_pack_that_cannot_switch_on_has_answered_but_did_not_reach_it(tmp_path: Path) -> None:
    scenario = SCENARIOS["silent-vcu"]
    with bench() as rig:
        rig.pack.inject("precharge_failure")
        rig.play(scenario)
        judgement = judgement_of(scenario, rig.frames, tmp_path)
    assert judgement.result(HV_ON.id).status is Status.PASSED
    assert judgement.result(HV_REACHED.id).status is Status.FAILED
    assert judgement.result(SILENT_VCU.id).status is Status.NOT_JUDGED


def test_a_pack_that_does_not_answer_requests_is_found(tmp_path: Path) -> None:
    scenario = SCENARIOS["requests"]
    with bench() as rig:
        rig.pack.node.clear(B2V_BattInfo1)
        rig.play(scenario)
        judgement = judgement_of(scenario, rig.frames, tmp_path)
    (text,) = said(judgement, rule_of("answer-in-time"))
    assert "B2V_BattInfo1" in text


def test_the_truck_can_be_played_beside_the_charger() -> None:
    scenario = SCENARIOS["charge"]
    with bench() as rig:
        stage = rig.stage(is_over=lambda: rig.clock.now() > LOOK_OUT + 4.0)
        stage.play(scenario, scenario.played(["CHG", "VCU"]), rig.frames.append)
        assert stage.left is Left.SAFE
        sent = {frame.arbitration_id for frame in rig.frames if not frame.is_rx}
        commands = {
            values(frame)["V2B_CMD_HV_OnOff"]
            for frame in rig.frames
            if frame.arbitration_id == V2B_CMD.FRAME_ID
        }
    assert {C2B_ACStatus.FRAME_ID, V2B_CMD.FRAME_ID} <= sent
    assert commands == {HvCommand.HV_OFF}


@pytest.mark.parametrize(
    ("name", "nodes", "problem"),
    [
        ("hv-on-off", ["CHG"], "hv-on-off does not play CHG"),
        ("charge", ["VCU"], "charge has to play CHG"),
        ("charge", ["BMU", "CHG"], "charge does not play BMU"),
    ],
)
def test_who_cannot_be_played_is_refused(name: str, nodes: list[str], problem: str) -> None:
    with pytest.raises(ScenarioError, match=problem):
        SCENARIOS[name].played(nodes)


def test_an_unknown_scenario_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(ScenarioError, match="there is no scenario 'fly'; known: hv-on-off, "):
        scenarios_of(["requests", "fly"])
    assert [each.name for each in scenarios_of(["charge", "requests", "charge"])] == [
        "charge",
        "requests",
    ]
