"""The rules on what a pack tells of itself, beyond their case folders."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import can
import cantools
import pytest
from cantools.database.can import Database
from rules.altered import signals
from rules.handmade import Bench, Sketch, at, every
from rules.in_blocks import judged
from rules.recorded import recorded, written

from swapcan.conform import Judgement
from swapcan.messages import B2V_ST0, B2V_ST1
from swapcan.rules.pack import RULES
from swapcan.rules.pack.alarms import alarm_bits
from swapcan.wire import dbc_text

NO_CELL = 65535


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path, RULES)


@pytest.fixture(scope="module")
def driven() -> tuple[can.Message, ...]:
    """Ten seconds of a pack and a truck that drives off; a cycle ends every 100 ms."""
    return recorded("hv_on@0s, ask@1s, drive@2s", seconds=10.0, nodes=("BMU", "VCU"))


def told(judgement: Judgement) -> dict[str, tuple[int, list[str]]]:
    """What was examined and found, by rule."""
    return {
        result.rule.id: (
            result.examined,
            [
                f"{each.start:.3f} {each.end:.3f} {each.order} {each.frames} {each.subject} "
                f"{each.says()}"
                for each in result.occurrences
            ],
        )
        for result in judgement.results
    }


def broken(frames: Sequence[can.Message], path: Path) -> dict[str, int]:
    """How many frames are wrong, by the rules that find any."""
    results = judged(written(frames, path), RULES).results
    return {result.rule.id: result.frames for result in results if result.count}


def test_a_log_whose_pack_tells_its_totals_late_can_be_cut_anywhere(
    driven: tuple[can.Message, ...], tmp_path: Path
) -> None:
    frames = signals("B2V_ST5", 3.0, 3.45, B2V_ST5_Max_Ucell=3700)(driven)
    frames = signals("B2V_ST4", 5.0, 5.85, B2V_ST4_MinTemp_Position=9)(frames)
    log = written(frames, tmp_path / "altered.log")
    whole = told(judged(log, RULES))
    assert whole["cell-extremes-equal"][1]
    assert whole["temperature-extremes-place"][1]
    assert told(judged(log, RULES, 29)) == whole
    assert told(judged(log, RULES, 500)) == whole


@pytest.mark.parametrize("begin", [3.0, 3.05])
@pytest.mark.parametrize(
    ("message", "seconds", "raw", "rule"),
    [
        ("B2V_ST5", 0.299, {"B2V_ST5_Max_Ucell": 3700}, "cell-extremes-equal"),
        ("B2V_ST6", 0.299, {"B2V_ST5_Min_Ucell": 2900}, "cell-extremes-equal"),
        ("B2V_ST5", 0.299, {"B2V_ST5_MaxUcell_CSCNo": 3}, "cell-extremes-place"),
        ("B2V_ST4", 0.599, {"B2V_ST4_Max_Temp": 90}, "temperature-extremes-equal"),
        ("B2V_ST4", 0.599, {"B2V_ST4_MinTemp_Position": 7}, "temperature-extremes-place"),
        ("B2V_ST3", 0.299, {"B2V_ST3_Upack_Batt": 850}, "voltage-is-sum"),
    ],
)
def test_what_is_wrong_for_three_cycles_is_found_by_its_rule_alone(
    driven: tuple[can.Message, ...],
    tmp_path: Path,
    begin: float,
    message: str,
    seconds: float,
    raw: dict[str, int],
    rule: str,
) -> None:
    frames = signals(message, begin, begin + seconds, **raw)(driven)
    assert broken(frames, tmp_path / "altered.log").keys() == {rule}


def test_a_pack_that_drives_keeps_all_rules(
    driven: tuple[can.Message, ...], tmp_path: Path
) -> None:
    assert broken(driven, tmp_path / "driven.log") == {}


def test_what_is_wrong_for_a_moment_may_be_a_peak(
    driven: tuple[can.Message, ...], tmp_path: Path
) -> None:
    frames = signals("B2V_ST5", 3.0, B2V_ST5_Max_Ucell=3700)(driven)
    assert broken(frames, tmp_path / "altered.log") == {}


def test_a_pack_that_tells_nothing_is_not_judged(bench: Bench) -> None:
    invalid = {"B2V_ST5_Max_Ucell": 8191, "B2V_ST5_Avg_Ucell": 8191, "B2V_ST5_MaxUcell_CSCNo": 255}
    assert bench.finds(at(every(0.1, 0, 3), "V2B_CMD")) == {}
    assert bench.finds(
        totals(cells=3),
        cells(every(0.1, 0.08, 2), 3300),
        at(every(0.1, 0, 2), "B2V_ST5", **invalid),
    ).keys() == {"cell-count-announced", "reading-missing"}


def totals(*, cells: int, cscs: int = 1, time: float = 0.0) -> list[Sketch]:
    return at([time], "B2V_BattInfo2", B2V_BI2_TotCSCNum=cscs, B2V_BI2_TotCellNum=cells)


def cells(times: list[float], *values: int, csc: int = 1) -> list[Sketch]:
    first, second, third = (values * 3)[:3]
    return at(
        times,
        "B2V_Ucell",
        B2V_UC_FrameNo=1,
        B2V_UC_CSCNo=csc,
        B2V_UC_CSCNo_UcellN=first,
        B2V_UC_CSCNo_UcellN1=second,
        B2V_UC_CSCNo_UcellN2=third,
    )


def test_cells_without_a_value_count_where_the_pack_tells_that_it_does_not_measure(
    bench: Bench,
) -> None:
    sent = [totals(cells=3), cells(every(0.1, 0.08, 2), 3300, 3300, NO_CELL)]
    healthy = at(every(0.1, 0.05, 2), "B2V_ST1")
    faulty = at(every(0.1, 0.05, 2), "B2V_ST1", B2V_ST1_Flt_HW=1, B2V_ST1_Fault_Levl=1)
    short = ["B2V_BI2_TotCellNum: 0.00 to 0.00 s"]
    assert bench.finds(*sent, healthy)["cell-count-announced"] == short
    assert bench.finds(*sent, faulty)["cell-count-announced"] == []


def test_another_pack_after_a_silence_has_numbers_of_its_own(bench: Bench) -> None:
    def finds(cells_of_the_second: int) -> list[str]:
        return bench.finds(
            at(every(0.1, 0, 2), "B2V_ST1"),
            totals(cells=3),
            cells(every(0.1, 0.08, 2), 3300),
            at(every(0.1, 6, 8), "B2V_ST1"),
            totals(cells=cells_of_the_second, cscs=2, time=6.5),
            cells(every(0.1, 6.08, 8), 3300, csc=1),
            cells(every(0.1, 6.09, 8), 3300, csc=2),
        )["cell-count-announced"]

    assert finds(6) == []
    assert finds(9) == ["B2V_BI2_TotCellNum: 6.50 to 6.50 s"]


def test_a_pack_that_sends_its_cells_slowly_is_not_judged_before_all_came_twice(
    bench: Bench,
) -> None:
    slow = [cells([csc * 0.5, csc * 0.5 + 10], 3300, csc=csc) for csc in range(1, 19)]
    sent = [totals(cells=54, cscs=18), *slow]
    assert bench.finds(*sent)["cell-count-announced"] == []
    until = [[sketch for sketch in each if sketch[0] < 15] for each in sent]
    assert "cell-count-announced" not in bench.finds(*until)


def test_an_extreme_may_be_that_of_a_cell_without_a_value_but_not_lie_between_the_others(
    bench: Bench,
) -> None:
    def finds(highest: int) -> list[str]:
        # The pack is known before its third cell fails.
        return bench.finds(
            totals(cells=3),
            cells(every(0.1, 0.08, 0.98), 3300, 3310, 3320),
            at(every(0.1, 0.05, 0.95), "B2V_ST5", B2V_ST5_Max_Ucell=3320),
            cells(every(0.1, 1.08, 2), 3300, 3310, NO_CELL),
            at(every(0.1, 1.05, 2), "B2V_ST5", B2V_ST5_Max_Ucell=highest),
        )["cell-extremes-equal"]

    assert finds(3340) == []
    assert finds(3304) == ["B2V_ST5_Max_Ucell: 1.05 to 1.75 s"]


@pytest.mark.parametrize("branches", [2, 3])
def test_packs_with_branches_in_parallel_have_the_voltage_of_one(
    bench: Bench, branches: int
) -> None:
    """Cells of 3.3 V, three on a CSC and two CSCs in a branch: 19.8 V in a branch."""
    count = 2 * branches
    found = bench.finds(
        totals(cells=3 * count, cscs=count),
        *(cells(every(0.1, 0.08 + csc / 1000, 2), 3300, csc=csc) for csc in range(1, count + 1)),
        at(every(0.1, 0.05, 2), "B2V_ST3", B2V_ST3_Upack_Batt=198),
    )
    assert "cell-count-announced" in found
    assert "voltage-is-sum" not in found


@pytest.mark.parametrize("counted", [0, 12])
def test_recuperation_may_count_as_charging_or_not(bench: Bench, counted: int) -> None:
    """1000 A into 360 V for 12 s are 1.2 kWh; no charger is connected."""

    def finds(growth: int) -> list[str]:
        return bench.finds(
            at(every(0.1, 0.0, 13), "B2V_ST3", B2V_ST3_Upack_Batt=3600),
            at(every(0.1, 0.05, 13), "B2V_ST2", B2V_ST2_SOC=100, B2V_ST2_Current=0),
            at([0.5], "B2V_ElecEnergy", B2V_TotChgEnergy=1000),
            at([12.5], "B2V_ElecEnergy", B2V_TotChgEnergy=1000 + growth),
        )["energy-follows-power"]

    assert finds(counted) == []
    assert finds(17) == ["B2V_TotChgEnergy: 0.50 to 12.50 s"]


def test_every_alarm_of_table_12_is_found_where_cantools_puts_it() -> None:
    database = cantools.database.load_string(dbc_text(), "dbc")
    assert isinstance(database, Database)
    found = 0
    for message in (B2V_ST0, B2V_ST1):
        codec = database.get_message_by_name(message.NAME)
        zeros = {signal.name: 0 for signal in codec.signals}
        for signal in codec.signals:
            highest = (1 << signal.length) - 1
            data = codec.encode({**zeros, signal.name: highest}, scaling=False, strict=False)
            raised = alarm_bits(message).raised(int.from_bytes(data, "little"))
            if "_Flt_" in signal.name:
                found += 1
                assert raised == {signal.name: 0 if highest == 1 else 3}
            else:
                assert raised == {}
    assert found == 44
