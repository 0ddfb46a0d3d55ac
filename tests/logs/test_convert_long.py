"""The long table: a row per signal, in the order of the frames."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import can
import cantools
import pytest
from cantools.database.can import Database
from logs.table_logs import START, decoded, own_database, traffic, write_frames

import swapcan
from swapcan.logs import tables
from swapcan.messages import B2V_ST2, MESSAGES
from typedcan.logs.pipeline import Layout, Options
from typedcan.model.signal_state import SignalState

_DBC = Path(__file__).parents[1] / "fixtures" / "dbc"
_LONG = Options(layout=Layout.LONG)
_WORDS = {SignalState.INVALID: "invalid", SignalState.ABNORMAL: "abnormal"}


def test_every_signal_of_every_frame_makes_a_row_in_the_order_of_the_frames(
    tmp_path: Path,
) -> None:
    frames = traffic(12)
    with can.LogReader(write_frames(tmp_path / "x.blf", frames)) as reader:
        frames = list(reader)
    expected = []
    for frame in frames:
        (name, (values,)), *_ = decoded([frame]).items()
        kind = swapcan.message_type(name)
        for part in kind.FIELDS.values():
            codes = {c * part.factor + part.offset: s for c, s in part.states.items()}
            value = values[part.dbc_name]
            state = _WORDS.get(codes[value], "value") if value in codes else "value"
            expected.append(
                (
                    frame.timestamp,
                    "0",
                    name,
                    part.dbc_name,
                    None if value in codes else value,
                    state,
                )
            )
    table = tables(tmp_path / "x.blf", options=_LONG)["signals"]
    names = ("timestamp", "channel", "message", "signal", "value", "state")
    found = list(zip(*(table.column(name).to_pylist() for name in names), strict=True))
    assert table.num_rows > 1 << 14
    assert found == expected


def test_labels_stand_beside_the_values_that_have_one(tmp_path: Path) -> None:
    frames = traffic(2)
    log = write_frames(tmp_path / "x.log", frames)
    table = tables(log, options=_LONG)["signals"]
    labels: dict[tuple[str, str, float], str] = {}
    for message in own_database().messages:
        for signal in message.signals:
            for code, label in (signal.choices or {}).items():
                value: Any = signal.raw_to_scaled(code, decode_choices=False)
                labels[message.name, signal.name, float(value)] = str(label)
    rows = table.select(["message", "signal", "value", "label"]).to_pylist()
    assert any(row["label"] for row in rows)
    for row in rows:
        known = labels.get((row["message"], row["signal"], row["value"]))
        assert row["label"] == known


def test_signals_that_a_frame_has_not_make_no_row(tmp_path: Path) -> None:
    # In the fixture the multiplexer chooses what the other bytes hold.
    dbc = _DBC / "multiplexed.dbc"
    table = tables(_multiplexed(tmp_path), options=Options(layout=Layout.LONG, dbc=dbc))
    rows = table["signals"].select(["timestamp", "signal"]).to_pylist()
    by_frame: dict[float, set[str]] = {}
    for row in rows:
        by_frame.setdefault(row["timestamp"], set()).add(row["signal"])
    assert by_frame == _expected(dbc)


@pytest.mark.parametrize("name", ["B2V_ST2", "V2B_CMD"])
def test_only_the_messages_asked_for_make_rows(tmp_path: Path, name: str) -> None:
    log = write_frames(tmp_path / "x.log", traffic(2))
    options = Options(layout=Layout.LONG, messages=(name,))
    table = tables(log, options=options)["signals"]
    assert set(table.column("message").to_pylist()) == {name}


def test_a_log_without_frames_of_the_protocol_makes_no_rows(tmp_path: Path) -> None:
    assert B2V_ST2 in MESSAGES
    log = write_frames(tmp_path / "x.log", [can.Message(START, 0x123, data=b"1")])
    assert tables(log, options=_LONG) == {}


def _frames(dbc: Path) -> list[tuple[can.Message, set[str]]]:
    """A frame for each branch, and the signals that it has."""
    database = cantools.database.load_file(dbc)
    assert isinstance(database, Database)
    frames: list[tuple[can.Message, set[str]]] = []
    for message in database.messages:
        codes = sorted({i for s in message.signals for i in s.multiplexer_ids or ()})
        for code in codes:
            own = [s for s in message.signals if code in (s.multiplexer_ids or (code,))]
            values = {s.name: code if s.is_multiplexer else s.offset for s in own}
            data = message.encode(values, strict=False)
            frame = can.Message(
                START + len(frames),
                message.frame_id,
                is_extended_id=message.is_extended_frame,
                data=data,
            )
            frames.append((frame, set(values)))
    return frames


def _multiplexed(folder: Path) -> Path:
    frames = [frame for frame, _ in _frames(_DBC / "multiplexed.dbc")]
    return write_frames(folder / "x.log", frames)


def _expected(dbc: Path) -> dict[float, set[str]]:
    return {frame.timestamp: names for frame, names in _frames(dbc)}
