"""Cell voltages and probe temperatures put together: complete or not, and what is wrong."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import cycle, islice

import pytest
from transfer.wire import delivered, totals

from swapcan import SignalState
from swapcan.messages import B2V_ST2, B2V_BattInfo2, B2V_Temp, B2V_Ucell
from swapcan.transfer import (
    CellAssembler,
    CellVoltages,
    ProbeAssembler,
    ProbeTemperatures,
    Problem,
    Reading,
    split_cell_voltages,
    split_probe_temperatures,
)

INVALID = SignalState.INVALID
Pack = dict[int, list[Reading]]

EVEN: Pack = {1: [3.1, 3.2, 3.3, 3.4], 2: [3.5, 3.6, 3.7, 3.8]}
UNEVEN: Pack = {1: [3.1, 3.2, 3.3, 3.4], 2: [3.5, 3.6, 3.7]}
ALIKE_IN_SUM: Pack = {1: [3.1, 3.2], 2: [3.5, 3.6, 3.7, 3.8]}


def assembler_for(pack: Pack, *, window: float | None = None) -> CellAssembler:
    assembler = CellAssembler(window=window)
    assembler.take(totals(pack, {}), 0.0)
    return assembler


def results(assembler: CellAssembler, frames: Sequence[B2V_Ucell], at: float) -> list[object]:
    return [each for frame in frames for each in assembler.take(frame, at)]


@pytest.mark.parametrize("pack", [EVEN, UNEVEN, ALIKE_IN_SUM])
def test_every_cycle_is_complete_with_its_last_frame(pack: Pack) -> None:
    assembler = assembler_for(pack)
    frames = split_cell_voltages(pack)
    for at in (0.0, 0.1, 0.2):
        assert results(assembler, frames[:-1], at) == []
        [cells] = results(assembler, frames[-1:], at)
        assert isinstance(cells, CellVoltages)
        assert cells == {csc: dict(enumerate(part, 1)) for csc, part in pack.items()}
        assert cells.at == at
    assert assembler.duplicates == 0


def test_values_come_as_they_were_sent() -> None:
    assembler = assembler_for(EVEN)
    [cells] = [c for f in delivered(split_cell_voltages(EVEN)) for c in assembler.take(f, 0.0)]
    assert isinstance(cells, CellVoltages)
    assert cells.flat() == pytest.approx([3.1, 3.2, 3.3, 3.4, 3.5, 3.6, 3.7, 3.8], abs=1e-9)


def test_probes_are_put_together_six_a_frame_also_where_a_csc_has_none() -> None:
    probes: Pack = {1: [20.0, 21.0, INVALID, 23.0, 24.0, 25.0, 26.0], 2: [], 3: [-50.0]}
    assembler = ProbeAssembler()
    assembler.take(totals({1: [3.0], 2: [3.0], 3: [3.0]}, probes), 0.0)
    frames = delivered(split_probe_temperatures(probes))
    assert len(frames) == 3
    [temperatures] = [each for frame in frames for each in assembler.take(frame, 0.0)]
    assert isinstance(temperatures, ProbeTemperatures)
    assert temperatures == {csc: dict(enumerate(part, 1)) for csc, part in probes.items()}


def test_without_the_totals_nothing_is_complete() -> None:
    assembler = CellAssembler()
    assert results(assembler, split_cell_voltages(EVEN) * 3, 0.0) == []
    assert assembler.missing() == "B2V_BattInfo2 with the totals is missing"
    assembler.take(B2V_BattInfo2(tot_csc_num=0, tot_cell_num=0), 0.0)
    assert results(assembler, split_cell_voltages(EVEN), 0.0) == []
    assert assembler.deadline == math.inf


def test_a_lost_frame_is_named_once_and_made_up_for_in_the_next_cycle() -> None:
    assembler = assembler_for(EVEN, window=0.15)
    frames = split_cell_voltages(EVEN)
    lossy = (*frames[:1], *frames[2:])
    assert results(assembler, lossy, 0.0) == []
    assert assembler.missing() == "frame 2 of CSC 1 is missing"
    assert assembler.deadline == 0.15
    text = "not complete within 0.15 s: frame 2 of CSC 1 is missing"
    assert assembler.expire(0.15) == (Problem("cell_voltages", "timeout", text, 0.15),)
    assert results(assembler, lossy, 0.4) == []
    assert assembler.deadline == math.inf
    [cells] = results(assembler, frames[1:2], 0.45)
    assert cells == {csc: dict(enumerate(part, 1)) for csc, part in EVEN.items()}


def test_a_frame_that_comes_again_updates_its_cells() -> None:
    assembler = assembler_for(EVEN)
    frames = split_cell_voltages(EVEN)
    results(assembler, frames[:1], 0.0)
    results(assembler, split_cell_voltages({1: [2.1, 2.2, 2.3]}), 0.01)
    [cells] = results(assembler, frames[1:], 0.02)
    assert isinstance(cells, CellVoltages)
    assert cells[1] == {1: 2.1, 2: 2.2, 3: 2.3, 4: 3.4}
    assert assembler.duplicates == 1


def test_readings_older_than_the_window_do_not_count() -> None:
    assembler = assembler_for(EVEN, window=0.15)
    one, *others = split_cell_voltages(EVEN)
    results(assembler, others, 0.0)
    assert [
        each for each in results(assembler, [one], 0.16) if isinstance(each, CellVoltages)
    ] == []
    assert results(assembler, others[:-1], 0.17) == []
    [cells] = results(assembler, others[-1:], 0.17)
    assert isinstance(cells, CellVoltages)


def test_a_sensor_without_a_value_in_the_middle_or_known_to_be_there_is_invalid() -> None:
    assembler = assembler_for(UNEVEN)
    results(assembler, split_cell_voltages(UNEVEN), 0.0)
    broken: Pack = {1: [INVALID, 3.2, 3.3, INVALID], 2: [3.5, 3.6, INVALID]}
    [cells] = results(assembler, split_cell_voltages(broken), 0.1)
    assert cells == {csc: dict(enumerate(part, 1)) for csc, part in broken.items()}


def test_last_cells_that_never_had_a_value_are_taken_for_cells_after_five_cycles() -> None:
    broken: Pack = {1: [3.1, 3.2, 3.3, INVALID], 2: [3.5, 3.6, 3.7, 3.8]}
    assembler = assembler_for(broken)
    cycles = [results(assembler, split_cell_voltages(broken), 0.1 * n) for n in range(6)]
    assert cycles[:4] == [[]] * 4
    expected = {csc: dict(enumerate(part, 1)) for csc, part in broken.items()}
    assert cycles[4:] == [[expected], [expected]]


def test_without_equal_numbers_last_cells_that_never_had_a_value_keep_it_incomplete() -> None:
    broken: Pack = {1: [3.1, 3.2, 3.3, INVALID], 2: [3.5, 3.6, 3.7]}
    assembler = assembler_for(broken)
    frames = split_cell_voltages(broken) * 9
    outcomes = [each for n, f in enumerate(frames) for each in assembler.take(f, n / 30)]
    assert [str(each) for each in outcomes] == [
        "cell_voltages: not complete within 0.15 s: only 6 of 7 readings had a value yet"
    ]


def test_more_cells_than_the_totals_are_reported() -> None:
    assembler = assembler_for({1: [3.0], 2: [3.0]})
    outcomes = results(assembler, split_cell_voltages({1: [3.0, 3.0, 3.0]}), 0.5)
    text = "3 readings have come, B2V_BattInfo2 counts 2"
    assert outcomes == [Problem("cell_voltages", "totals", text, 0.5)]
    far = results(assembler, split_cell_voltages({1: [3.0] * 60})[-1:], 0.6)
    assert [each.kind for each in far if isinstance(each, Problem)] == ["totals"]


def test_frames_of_nothing_but_fill_are_no_contradiction() -> None:
    assembler = assembler_for(EVEN)
    filled = [B2V_Ucell(csc_no=csc, frame_no=number) for csc in (1, 2) for number in range(3, 21)]
    [cells] = results(assembler, [*filled, *split_cell_voltages(EVEN), *filled], 0.0)
    assert isinstance(cells, CellVoltages)


@pytest.mark.parametrize(("csc", "number"), [(0, 1), (3, 1), (INVALID, 1), (1, 0)])
def test_numbers_that_there_cannot_be_are_reported(csc: int | SignalState, number: int) -> None:
    assembler = assembler_for(EVEN)
    frame = B2V_Ucell(csc_no=csc, frame_no=number, csc_no_ucell_n=3.0)
    text = f"frame {number} of CSC {csc}; there are CSCs 1 to 2"
    assert assembler.take(frame, 1.0) == (Problem("cell_voltages", "number", text, 1.0),)


@pytest.mark.parametrize(("csc", "number"), [(0, 1), (3, 1), (1, 0)])
def test_numbers_that_there_cannot_be_are_reported_of_frames_without_a_value_too(
    csc: int, number: int
) -> None:
    [problem] = assembler_for(EVEN).take(B2V_Ucell(csc_no=csc, frame_no=number), 1.0)
    assert isinstance(problem, Problem)
    assert problem.kind == "number"


def test_other_totals_begin_anew_and_the_same_change_nothing() -> None:
    assembler = assembler_for(EVEN)
    frames = split_cell_voltages(EVEN)
    results(assembler, frames[:-1], 0.0)
    assembler.take(totals(EVEN, {}), 0.0)
    [cells] = results(assembler, frames[-1:], 0.0)
    assert isinstance(cells, CellVoltages)
    results(assembler, frames[:-1], 0.1)
    assembler.take(totals(UNEVEN, {}), 0.1)
    assert results(assembler, frames[-1:], 0.1) == []


def test_after_a_long_silence_it_may_be_another_pack_with_the_same_totals() -> None:
    assembler = assembler_for(ALIKE_IN_SUM)
    results(assembler, split_cell_voltages(ALIKE_IN_SUM), 0.0)
    other: Pack = {1: [3.1, 3.2, 3.3, 3.4], 2: [3.5, 3.6]}
    [cells] = results(assembler, split_cell_voltages(other), 60.0)
    assert cells == {csc: dict(enumerate(part, 1)) for csc, part in other.items()}


def test_another_pack_without_a_silence_contradicts_the_totals_and_is_learnt_anew() -> None:
    assembler = assembler_for(ALIKE_IN_SUM)
    results(assembler, split_cell_voltages(ALIKE_IN_SUM), 0.0)
    other = split_cell_voltages({1: [3.1, 3.2, 3.3, 3.4], 2: [3.5, 3.6]})
    cycles = [results(assembler, other, 0.1 * n) for n in (1, 2, 3)]
    assert [str(each) for each in cycles[0]] == [
        "cell_voltages: 7 readings have come, B2V_BattInfo2 counts 6"
    ]
    assert [len(each) for each in cycles[1:]] == [1, 1]
    assert isinstance(cycles[2][0], CellVoltages)


def test_silence_after_a_result_is_not_the_transfers_to_report() -> None:
    assembler = assembler_for(EVEN)
    results(assembler, split_cell_voltages(EVEN), 0.0)
    assert assembler.deadline == math.inf
    assert assembler.expire(1e9) == ()


def test_cells_take_no_notice_of_probes_and_other_messages() -> None:
    assembler = assembler_for(EVEN)
    for message in (B2V_Temp(csc_no=1, frame_no=1, csc_no_temp_n=20.0), B2V_ST2()):
        assert assembler.take(message, 0.0) == ()
    assert assembler.deadline == math.inf


def test_joining_in_mid_cycle_completes_one_cycle_later() -> None:
    assembler = assembler_for(EVEN)
    frames = list(islice(cycle(split_cell_voltages(EVEN)), 2, 14))
    complete = [n for n, frame in enumerate(frames) if assembler.take(frame, n * 0.025)]
    assert complete == [3, 7, 11]


def test_a_window_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="within 0 s"):
        CellAssembler(window=0)
