"""`swapcan plot` to a page: what its data say about a log, against what was sent."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Mapping
from pathlib import Path

import cantools
import pytest
from logs.cell_logs import INVALID, Reading, cycle, totals
from logs.plot_logs import array, curve, data_of, marks, plot, spans, times, write

from swapcan.messages import B2V_ST1, B2V_ST2, BmsState
from typedcan.model.errors import TypedcanError
from typedcan.shell.console import CommandError
from typedcan.wire.message import Message


def soc(value: Reading, current: Reading = 0.0) -> B2V_ST2:
    return B2V_ST2(soc=value, soh=100, current=current)


def test_values_and_times_are_those_of_the_log(tmp_path: Path) -> None:
    values = [80.0, 79.6, 79.2, 60.0, 79.2]
    sent = [(k * 0.1, soc(value, current=-k / 2)) for k, value in enumerate(values)]
    log = write(tmp_path / "drive.log", sent)
    assert plot(log, "--signals", "SOC,Current", "-o", tmp_path / "out.html") == 0
    data = data_of(tmp_path / "out.html")
    assert curve(data, "B2V_ST2_SOC") == ([0.0, 0.1, 0.2, 0.3, 0.4], values, [1, 0, 0, 0, 0])
    assert curve(data, "B2V_ST2_Current")[1] == [0.0, -0.5, -1.0, -1.5, -2.0]
    assert [strip["unit"] for strip in data["strips"]] == ["%", "A"]
    assert data["begin"] == 1_700_000_000.0


def test_signals_of_one_unit_share_a_strip(tmp_path: Path) -> None:
    log = write(tmp_path / "drive.asc", [(0.0, soc(80)), (0.1, soc(80))])
    plot(log, "--signals", "SOC,Current,SOH", "-o", tmp_path / "out.html")
    strips = data_of(tmp_path / "out.html")["strips"]
    names = [[each["name"] for each in strip["curves"]] for strip in strips]
    assert names == [["B2V_ST2_SOC", "B2V_ST2_SOH"], ["B2V_ST2_Current"]]


def test_no_line_crosses_a_gap_or_what_is_invalid(tmp_path: Path) -> None:
    sent = [(round(k * 0.1, 1), soc(80.0)) for k in range(30) if not 10 <= k < 20]
    sent[5] = (0.5, soc(INVALID))
    sent[6] = (0.6, soc(INVALID))
    log = write(tmp_path / "drive.asc", sent)
    plot(log, "--signals", "SOC", "-o", tmp_path / "out.html")
    data = data_of(tmp_path / "out.html")
    # Frames come every 100 ms; ten are missing after the one at 0.9 s.
    expected = {"gap": [(0.9, 2.0)], "invalid": [(0.5, 0.7)]}
    assert marks(data, "B2V_ST2_SOC") == expected
    time, _, begins = curve(data, "B2V_ST2_SOC")
    assert [t for t, begin in zip(time, begins, strict=True) if begin] == [0.0, 0.7, 2.0]
    assert 0.5 not in time


def test_five_periods_without_a_frame_are_no_gap(tmp_path: Path) -> None:
    log = write(tmp_path / "drive.asc", [(0.0, soc(80)), (0.49, soc(80)), (1.0, soc(80))])
    plot(log, "--signals", "SOC", "-o", tmp_path / "out.html")
    assert marks(data_of(tmp_path / "out.html"), "B2V_ST2_SOC") == {"gap": [(0.49, 1.0)]}


def test_a_message_that_begins_late_or_ends_early_has_gaps_there(tmp_path: Path) -> None:
    status = [(round(k * 0.1, 1), B2V_ST1()) for k in range(50)]
    late: list[tuple[float, Message]] = [(t, soc(80)) for t, _ in status if 2 <= t < 3]
    log = write(tmp_path / "drive.asc", sorted([*status, *late], key=lambda each: each[0]))
    plot(log, "--signals", "SOC", "-o", tmp_path / "out.html")
    assert marks(data_of(tmp_path / "out.html"), "B2V_ST2_SOC") == {"gap": [(0.0, 2.0), (2.9, 4.9)]}


def test_a_signal_with_labels_is_a_band_of_its_states(tmp_path: Path) -> None:
    states = [BmsState.HV_OPEN] * 3 + [BmsState.PRECHARGE] * 2 + [BmsState.HV_OPEN] * 3
    sent = [(round(k * 0.1, 1), B2V_ST1(bms=state)) for k, state in enumerate(states)]
    log = write(tmp_path / "drive.asc", sent)
    plot(log, "--signals", "B2V_ST1_BMS", "-o", tmp_path / "out.html")
    data = data_of(tmp_path / "out.html")
    (band,) = data["strips"][0]["bands"]
    found = {each["code"]: (each["label"], spans(data, each["spans"])) for each in band["states"]}
    dbc = cantools.database.load_file(Path("dbc") / "caamtb-swap.dbc")
    assert isinstance(dbc, cantools.database.Database)
    choices: Mapping[int, object] = (
        dbc.get_message_by_name("B2V_ST1").get_signal_by_name("B2V_ST1_BMS").choices or {}
    )
    assert found == {
        BmsState.HV_OPEN: (str(choices[BmsState.HV_OPEN]), [(0.0, 0.3), (0.5, 0.7)]),
        BmsState.PRECHARGE: (str(choices[BmsState.PRECHARGE]), [(0.3, 0.5)]),
    }


def test_a_part_of_the_log_keeps_the_time_of_the_whole(tmp_path: Path) -> None:
    log = write(tmp_path / "drive.asc", [(round(k * 0.1, 1), soc(k)) for k in range(100)])
    plot(log, "--signals", "SOC", "-o", tmp_path / "out.html", "--from", "3", "--to", "3.5")
    time, _, _ = curve(data_of(tmp_path / "out.html"), "B2V_ST2_SOC")
    assert time == [3.0, 3.1, 3.2, 3.3, 3.4, 3.5]


def test_cells_are_a_heat_map_with_their_exact_voltages(tmp_path: Path) -> None:
    lacking: dict[int, list[Reading]] = {1: [3.101, INVALID], 2: [3.303, 3.404]}
    whole: dict[int, list[Reading]] = {1: [3.101, 3.202], 2: [3.303, 3.404]}
    log = write(
        tmp_path / "drive.asc",
        [
            (0.0, totals(2, 4)),
            *((sent.time, sent.message) for sent in cycle(0.0, whole)),
            *((sent.time, sent.message) for sent in cycle(0.1, lacking)),
            *((sent.time, sent.message) for sent in cycle(2.0, whole)),
        ],
    )
    assert plot(log, "--cells", "-o", tmp_path / "out.html") == 0
    data = data_of(tmp_path / "out.html")
    (heat,) = data["strips"]
    assert heat["rows"] == ["cell_1_1", "cell_1_2", "cell_2_1", "cell_2_2"]
    levels = array(heat["low"], "<u2").reshape(3, 4).tolist()
    volts = [
        [None if level == 65535 else round(heat["base"] + level * heat["step"], 6) for level in row]
        for row in levels
    ]
    assert volts[0] == volts[2] == [3.101, 3.202, 3.303, 3.404]
    assert volts[1] == [3.101, None, 3.303, 3.404]
    ends = times(data, heat["spans"])
    assert ends[:4] == [0.002, 0.102, 0.102, 0.202]  # then nothing until the third cycle
    assert ends[4] == 2.002


def test_a_thinned_heat_map_keeps_a_single_spike(tmp_path: Path) -> None:
    calm: dict[int, list[Reading]] = {1: [3.3, 3.3, 3.3]}
    spike: dict[int, list[Reading]] = {1: [3.3, 3.9, 3.3]}
    sent: list[tuple[float, Message]] = [(0.0, totals(1, 3))]
    for k in range(3000):
        by_csc = spike if k == 1234 else calm
        sent += [(each.time, each.message) for each in cycle(round(k * 0.1, 1), by_csc)]
    plot(write(tmp_path / "drive.blf", sent), "--cells", "-o", tmp_path / "out.html")
    (heat,) = data_of(tmp_path / "out.html")["strips"]
    high = array(heat["high"], "<u2").reshape(-1, 3)
    assert len(high) <= 1024
    peaks = [(int(row.max()), int(row.argmax())) for row in high if row.max() > 0]
    assert [(round(heat["base"] + p * heat["step"], 6), at) for p, at in peaks] == [(3.9, 1)]
    assert round(heat["base"] + heat["scale"][1] * heat["step"], 6) == 3.3  # the rest has colours


def test_a_damaged_log_is_drawn_up_to_the_damage(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = write(tmp_path / "drive.log", [(round(k * 0.1, 1), soc(k)) for k in range(100)])
    lines = log.read_text().splitlines(keepends=True)
    log.write_text("".join([*lines[:60], "this is no frame\n", *lines[60:]]))
    assert plot(log, "--signals", "SOC", "-o", tmp_path / "out.html") == 3
    assert "damaged at line 61" in capsys.readouterr().err
    data = data_of(tmp_path / "out.html")
    assert len(curve(data, "B2V_ST2_SOC")[0]) == 100
    assert any("damaged at line 61" in note for note in data["notes"])


def test_frames_that_the_live_runtime_refuses_are_left_out_and_counted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = write(
        tmp_path / "drive.asc", [(k * 0.1, B2V_ST1(bms=BmsState.HV_OPEN)) for k in range(4)]
    )
    text = log.read_text()
    spoilt = re.sub(r"(d 8 )(\w\w)", lambda found: f"{found[1]}EE", text, count=1)
    assert spoilt != text
    log.write_text(spoilt)
    assert plot(log, "--signals", "B2V_ST1_BMS", "-o", tmp_path / "out.html") == 0
    assert "1 frame with a wrong length or checksum" in capsys.readouterr().err


def test_signals_without_a_frame_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = write(tmp_path / "drive.asc", [(0.0, soc(80)), (0.1, soc(80))])
    assert plot(log, "--signals", "SOC,Upack_Batt", "-o", tmp_path / "out.html") == 0
    assert "No frame of B2V_ST3_Upack_Batt" in capsys.readouterr().err
    for wanted in (["--signals", "Upack_Batt"], ["--cells"]):
        assert plot(log, *wanted, "-o", tmp_path / "none.html") == 2
        assert not (tmp_path / "none.html").exists()
    assert "No complete cycle of cells" in capsys.readouterr().err


def test_incomplete_cycles_are_counted_on_the_page(tmp_path: Path) -> None:
    cells: dict[int, list[Reading]] = {1: [3.1], 2: [3.2]}
    sent: list[tuple[float, Message]] = [(0.0, totals(2, 2))]
    for k in range(10):
        frames = list(cycle(round(k * 0.1, 1), cells))
        sent += [(each.time, each.message) for each in frames[: 1 if 3 <= k < 8 else 2]]
    plot(write(tmp_path / "drive.asc", sent), "--cells", "-o", tmp_path / "out.html")
    assert data_of(tmp_path / "out.html")["notes"] == ["Cells: incomplete cycles left out: 1."]


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (["-o", "out.html"], "say what to draw"),
        (["--signals", "SOC", "-o", "out.pdf"], "must end in .html or .png"),
        (["--signals", "*", "-o", "out.html"], "at most 200"),
        (["--signals", "SOX", "-o", "out.html"], "did you mean"),
        (["--signals", "SOC", "--from", "noon", "-o", "out.html"], "expected seconds or a date"),
    ],
)
def test_what_cannot_be_done_is_one_line_and_leaves_nothing(
    arguments: list[str], text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(tmp_path / "drive.asc", [(0.0, soc(80))])
    monkeypatch.chdir(tmp_path)
    with pytest.raises(TypedcanError, match=text) as caught:
        plot("drive.asc", *arguments)
    assert "\n" not in str(caught.value)
    assert [path.name for path in tmp_path.iterdir()] == ["drive.asc"]


def test_an_output_that_is_there_is_replaced_only_on_request(tmp_path: Path) -> None:
    log = write(tmp_path / "drive.asc", [(0.0, soc(80)), (0.1, soc(80))])
    out = tmp_path / "out.html"
    out.write_text("mine")
    with pytest.raises(CommandError, match="--force"):
        plot(log, "--signals", "SOC", "-o", out)
    assert out.read_text() == "mine"
    assert plot(log, "--signals", "SOC", "-o", out, "--force") == 0
    assert curve(data_of(out), "B2V_ST2_SOC")[1] == [80.0, 80.0]


def test_an_output_that_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    log = write(tmp_path / "drive.asc", [(0.0, soc(80)), (0.1, soc(80))])
    with pytest.raises(CommandError, match=os.strerror(errno.ENOENT)):
        plot(log, "--signals", "SOC", "-o", tmp_path / "absent" / "out.html")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drive.asc"]
