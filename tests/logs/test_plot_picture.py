"""`swapcan plot` to a picture."""

from __future__ import annotations

import builtins
import struct
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from logs.cell_logs import Reading, cycle, totals
from logs.plot_logs import plot, write

from swapcan.messages import B2V_ST1, B2V_ST2, BmsState
from typedcan.logs.plot.picture import PictureError


def drive(path: Path) -> Path:
    cells: dict[int, list[Reading]] = {1: [3.3, 3.4]}
    sent: list[Any] = [(0.0, totals(1, 2))]
    for k in range(20):
        sent += [
            (k * 0.1, B2V_ST2(soc=80 - k)),
            (k * 0.1, B2V_ST1(bms=BmsState(k // 10))),
            *((each.time, each.message) for each in cycle(round(k * 0.1, 1), cells)),
        ]
    return write(path, sorted(sent, key=lambda each: each[0]))


def test_a_picture_has_a_strip_for_each_part(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="pictures need matplotlib")
    log = drive(tmp_path / "drive_$x$_.asc")
    assert plot(log, "--signals", "SOC", "-o", tmp_path / "one.png") == 0
    assert plot(log, "--signals", "SOC,B2V_ST1_BMS", "--cells", "-o", tmp_path / "all.png") == 0
    one, whole = ((tmp_path / name).read_bytes() for name in ("one.png", "all.png"))
    assert one.startswith(b"\x89PNG\r\n\x1a\n")
    assert one.endswith(b"IEND\xaeB`\x82")
    width, height = struct.unpack(">II", one[16:24])
    assert struct.unpack(">II", whole[16:24])[0] == width
    assert struct.unpack(">II", whole[16:24])[1] > height


def test_without_matplotlib_one_line_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log = drive(tmp_path / "drive.asc")
    known = builtins.__import__

    def without(name: str, *rest: Any) -> ModuleType:
        if name.split(".")[0] == "matplotlib":
            raise ModuleNotFoundError(name)
        return known(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(PictureError, match=r"pip install 'swapcan\[plot\]'"):
        plot(log, "--signals", "SOC", "-o", tmp_path / "out.png")
    assert not (tmp_path / "out.png").exists()
