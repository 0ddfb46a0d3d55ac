"""Tables in memory: the values of cantools, the states of the live runtime, and metadata."""

from __future__ import annotations

import json
from pathlib import Path

import can
import cantools
import polars as pl
import pyarrow as pa
import pytest
from cantools.database.can import Database, Message
from logs.table_logs import START, decoded, traffic, write_frames

import swapcan
from swapcan._generated import DIGEST
from swapcan.logs import tables
from swapcan.messages import B2V_ST2, MESSAGES
from typedcan.logs.database import DbcError
from typedcan.logs.pipeline import Options
from typedcan.logs.plan import Mode, SelectionError
from typedcan.model.signal_state import SignalState

_DBC = Path(__file__).parents[1] / "fixtures" / "dbc"
_WORDS = {SignalState.INVALID: "invalid", SignalState.ABNORMAL: "abnormal"}


@pytest.fixture(scope="module")
def frames() -> list[can.Message]:
    return traffic(12)


@pytest.fixture(scope="module")
def log(frames: list[can.Message], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_frames(tmp_path_factory.mktemp("arrow") / "drive.blf", frames)


def test_every_message_has_the_values_of_cantools_and_null_where_a_code_is_reserved(
    frames: list[can.Message], log: Path
) -> None:
    expected = decoded(frames)
    found = tables(log)
    assert found.keys() == expected.keys() == {message.NAME for message in MESSAGES}
    for name, rows in expected.items():
        reserved = swapcan.message_type(name).FIELDS.values()
        for part in reserved:
            codes = {code * part.factor + part.offset for code in part.states}
            values = [row[part.dbc_name] for row in rows]
            assert found[name].column(part.dbc_name).to_pylist() == [
                None if value in codes else value for value in values
            ]


def test_times_and_channels_are_those_of_the_frames(frames: list[can.Message], log: Path) -> None:
    own = [frame for frame in frames if frame.arbitration_id == B2V_ST2.FRAME_ID]
    table = tables(log)["B2V_ST2"]
    with can.LogReader(log) as reader:
        read = [frame for frame in reader if frame.arbitration_id == B2V_ST2.FRAME_ID]
    assert table.column("timestamp").to_pylist() == [frame.timestamp for frame in read]
    assert table.column("channel").to_pylist() == ["0"] * len(own)


def test_states_are_those_that_the_live_runtime_decodes(
    frames: list[can.Message], log: Path
) -> None:
    found = tables(log)
    seen = set()
    for kind in MESSAGES:
        own = [frame for frame in frames if frame.arbitration_id == kind.FRAME_ID]
        messages = [swapcan.decode(kind.FRAME_ID, bytes(frame.data)) for frame in own]
        for part in kind.FIELDS.values():
            column = f"{part.dbc_name}.state"
            assert (column in found[kind.NAME].column_names) == bool(part.states)
            if not part.states or any(part.states[code] not in _WORDS for code in part.states):
                continue
            values = [getattr(message, part.name) for message in messages]
            if any(isinstance(value, SignalState) for value in values):
                expected = [
                    _WORDS[value] if isinstance(value, SignalState) else "value" for value in values
                ]
                assert found[kind.NAME].column(column).to_pylist() == expected
                seen.update(expected)
    assert seen >= {"value", "invalid"}


def test_a_column_carries_unit_scaling_labels_and_where_in_the_standard_it_stands(
    log: Path,
) -> None:
    found = tables(log)
    soc = found["B2V_ST2"].schema.field("B2V_ST2_SOC")
    assert soc.metadata is not None
    assert soc.metadata[b"unit"] == b"%"
    assert (float(soc.metadata[b"factor"]), float(soc.metadata[b"offset"])) == (0.4, 0)
    assert soc.metadata[b"reference"] == b"Table 1 row 1 (5.1.1)"
    assert soc.metadata[b"signal"] == b"B2V_ST2_SOC"
    command = found["V2B_CMD"].schema.field("V2B_CMD_HV_OnOff")
    assert command.metadata is not None
    labels = json.loads(command.metadata[b"labels"])
    part = next(p for p in swapcan.message_type("V2B_CMD").FIELDS.values() if p.name == "hv_on_off")
    assert labels == {str(code): label for code, label in part.labels.items()}


def test_a_table_says_which_protocol_and_which_spec_it_is_of(log: Path) -> None:
    metadata = tables(log)["B2V_ST2"].schema.metadata
    assert metadata is not None
    assert metadata[b"protocol"] == b"caamtb-swap"
    assert metadata[b"spec_digest"] == DIGEST.encode()
    assert metadata[b"message"] == b"B2V_ST2"
    assert metadata[b"swapcan"]


def test_raw_tables_have_what_is_on_the_wire_in_the_smallest_type(
    frames: list[can.Message], log: Path
) -> None:
    options = Options(messages=("B2V_ST2",), mode=Mode.RAW)
    table = tables(log, options=options)["B2V_ST2"]
    own = [frame.data[0] for frame in frames if frame.arbitration_id == B2V_ST2.FRAME_ID]
    assert table.column("B2V_ST2_SOC").to_pylist() == own  # the signal fills the first byte
    assert table.schema.field("B2V_ST2_SOC").type == pa.uint8()
    assert not [name for name in table.column_names if name.endswith(".state")]


def test_labels_stand_for_codes_and_digits_where_a_code_has_none(tmp_path: Path) -> None:
    kind = swapcan.message_type("B2V_SysCode1")
    part = next(p for p in kind.FIELDS.values() if p.dbc_name == "B2V_SC1_Manufacturer")
    named, free = next(iter(part.labels)), max(part.labels) + 1
    datas = [swapcan.encode(kind(**{part.name: code})) for code in (named, free, named)]
    log = write_frames(
        tmp_path / "x.log",
        [can.Message(1e9 + n, kind.FRAME_ID, data=data) for n, data in enumerate(datas)],
    )
    options = Options(signals=(part.dbc_name,), mode=Mode.LABELS)
    column = tables(log, options=options)[kind.NAME].column(part.dbc_name)
    assert column.to_pylist() == [part.labels[named], str(free), part.labels[named]]
    assert pa.types.is_dictionary(column.type)


def test_a_branch_that_a_frame_has_not_is_null(tmp_path: Path) -> None:
    database = _DBC / "multiplexed.dbc"
    message = next(
        message
        for message in _load(database)
        if any(signal.multiplexer_ids for signal in message.signals)
    )
    chooser = next(signal for signal in message.signals if signal.is_multiplexer)
    codes = sorted({i for s in message.signals for i in s.multiplexer_ids or ()})
    rows = []
    for code in codes:
        data = message.encode(
            {
                signal.name: code if signal is chooser else signal.offset
                for signal in message.signals
                if not signal.multiplexer_ids or code in signal.multiplexer_ids
            },
            strict=False,
        )
        rows.append(data)
    extended = message.is_extended_frame
    log = write_frames(
        tmp_path / "x.log",
        [
            can.Message(1e9 + n, message.frame_id, is_extended_id=extended, data=data)
            for n, data in enumerate(rows)
        ],
    )
    table = tables(log, options=Options(dbc=database))[message.name]
    for signal in message.signals:
        expected = [
            message.decode(data, decode_choices=False)[signal.name]  # type: ignore[call-overload]
            if not signal.multiplexer_ids or code in signal.multiplexer_ids
            else None
            for code, data in zip(codes, rows, strict=True)
        ]
        assert table.column(signal.name).to_pylist() == expected


def test_pandas_and_polars_take_the_tables(log: Path) -> None:
    table = tables(log)["B2V_ST2"]
    expected = [value for value in table.column("B2V_ST2_SOC").to_pylist() if value is not None]
    assert table.to_pandas()["B2V_ST2_SOC"].dropna().tolist() == expected
    frame = pl.from_arrow(table)
    assert isinstance(frame, pl.DataFrame)
    assert frame["B2V_ST2_SOC"].drop_nulls().to_list() == expected
    assert frame["B2V_ST2_SOC.state"].to_list() == table["B2V_ST2_SOC.state"].to_pylist()


def test_several_logs_follow_one_another(log: Path, tmp_path: Path) -> None:
    later = write_frames(tmp_path / "later.blf", traffic(2, START + 1000))
    parts = [tables(each)["B2V_ST2"].to_pydict() for each in (log, later)]
    both = tables(later, log)["B2V_ST2"].to_pydict()  # in the order in which they were recorded
    assert both == {name: values + parts[1][name] for name, values in parts[0].items()}


@pytest.mark.parametrize(
    ("asked", "found"),
    [
        (("B2V_ST2_SOC",), ["B2V_ST2_SOC"]),
        (("B2V_ST2.B2V_ST2_SOC",), ["B2V_ST2_SOC"]),
        (("st2_soc",), ["B2V_ST2_SOC"]),
        (("Current", "SOC"), ["B2V_ST2_SOC", "B2V_ST2_Current"]),
    ],
)
def test_signals_are_found_by_name_message_or_the_end_of_their_name(
    log: Path, asked: tuple[str, ...], found: list[str]
) -> None:
    table = tables(log, options=Options(messages=("B2V_ST2",), signals=asked))["B2V_ST2"]
    names = [n for n in table.column_names[2:] if not n.endswith(".state")]
    assert names == found


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (Options(messages=("B2V_ST9",)), "no message 'B2V_ST9'"),
        (Options(signals=("SOX",)), "no signal 'SOX'"),
        (Options(messages=("B2V_ST1",), signals=("B2V_ST2_SOC",)), "in B2V_ST1"),
    ],
)
def test_a_name_that_is_none_is_an_error(log: Path, options: Options, text: str) -> None:
    with pytest.raises(SelectionError, match=text):
        tables(log, options=options)


def test_a_dbc_that_is_missing_or_broken_is_an_error_that_names_it(
    log: Path, tmp_path: Path
) -> None:
    with pytest.raises(DbcError, match=r"none\.dbc"):
        tables(log, options=Options(dbc=tmp_path / "none.dbc"))
    broken = tmp_path / "broken.dbc"
    broken.write_text("BO_ nonsense")
    with pytest.raises(DbcError, match=r"broken\.dbc"):
        tables(log, options=Options(dbc=broken))


def _load(path: Path) -> list[Message]:
    database = cantools.database.load_file(path)
    assert isinstance(database, Database)
    return list(database.messages)
