"""Cell voltages and probe temperatures into frames: the bytes of tables 9 and 10."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from transfer.wire import payloads

from swapcan import SignalState
from swapcan.transfer import (
    CellVoltages,
    ProbeTemperatures,
    split_cell_voltages,
    split_probe_temperatures,
)
from typedcan.transfer import TransferError

INVALID = SignalState.INVALID


def test_three_cells_go_into_a_frame_and_numbers_begin_anew_in_each_csc() -> None:
    frames = split_cell_voltages({2: [3.3], 1: [3.0, 3.001, 3.002, INVALID]})
    assert payloads(frames) == [
        "0101" + "b80b" + "b90b" + "ba0b",
        "0201" + "ffff" * 3,
        "0102" + "e40c" + "ffff" * 2,
    ]


def test_six_probes_go_into_a_frame() -> None:
    frames = split_probe_temperatures({1: [-50, 0, 25, 25.4, 100, 204, INVALID, 20]})
    assert payloads(frames) == ["0101" + "00324b4b96fe", "0201" + "ff46ffffffff"]


def test_a_csc_without_probes_takes_no_frame() -> None:
    assert payloads(split_probe_temperatures({1: [], 2: [0]})) == ["0102" + "32ffffffffff"]


def test_the_largest_numbers_that_the_frames_can_say_have_room() -> None:
    frames = split_cell_voltages({254: [3.0] * 765})
    assert payloads(frames[-1:]) == ["fffe" + "b80b" * 3]


@pytest.mark.parametrize(
    ("split", "problem"),
    [
        (lambda: split_cell_voltages({0: [3.0]}), "CSC 0; CSCs are numbered 1 to 254"),
        (lambda: split_cell_voltages({255: [3.0]}), "CSC 255; CSCs are numbered 1 to 254"),
        (lambda: split_cell_voltages({1: [3.0] * 766}), "CSC 1 has 766 readings, 255 frames"),
        (lambda: split_cell_voltages({1: [3.0, 66.0]}), "CSC 1 number 2: 66 V is out of range"),
        (lambda: split_cell_voltages({1: [65.535]}), "CSC 1 number 1: 65.535 would be sent as"),
        (lambda: split_cell_voltages({1: [SignalState.ABNORMAL]}), "has no code for Abnormal"),
        (lambda: split_probe_temperatures({3: [20.0] * 7 + [-51.0]}), "CSC 3 number 8: -51 degC"),
    ],
)
def test_what_does_not_fit_is_refused(split: Callable[[], object], problem: str) -> None:
    with pytest.raises(TransferError) as error:
        split()
    assert problem in str(error.value)


def test_readings_are_found_by_csc_and_number() -> None:
    cells = CellVoltages({1: [3.1, 3.2], 2: [INVALID]}, at=12.5)
    assert cells[1][2] == 3.2
    assert cells[2][1] is INVALID
    assert list(cells) == [1, 2]
    assert (len(cells), cells.count, cells.at) == (2, 3, 12.5)
    assert cells.flat() == (3.1, 3.2, INVALID)
    assert cells == {1: {1: 3.1, 2: 3.2}, 2: {1: INVALID}}
    assert repr(cells) == "<CellVoltages: 3 readings of 2 CSCs at 12.5 s>"


def test_readings_cannot_be_changed() -> None:
    probes = ProbeTemperatures({1: [20.0]}, at=0.0)
    with pytest.raises(TypeError):
        probes[1][1] = 30.0  # type: ignore[index]
    with pytest.raises(TypeError):
        probes[1] = {}  # type: ignore[index]
