"""Bus load: measured against a count by hand, expected against the toolchain's analysis."""

from __future__ import annotations

from pathlib import Path

import can
import pytest
from rules.recorded import recorded, written

from dbcspec.load.analysis import analyse
from dbcspec.load.traffic import Scenario, Size
from swapcan.conform import judge_log
from swapcan.messages import B2V_BattInfo2, B2V_Temp, B2V_Ucell
from typedcan.judge.measure.load import Load
from typedcan.model.protocol import Protocol

BIT_RATE = 250_000


def frame(time: float, identifier: int, data: bytes, channel: str = "can0") -> can.Message:
    return can.Message(
        timestamp=time,
        arbitration_id=identifier,
        is_extended_id=identifier > 0x7FF,
        data=data,
        channel=channel,
    )


def loads(frames: list[can.Message] | tuple[can.Message, ...], path: Path) -> tuple[Load, ...]:
    return judge_log(written(frames, path / "log.log"), rules=[]).load


def pack(groups: int, cells: int, probes: int, *, told: bool) -> list[can.Message]:
    """Some cycles of a pack whose first CSCs have one item more where they do not divide."""
    totals = bytes([groups, *cells.to_bytes(2, "little"), *probes.to_bytes(2, "little"), 0, 0, 0])
    frames = [frame(0, B2V_BattInfo2.FRAME_ID, totals)] if told else []
    for message, items, size in ((B2V_Ucell, cells, 3), (B2V_Temp, probes, 6)):
        for cycle in range(3):
            for group in range(groups):
                own = items // groups + (group < items % groups)
                frames += [
                    frame(0.2 * cycle, message.FRAME_ID, bytes([number + 1, group + 1, *bytes(6)]))
                    for number in range(-(own // -size))
                ]
    return sorted(frames, key=lambda each: each.timestamp)


@pytest.mark.parametrize("told", [True, False])
@pytest.mark.parametrize(("groups", "cells", "probes"), [(18, 216, 36), (3, 13, 20), (1, 1, 1)])
def test_the_expected_load_is_that_of_the_toolchain(
    groups: int, cells: int, probes: int, *, told: bool, protocol: Protocol, tmp_path: Path
) -> None:
    scenario = Scenario(
        sizes={"cell_voltages": Size(groups, cells), "probe_temperatures": Size(groups, probes)},
        conditional=False,
    )
    bus = next(bus for bus in protocol.buses if bus.name == "vehicle")
    own = [
        each
        for each in analyse(protocol, bus, scenario).messages
        if each.message.name in ("B2V_Ucell", "B2V_Temp")
    ]
    (load,) = loads(pack(groups, cells, probes, told=told), tmp_path)
    assert load.expected == pytest.approx(float(sum(each.bare for each in own)), rel=1e-9)
    assert load.expected_stuffed == pytest.approx(
        float(sum(each.stuffed for each in own)), rel=1e-9
    )


def test_a_whole_truck_is_expected_to_load_its_buses_as_the_toolchain_says(
    protocol: Protocol, tmp_path: Path
) -> None:
    frames = recorded("ask@0.5s", seconds=2.0)
    totals = next(each for each in frames if each.arbitration_id == B2V_BattInfo2.FRAME_ID).data
    groups, cells = totals[0], int.from_bytes(totals[1:3], "little")
    probes = int.from_bytes(totals[3:5], "little")
    scenario = Scenario(
        sizes={"cell_voltages": Size(groups, cells), "probe_temperatures": Size(groups, probes)},
        conditional=False,
    )
    found = {load.channel: load for load in loads(frames, tmp_path)}
    assert set(found) == {"vehicle", "charger"}
    vehicle = next(bus for bus in protocol.buses if bus.name == "vehicle")
    analysed = analyse(protocol, vehicle, scenario)
    assert found["vehicle"].expected == pytest.approx(float(analysed.bare), rel=1e-9)
    assert found["vehicle"].expected_stuffed == pytest.approx(float(analysed.stuffed), rel=1e-9)
    # BMU and charger, 131 bits every 0.5 s each.
    assert found["charger"].expected == pytest.approx(2 * 131 / 0.5 / BIT_RATE, rel=1e-9)


def test_the_measured_load_is_what_its_frames_have_in_bits(tmp_path: Path) -> None:
    status = bytes(8)
    frames = [
        frame(0.0, 0x1881D0F3, status),  # ours: 131 bits, 29 stuff bits at most
        frame(0.5, 0x1881D0F3, bytes(3)),  # too short to be ours: 54 + 24 + 13, (78 - 1) // 4
        frame(0.5, 0x123, bytes(2)),  # 34 + 16 + 13, (50 - 1) // 4
        frame(1.0, 0x18ABCDEF, b"", "can1"),  # 67, 53 // 4
        frame(2.0, 0x1801F356, status, "can1"),
    ]
    one, two = loads(frames, tmp_path)
    assert (one.channel, two.channel) == ("can0", "can1")
    assert one.measured == pytest.approx((131 + 91 + 63) / 2 / BIT_RATE)
    assert one.measured_stuffed == pytest.approx((160 + 110 + 75) / 2 / BIT_RATE)
    assert one.own == pytest.approx(131 / 2 / BIT_RATE)
    assert one.own_stuffed == pytest.approx(160 / 2 / BIT_RATE)
    assert two.measured == pytest.approx((67 + 131) / 2 / BIT_RATE)
    assert two.measured_stuffed == pytest.approx((80 + 160) / 2 / BIT_RATE)
    assert two.expected == pytest.approx(131 / 0.5 / BIT_RATE)


def test_a_run_of_the_simulation_measures_what_python_can_counts(tmp_path: Path) -> None:
    frames = recorded("ask@0.5s", seconds=2.0)
    seconds = frames[-1].timestamp - frames[0].timestamp
    for load in loads(frames, tmp_path):
        bits = sum(67 + 8 * len(each.data) for each in frames if each.channel == load.channel)
        assert load.measured == pytest.approx(bits / seconds / BIT_RATE, rel=1e-6)
        assert load.own == load.measured


def test_remote_frames_have_no_payload_and_error_frames_are_not_counted(tmp_path: Path) -> None:
    path = tmp_path / "log.asc"
    frames = [
        can.Message(timestamp=1, arbitration_id=0x123, is_extended_id=False, data=bytes(8)),
        can.Message(
            timestamp=2, arbitration_id=0x123, is_extended_id=False, dlc=8, is_remote_frame=True
        ),
        can.Message(timestamp=2.5, is_error_frame=True),
        can.Message(timestamp=3, arbitration_id=0x123, is_extended_id=False, data=bytes(8)),
    ]
    with can.ASCWriter(path) as writer:
        for each in frames:
            each.channel = 0
            writer.on_message_received(each)
    judgement = judge_log(path, rules=[])
    (load,) = judgement.load
    assert judgement.seconds == pytest.approx(2)
    assert load.measured == pytest.approx((111 + 47 + 111) / 2 / BIT_RATE)


def test_a_log_of_no_length_has_no_load(tmp_path: Path) -> None:
    assert loads([frame(5, 0x1881D0F3, bytes(8))], tmp_path) == ()
