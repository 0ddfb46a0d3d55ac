"""Files of every kind, read back by others; complete or not there at all."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import can
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from logs.log_files import NEEDS_ASAMMDF
from logs.table_logs import START, traffic, write_frames

from swapcan.logs import convert_logs, tables
from swapcan.messages import MESSAGES
from typedcan.logs.pipeline import Layout, Options
from typedcan.logs.plan import Mode
from typedcan.logs.read import LogError
from typedcan.logs.write import sink
from typedcan.logs.write.target import OutputError

_ONE = Options(messages=("B2V_ST2",))


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_frames(tmp_path_factory.mktemp("writers") / "drive.blf", traffic(8))


@pytest.fixture(params=[1 << 16, 13])
def _pieces(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows in one piece, or in many."""
    monkeypatch.setattr(sink.Gathering.__init__, "__defaults__", (request.param,))


@pytest.mark.usefixtures("_pieces")
@pytest.mark.parametrize("mode", list(Mode))
@pytest.mark.parametrize("suffix", [".parquet", ".arrow", ".feather"])
def test_parquet_and_arrow_files_hold_values_types_and_metadata(
    log: Path, tmp_path: Path, suffix: str, mode: Mode
) -> None:
    options = Options(mode=mode)
    convert_logs([log], tmp_path / f"out{suffix}", options)
    expected = tables(log, options=options)
    assert {p.stem for p in (tmp_path / "out").iterdir()} == expected.keys()
    for name, table in expected.items():
        path = tmp_path / "out" / f"{name}{suffix}"
        if suffix == ".parquet":
            found = pq.read_table(path)
        else:
            with pa.memory_map(str(path)) as source:
                found = pa.ipc.open_file(source).read_all()
        assert found.to_pydict() == table.to_pydict()
        assert found.schema.equals(table.schema, check_metadata=True)


def test_arrow_files_hold_labels_that_come_up_late(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sink.Gathering.__init__, "__defaults__", (1,))
    kind = next(message for message in MESSAGES if message.NAME == "B2V_SysCode1")
    column = "B2V_SC1_Manufacturer"
    logs = []
    for number, channel in enumerate(("can0", "can1", "can0")):
        data = bytes([0, 0, 0, 0, 0, 0, 0, 0])
        part = [can.Message(START + number, kind.FRAME_ID, data=data, channel=channel)]
        logs.append(write_frames(tmp_path / f"{number}.log", part))
    convert_logs(logs, tmp_path / "x.arrow", Options(signals=(column,), mode=Mode.LABELS), jobs=1)
    with pa.memory_map(str(tmp_path / "x.arrow")) as source:
        found = pa.ipc.open_file(source).read_all()
    assert found.column("channel").to_pylist() == ["can0", "can1", "can0"]


@pytest.mark.usefixtures("_pieces")
def test_csv_files_hold_numbers_words_and_nothing_for_null(log: Path, tmp_path: Path) -> None:
    convert_logs([log], tmp_path / "x.csv", _ONE)
    table = tables(log, options=_ONE)["B2V_ST2"]
    with (tmp_path / "x.csv").open(encoding="utf-8", newline="") as file:
        header, *rows = csv.reader(file)
    assert header == table.column_names
    expected = [list(row.values()) for row in table.to_pylist()]
    assert any(None in row for row in expected)
    for row, values in zip(rows, expected, strict=True):
        for text, value in zip(row, values, strict=True):
            found: Any = float(text) if isinstance(value, int | float) else text or None
            assert found == value


@pytest.mark.usefixtures("_pieces")
def test_mf4_files_have_a_group_per_message_with_units_and_labels(
    log: Path, tmp_path: Path
) -> None:
    asammdf = pytest.importorskip("asammdf", reason="asammdf is an extra of its own")
    convert_logs([log], tmp_path / "x.mf4")
    expected = tables(log)
    with asammdf.MDF(tmp_path / "x.mf4") as file:
        groups = {group.channel_group.acq_name: n for n, group in enumerate(file.groups)}
        assert groups.keys() == expected.keys()
        start = file.header.start_time.timestamp()
        soc = file.get("B2V_ST2_SOC", group=groups["B2V_ST2"])
        table = expected["B2V_ST2"]
        values = table.column("B2V_ST2_SOC").to_pylist()
        assert soc.samples.tolist() == [v for v in values if v is not None]
        assert soc.unit == "%"
        times = table.column("timestamp").to_numpy()[[v is not None for v in values]]
        assert (soc.timestamps + start).tolist() == pytest.approx(times.tolist(), abs=1e-6)
        state = file.get("B2V_ST2_SOC.state", group=groups["B2V_ST2"])
        words = table.column("B2V_ST2_SOC.state").to_pylist()
        assert [word.decode() for word in state.samples] == words
        shown = file.get("B2V_BI1_BattType", group=groups["B2V_BattInfo1"])
        labels = tables(log, options=Options(mode=Mode.LABELS))["B2V_BattInfo1"]
        assert [_text(each) for each in shown.samples] == [
            _text(each) for each in labels.column("B2V_BI1_BattType").to_pylist()
        ]


def _text(sample: Any) -> str:
    """A label, or digits: asammdf shows a code without label as a number."""
    return sample.decode() if isinstance(sample, bytes) else str(sample)


def test_one_table_is_one_file_also_without_rows(log: Path, tmp_path: Path) -> None:
    for name, options in {
        "one": _ONE,
        "long": Options(layout=Layout.LONG),
        "wide": Options(layout=Layout.RASTER),
    }.items():
        target, _ = convert_logs([log], tmp_path / f"{name}.parquet", options)
        assert target.path == tmp_path / f"{name}.parquet"
        assert pq.read_table(target.path).num_rows
    empty = write_frames(tmp_path / "empty.asc", [])
    convert_logs([empty], tmp_path / "none.parquet", _ONE)
    none = pq.read_table(tmp_path / "none.parquet")
    assert none.num_rows == 0
    assert none.column_names == pq.read_table(tmp_path / "one.parquet").column_names


def test_a_name_without_suffix_is_a_folder_of_parquet_files(log: Path, tmp_path: Path) -> None:
    convert_logs([log], tmp_path / "deep" / "out")
    found = {path.name for path in (tmp_path / "deep" / "out").iterdir()}
    assert found == {f"{message.NAME}.parquet" for message in MESSAGES}


def test_what_is_there_is_replaced_only_if_forced(
    log: Path, tmp_path: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    later = write_frames(tmp_path_factory.mktemp("later") / "x.blf", traffic(1, START + 1000))
    for output, options in (("x.parquet", _ONE), ("many.parquet", None)):
        convert_logs([log], tmp_path / output, options)
        with pytest.raises(OutputError, match="--force"):
            convert_logs([log], tmp_path / output, options)
        convert_logs([log, later], tmp_path / output, options, force=True, jobs=1)
    twice = tables(log, later)["B2V_ST2"].num_rows
    assert pq.read_table(tmp_path / "x.parquet").num_rows == twice
    assert pq.read_table(tmp_path / "many" / "B2V_ST2.parquet").num_rows == twice
    assert sorted(path.name for path in tmp_path.iterdir()) == ["many", "x.parquet"]


def test_a_folder_with_other_files_is_never_replaced(log: Path, tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.tex").write_text("years of work")
    with pytest.raises(OutputError, match=r"thesis\.tex"):
        convert_logs([log], tmp_path / "out.parquet", force=True)
    assert (tmp_path / "out" / "thesis.tex").read_text() == "years of work"


def test_a_file_in_the_way_of_a_folder_is_not_replaced(log: Path, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    with pytest.raises(OutputError, match="file of that name"):
        convert_logs([log], tmp_path / "out.parquet", force=True)


@pytest.mark.parametrize(
    ("output", "jobs"),
    [
        ("x.parquet", 1),
        ("x.csv", 1),
        ("x.arrow", 1),
        pytest.param("x.mf4", 1, marks=NEEDS_ASAMMDF),
        ("out", 1),
        ("out", 2),
    ],
)
def test_a_failure_leaves_nothing_behind_and_what_was_there_untouched(
    log: Path, tmp_path: Path, output: str, jobs: int
) -> None:
    old = tmp_path / output
    if output == "out":
        old.mkdir()
        (old / "old.parquet").write_text("old")
    else:
        old.write_text("old")
    missing = log.with_name("missing.blf")
    with pytest.raises(LogError, match=r"missing\.blf"):
        convert_logs([log, missing], old, _ONE, jobs=jobs, force=True)
    assert [path.name for path in tmp_path.iterdir()] == [output]
    left = old / "old.parquet" if output == "out" else old
    assert left.read_text() == "old"


def test_an_unknown_suffix_is_an_error_that_names_those_that_are_known(
    log: Path, tmp_path: Path
) -> None:
    with pytest.raises(OutputError, match=r"\.parquet.*\.mf4"):
        convert_logs([log], tmp_path / "x.xlsx")
    with pytest.raises(OutputError, match="long"):
        convert_logs([log], tmp_path / "x.mf4", Options(layout=Layout.LONG))


def test_a_log_is_never_replaced_by_what_it_becomes(tmp_path: Path) -> None:
    log = write_frames(tmp_path / "x.csv", traffic(1))
    before = log.read_bytes()
    with pytest.raises(OutputError, match="one of the logs"):
        convert_logs([log], tmp_path / "deep" / ".." / "x.csv", _ONE, force=True)
    assert log.read_bytes() == before


def test_a_place_that_cannot_be_written_is_an_error_that_names_it(
    log: Path, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="file"):
        convert_logs([log], tmp_path / "file" / "x.parquet", _ONE)
