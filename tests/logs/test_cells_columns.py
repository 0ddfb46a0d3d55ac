"""Cells and probes as columns: what a cycle has, which ones are complete, and what is counted."""

from __future__ import annotations

import numpy as np
import pytest
from logs.cell_logs import (
    INVALID,
    Reading,
    Sent,
    cycle,
    decoded,
    decoder,
    put_together,
    rows_of,
    temp,
    totals,
    ucell,
)

from swapcan.log_protocol import CELLS, OWN
from typedcan.logs.columns import State
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.plan import Mode
from typedcan.logs.transfers import ColumnsError, ReadingColumns

TOLD = Sent(0.0, totals(2, 8))
BY_CSC: dict[int, list[Reading]] = {1: [3.1, 3.2, 3.3, 3.4], 2: [3.5, 3.6, 3.7, 3.8]}
NAMED = {
    "cell_1_1": 3.1,
    "cell_1_2": 3.2,
    "cell_1_3": 3.3,
    "cell_1_4": 3.4,
    "cell_2_1": 3.5,
    "cell_2_2": 3.6,
    "cell_2_3": 3.7,
    "cell_2_4": 3.8,
}
LAST = 0.006
"""Seconds from the first to the last frame of a cycle with four frames."""


def cells(*, assume_seen: bool = True) -> ReadingColumns:
    return ReadingColumns([CELLS], assume_seen=assume_seen)


def cycles(count: int, by_csc: dict[int, list[Reading]] | None = None) -> list[Sent]:
    """So many cycles, 100 ms apart."""
    return [sent for k in range(count) for sent in cycle(round(k * 0.1, 6), by_csc or BY_CSC)]


def times(sent: list[Sent], columns: ReadingColumns) -> list[float]:
    return [row[2] for row in rows_of(put_together(sent, columns))]


def test_bytes_written_by_hand_become_volts_and_degrees() -> None:
    frames = [
        (0x18E6D0F3, "01 04 00 02 00 FF FF FF"),  # 1 CSC, 4 cells, 2 probes
        (0x18C1D0F3, "01 01 B8 0B E8 0C D0 07"),  # 3.000 V, 3.304 V, 2.000 V
        (0x18C1D0F3, "02 01 A0 0F FF FF FF FF"),  # 4.000 V
        (0x18C2D0F3, "01 01 00 4B FF FF FF FF"),  # -50 degC, 25 degC
    ]
    block = FrameBlock(
        timestamp=np.array([0.0, 0.1, 0.102, 0.11]),
        frame_id=np.array([frame_id for frame_id, _ in frames], np.uint32),
        flags=np.full(4, int(FrameFlag.EXTENDED), np.uint8),
        channel=np.zeros(4, np.int16),
        length=np.full(4, 8, np.uint8),
        data=np.array([list(bytes.fromhex(text)) for _, text in frames], np.uint8),
        channels=(None,),
    )
    tables = ReadingColumns(OWN.readings, assume_seen=False).add(decoder().decode(block).messages)
    assert rows_of(tables) == [
        (
            "cells_1x4",
            None,
            0.102,
            {"cell_1_1": 3.0, "cell_1_2": 3.304, "cell_1_3": 2.0, "cell_1_4": 4.0},
        ),
        ("probes_1x2", None, 0.11, {"probe_1_1": -50.0, "probe_1_2": 25.0}),
    ]
    assert [table.readings.unit for table in tables] == ["V", "degC"]


def test_a_row_has_all_cells_and_the_time_of_the_last_frame() -> None:
    columns = cells()
    found = rows_of(put_together([TOLD, *cycles(3)], columns))
    assert found == [
        ("cells_2x4", "can0", LAST, NAMED),
        ("cells_2x4", "can0", 0.106, NAMED),
        ("cells_2x4", "can0", 0.206, NAMED),
    ]
    assert columns.counts["cells"].complete == 3


def test_an_invalid_reading_is_no_value_and_has_a_state() -> None:
    lacking: dict[int, list[Reading]] = {1: [3.1, INVALID, 3.3, 3.4], 2: BY_CSC[2]}
    tables = put_together([TOLD, *cycles(1), *cycle(0.1, lacking)], cells())
    table = tables[-1]
    place = table.columns.index("cell_1_2")
    assert np.isnan(table.values[-1, place])
    assert table.state[-1].tolist().count(State.INVALID) == 1
    assert table.state[-1, place] == State.INVALID


def test_a_lost_frame_costs_no_value_that_comes_again_in_time() -> None:
    sent = [TOLD, *cycles(3)]
    del sent[5]  # the first frame of the second cycle
    columns = cells()
    # It comes again with the third cycle; the others are not 150 ms old then.
    assert times(sent, columns) == [LAST, 0.2]
    assert columns.counts["cells"].incomplete == 0


def test_a_cycle_that_stays_incomplete_is_counted_once_and_has_no_row() -> None:
    sent = [TOLD, *cycles(8)]
    silent = [each for each in sent if not (0.15 < each.time < 0.65 and _csc(each) == 2)]
    columns = cells()
    # Again complete when CSC 2 is back; what came of CSC 1 before is renewed by then.
    assert times(silent, columns) == [LAST, 0.106, 0.706]
    assert columns.counts["cells"].incomplete == 1


def _csc(sent: Sent) -> int | None:
    csc = getattr(sent.message, "csc_no", None)
    return csc if isinstance(csc, int) else None


def test_without_totals_a_cycle_has_what_was_seen_in_the_first_seconds() -> None:
    seen: dict[int, list[Reading]] = {1: BY_CSC[1], 2: [3.5, 3.6]}
    columns = cells()
    found = rows_of(put_together(cycles(40, seen), columns))
    assert [row[2] for row in found] == [round(k * 0.1 + 0.004, 6) for k in range(40)]
    assert {row[0] for row in found} == {"cells_1x4_1x2"}
    assert list(found[0][3]) == [f"cell_1_{n}" for n in (1, 2, 3, 4)] + ["cell_2_1", "cell_2_2"]
    assert columns.counts["cells"].unassigned == 0


def test_a_log_shorter_than_these_seconds_has_its_rows_too() -> None:
    assert times(cycles(3), cells()) == [LAST, 0.106, 0.206]


def test_a_frame_that_came_once_by_error_gets_no_column() -> None:
    sent = cycles(40)
    sent.insert(10, Sent(sent[9].time, ucell(77, 3, 1.0, 2.0, 3.0)))
    found = rows_of(put_together(sent, cells()))
    assert {row[0] for row in found} == {"cells_2x4"}
    assert len(found) == 40


def test_where_nothing_is_assumed_frames_before_the_totals_are_counted_only() -> None:
    early = cycles(4)
    later = [Sent(0.35, totals(2, 8)), *cycle(0.4, BY_CSC)]
    columns = cells(assume_seen=False)
    assert times([*early, *later], columns) == [0.406]
    assert columns.counts["cells"].unassigned == len(early)


def test_totals_within_the_first_seconds_hold_for_what_came_before_too() -> None:
    sent = [*cycles(4), Sent(0.35, totals(2, 8)), *cycle(0.4, BY_CSC)]
    assert times(sent, cells()) == [round(k * 0.1 + LAST, 6) for k in range(5)]


def test_a_csc_that_the_totals_do_not_have_is_counted() -> None:
    sent = [TOLD, *cycles(2)]
    sent.insert(3, Sent(0.003, ucell(3, 1, 3.0)))
    columns = cells()
    assert times(sent, columns) == [LAST, 0.106]
    assert columns.counts["cells"].foreign == 1


def test_packs_on_two_channels_stay_apart() -> None:
    other: dict[int, list[Reading]] = {1: [4.1, 4.2, 4.3, 4.4], 2: [4.5, 4.6, 4.7, 4.8]}
    mixed = sorted(
        [
            *(each for k in range(3) for each in cycle(k * 0.1, BY_CSC)),
            *(each for k in range(3) for each in cycle(k * 0.1 + 0.001, other, channel=1)),
        ],
        key=lambda each: each.time,
    )
    found = rows_of(put_together([TOLD, Sent(0.0, totals(2, 8), 1), *mixed], cells()))
    assert [row[3]["cell_2_4"] for row in found if row[1] == "can0"] == [3.8] * 3
    assert [row[3]["cell_2_4"] for row in found if row[1] == "can1"] == [4.8] * 3


def test_another_pack_after_a_silence_has_a_table_of_its_own() -> None:
    small = [each for k in range(30) for each in cycle(60 + k * 0.1, {1: [3.0, 3.1]})]
    found = rows_of(put_together([*cycles(30), *small], cells()))
    assert [row[0] for row in found] == ["cells_2x4"] * 30 + ["cells_1x2"] * 30


@pytest.mark.parametrize("border", range(1, 21))
def test_it_makes_no_difference_where_blocks_end(border: int) -> None:
    sent = [TOLD, *cycles(5)]
    assert rows_of(put_together(sent, cells(), [border])) == rows_of(put_together(sent, cells()))


def test_raw_values_and_missing_signals_are_refused() -> None:
    with pytest.raises(ColumnsError, match="physical values"):
        cells().add(decoded([TOLD, *cycles(1)], Mode.RAW).messages)
    block = decoded([TOLD, *cycles(1)])
    del block.messages["B2V_Ucell"].columns["B2V_UC_CSCNo"]
    with pytest.raises(ColumnsError, match="B2V_UC_CSCNo"):
        cells().add(block.messages)


def test_probes_come_six_a_frame() -> None:
    sent = [
        Sent(0.0, totals(1, 3, 7)),
        Sent(0.1, temp(1, 1, 20, 21, 22, 23, 24, 25)),
        Sent(0.11, temp(1, 2, 26)),
    ]
    found = rows_of(put_together(sent, ReadingColumns(OWN.readings)))
    readings = {f"probe_1_{n}": 19.0 + n for n in range(1, 8)}
    assert found == [("probes_1x7", "can0", 0.11, readings)]
