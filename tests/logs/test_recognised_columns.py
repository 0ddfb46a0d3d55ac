"""Columns of cells come in the reading of the standard in which the frames are sent."""

from __future__ import annotations

from pathlib import Path

import pytest

from swapcan.logs import Options, TransferTables, convert_logs, tables

UCELL = 0x18C1D0F3
CELLS = Options(derived=(TransferTables,))
CSCS, FRAMES = 16, 8


def millivolts(csc: int, cell: int) -> int:
    return 3000 + 100 * csc + cell


def lines(*, through: bool, step: float, sets: int, begin: float = 0.0) -> list[str]:
    """Frames of 384 cells as candump writes them, made by hand: number, CSC, three voltages."""
    found: list[str] = []
    for place in range(sets * CSCS * FRAMES):
        csc, frame = place // FRAMES % CSCS + 1, place % FRAMES + 1
        number = frame + FRAMES * (csc - 1) * through
        cells = (millivolts(csc, 3 * frame - back) for back in (2, 1, 0))
        data = bytes([number, csc]) + b"".join(cell.to_bytes(2, "little") for cell in cells)
        found.append(f"({begin + place * step:.6f}) can0 {UCELL:08X}#{data.hex().upper()}")
    return found


def log_of(path: Path, text: list[str]) -> Path:
    log = path / "pack.log"
    log.write_text("\n".join(text) + "\n")
    return log


@pytest.mark.parametrize("through", [False, True])
@pytest.mark.parametrize("step", [0.0005, 0.1])
def test_384_cells_are_put_together_as_they_are_numbered_and_paced(
    tmp_path: Path, *, through: bool, step: float
) -> None:
    log = log_of(tmp_path, lines(through=through, step=step, sets=5))
    table = tables(log, options=CELLS)["cells_16x24"]
    assert table.num_rows >= 4
    names = "E50b" if through else "E50", "E55b" if step == 0.1 else "E55"
    assert (table.schema.metadata or {})[b"read_as"].decode() == ", ".join(names)
    for csc in range(1, CSCS + 1):
        for cell in range(1, 25):
            volts = table[f"cell_{csc}_{cell}"].to_pylist()
            assert volts == pytest.approx([millivolts(csc, cell) / 1000] * table.num_rows)


def test_three_frames_by_hand(tmp_path: Path) -> None:
    text = lines(through=True, step=0.1, sets=3)
    # Frame 1 of CSC 1; frame 107, the third of CSC 14; frame 128, the last of CSC 16.
    text[0] = "(0.000000) can0 18C1D0F3#0101D90CE40CFFFF"
    text[106] = "(10.600000) can0 18C1D0F3#6B0E100E110E120E"
    text[127] = "(12.700000) can0 18C1D0F3#8010B80BB90B010C"
    table = tables(log_of(tmp_path, text), options=CELLS)["cells_16x24"]
    assert table["timestamp"][0].as_py() == pytest.approx(12.7)
    first = {name: table[name][0].as_py() for name in table.column_names}
    assert [first[f"cell_1_{n}"] for n in (1, 2)] == pytest.approx([3.289, 3.3])
    assert first["cell_1_3"] is None
    assert [first[f"cell_14_{n}"] for n in (7, 8, 9)] == pytest.approx([3.6, 3.601, 3.602])
    assert [first[f"cell_16_{n}"] for n in (22, 23, 24)] == pytest.approx([3.0, 3.001, 3.073])


def test_a_log_in_two_readings_says_so(tmp_path: Path) -> None:
    old = lines(through=False, step=0.0005, sets=40)
    new = lines(through=True, step=0.0005, sets=40, begin=2.56)
    log = log_of(tmp_path, old + new)
    _, summary = convert_logs([log], tmp_path / "out", CELLS, jobs=1)
    assert set(summary.recognised["cells"]) == {"E50", "E50b", "E55"}
    assert summary.recognised["cells"]["E50b"] >= 30
    assert summary.recognised["cells"]["E50"] >= 30
    assert summary.problems["cell_voltages"]["reading"] == 1
    said = "\n".join(summary.lines())
    assert "cells read as E55" in said
    assert "transfers in several readings: cell_voltages 1" in said
    assert summary.as_json()["recognised"]["cells"].keys() == {"E50", "E50b", "E55"}


def test_tables_that_are_named_by_what_they_hold_have_files(tmp_path: Path) -> None:
    log = log_of(tmp_path, lines(through=False, step=0.0005, sets=40))
    convert_logs([log], tmp_path / "out", CELLS, jobs=1)
    assert (tmp_path / "out" / "cells_16x24.parquet").is_file()
