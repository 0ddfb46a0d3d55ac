"""Cells and probes are put together in the reading of the standard in which they are sent."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from transfer.wire import totals

from swapcan import PROTOCOL, codec_for
from swapcan.messages import B2V_Temp, B2V_Ucell
from swapcan.transfer import CellVoltages, ProbeTemperatures, Problem, Transfers
from typedcan.transfer import Assembler, Readings

CSCS, CELLS, PROBES = 16, 24, 6


def volts(csc: int, number: int) -> float:
    return round(3 + csc / 10 + number / 1000, 3)


def cell_frames(*, through: bool) -> list[B2V_Ucell]:
    """The frames of 384 cells, each CSC's own numbers or one after the other."""
    return [
        B2V_Ucell(
            csc_no=csc,
            frame_no=(csc - 1) * 8 * through + frame,
            csc_no_ucell_n=volts(csc, 3 * frame - 2),
            csc_no_ucell_n1=volts(csc, 3 * frame - 1),
            csc_no_ucell_n2=volts(csc, 3 * frame),
        )
        for csc in range(1, CSCS + 1)
        for frame in range(1, 9)
    ]


TOTALS = totals(
    {csc: [3.0] * CELLS for csc in range(1, CSCS + 1)},
    {csc: [20.0] * PROBES for csc in range(1, CSCS + 1)},
)
RIGHT = {
    csc: {number: pytest.approx(volts(csc, number)) for number in range(1, CELLS + 1)}
    for csc in range(1, CSCS + 1)
}
Timed = list[tuple[float, B2V_Ucell]]


def timed(frames: Sequence[B2V_Ucell], step: float, begin: float = 0.0) -> Timed:
    return [(begin + place * step, frame) for place, frame in enumerate(frames)]


def taken(transfers: Transfers, frames: Timed) -> list[object]:
    found: list[object] = []
    for at, frame in frames:
        while transfers.next_deadline <= at:
            found += transfers.expire(transfers.next_deadline)
        found += transfers.take(frame, at)
    return found


def begun() -> Transfers:
    transfers = Transfers(PROTOCOL)
    assert transfers.take(TOTALS, 0.0) == ()
    return transfers


@pytest.mark.parametrize("through", [False, True])
@pytest.mark.parametrize("step", [0.0005, 0.1])
@pytest.mark.parametrize("first", [0, 5, 107])
def test_cells_come_in_the_reading_that_frames_tell(
    *, through: bool, step: float, first: int
) -> None:
    transfers, own = begun(), cell_frames(through=through)
    frames = [*own[first:], *own[:first]] if step == 0.1 else own
    sets = taken(transfers, timed(frames * 2, step))
    assert sets == [RIGHT, RIGHT]
    assert all(isinstance(each, CellVoltages) for each in sets)
    names = ("E50b" if through else "E50", "E55b" if step == 0.1 else "E55")
    assert transfers.readings == {"cell_voltages": names}


def test_probes_of_which_a_csc_fills_one_frame_are_numbered_as_their_csc() -> None:
    transfers = begun()
    found: list[object] = []
    for place in range(2 * CSCS):
        csc = place % CSCS + 1
        names = [name for name in B2V_Temp.FIELDS if "temp" in name]
        frame = B2V_Temp(csc_no=csc, frame_no=csc, **dict.fromkeys(names, 20.0 + csc))
        found += transfers.take(frame, place * 0.2)
    right = {csc: dict.fromkeys(range(1, PROBES + 1), 20.0 + csc) for csc in range(1, CSCS + 1)}
    assert found == [right, right]
    assert all(isinstance(each, ProbeTemperatures) for each in found)
    assert transfers.readings == {"probe_temperatures": ("E50b", "E55b")}


def test_a_pack_that_changes_its_reading_is_told_and_followed() -> None:
    transfers = begun()
    old = timed(cell_frames(through=False) * 3, 0.0005)
    new = timed(cell_frames(through=True) * 3, 0.0005, 0.3)
    found = taken(transfers, old + new)
    assert [each for each in found if isinstance(each, CellVoltages)][:3] == [RIGHT] * 3
    told = [each for each in found if isinstance(each, Problem) and each.kind == "reading"]
    assert [each.text for each in told] == ["sent as E50b has it, before as E50"]
    assert found[-1] == RIGHT
    assert transfers.readings == {"cell_voltages": ("E50b", "E55")}


def test_frames_of_one_group_tell_no_numbering() -> None:
    transfers = Transfers(PROTOCOL)
    transfers.take(totals({1: [3.0] * CELLS}, {1: [20.0]}), 0.0)
    frames = [each for each in cell_frames(through=True) if each.csc_no == 1]
    found = taken(transfers, timed(frames * 2, 0.001))
    assert [isinstance(each, CellVoltages) for each in found] == [True, True]
    assert transfers.readings == {"cell_voltages": ("E55",)}


def test_a_set_that_stops_is_overdue_in_the_pace_that_was_recognised() -> None:
    transfers = begun()
    frames = timed(cell_frames(through=True)[:40], 0.1)
    assert taken(transfers, frames) == []
    assert transfers.next_deadline == pytest.approx(1.5 * 12.8)
    [problem] = transfers.expire(transfers.next_deadline)
    assert problem.kind == "timeout"
    assert "within 19.2 s: frame 41 of CSC 6" in problem.text


def test_what_was_chosen_is_not_recognised() -> None:
    chosen = codec_for(readings=["E50b", "E55"]).protocol
    assembler: Assembler[Readings] = Assembler(chosen.transfer("cell_voltages"))
    kinds = {kind.NAME: kind for kind in chosen.messages}
    assembler.take(kinds["B2V_BattInfo2"](**{n: getattr(TOTALS, n) for n in TOTALS.FIELDS}), 0.0)
    frames = [
        kinds["B2V_Ucell"](**{name: getattr(frame, name) for name in frame.FIELDS})
        for frame in cell_frames(through=False) * 2
    ]
    found = [each for frame in frames for each in assembler.take(frame, 0.0)]
    assert found
    assert all(isinstance(each, Problem) and each.kind == "number" for each in found)
    assert assembler.readings == ()
