"""DBC files of every shape: the model has what two other readers see in them."""

from __future__ import annotations

import dataclasses
from decimal import Decimal
from pathlib import Path

import pytest
from read.views import SignalView, by_canmatrix, by_cantools, of_model

from typedcan.databases.database import Labels
from typedcan.databases.dbc import read_any, read_dbc
from typedcan.model.errors import ReadError
from typedcan.model.layout import bits
from typedcan.model.protocol import Aspect, Message, Protocol, SendType, Signal

FIXTURES = Path(__file__).parent.parent / "fixtures"
FILES = sorted((FIXTURES / "dbc").glob("*.dbc"))
ENCODINGS = {"chinese_gbk": "gbk", "chinese_utf8_bom": "utf-8-sig", "western_cp1252": "cp1252"}
REFUSED_BY_CANTOOLS = {"orphans"}
"""It refuses the whole file for statements that nothing claims."""
SHORT_SELECTORS_IN_CANTOOLS = {"long_names"}
"""It gives signals their long names, but names the selecting one by its short name."""
OTHERWISE_IN_CANMATRIX = {
    "chinese_utf8_bom",  # it trips over the byte order mark
    "long_names",  # it keeps the short names
    "orphans",  # it refuses the file, as cantools does
    "other_spacing",  # it drops lines that have other spaces than most
    "periods",  # it takes no period from the default of the attribute
}


def load(name: str) -> Protocol:
    return read_dbc(FIXTURES / "dbc" / f"{name}.dbc")


def signal_of(protocol: Protocol, name: str) -> Signal:
    return next(signal for _, signal in protocol.signals() if signal.name == name)


def test_there_are_files_of_many_shapes() -> None:
    assert len(FILES) >= 20


@pytest.mark.parametrize(
    "path", [path for path in FILES if path.stem not in REFUSED_BY_CANTOOLS], ids=lambda p: p.stem
)
def test_the_model_has_what_cantools_sees(path: Path) -> None:
    seen = by_cantools(path, ENCODINGS.get(path.stem, "ascii"))
    messages, signals = of_model(read_dbc(path), open_limits=seen)
    assert messages == seen[0]
    if path.stem in SHORT_SELECTORS_IN_CANTOOLS:
        signals, seen = _without_selectors(signals), (seen[0], _without_selectors(seen[1]))
    assert signals == seen[1]


@pytest.mark.parametrize(
    "path",
    [path for path in FILES if path.stem not in OTHERWISE_IN_CANMATRIX],
    ids=lambda path: path.stem,
)
def test_the_model_has_what_canmatrix_sees(path: Path) -> None:
    seen = by_canmatrix(path, ENCODINGS.get(path.stem, "ascii"))
    messages, signals = of_model(read_dbc(path), open_limits=seen)
    assert messages == seen[0]
    for name, view in seen[1].items():
        here = signals[name]
        if view.limits == (
            Decimal(0),
            Decimal(0),
        ):  # what canmatrix has where a file leaves them open
            here = dataclasses.replace(here, limits=(Decimal(0), Decimal(0)))
        assert here == view, name
    assert signals.keys() == seen[1].keys()


def _without_selectors(
    signals: dict[tuple[str, str], SignalView],
) -> dict[tuple[str, str], SignalView]:
    return {name: dataclasses.replace(view, selected_by=None) for name, view in signals.items()}


@pytest.mark.parametrize(
    "name",
    [
        "caamtb-swap",
        "caamtb-swap-vehicle",
        "caamtb-swap-charger",
        "caamtb-swap.zh",
        "caamtb-swap.zh-utf8",
    ],
)
def test_the_projects_own_files_have_the_bits_and_meanings_of_its_spec(
    root: Path, protocol: Protocol, name: str
) -> None:
    read = read_dbc(root / "dbc" / f"{name}.dbc")
    assert len(read.messages) >= 2
    for message in read.messages:
        own = protocol.message(message.name)
        assert _facts(message) == _facts(own)
        for signal in message.signals:
            meant = next(each for each in own.signals if each.name == signal.name)
            assert _meaning(signal) == _meaning(meant)
    if "-" not in name.removeprefix("caamtb-swap"):
        assert [each.name for each in read.messages] == [each.name for each in protocol.messages]


def _facts(message: Message) -> tuple[object, ...]:
    return (
        message.frame_id,
        message.extended,
        message.length,
        message.sender,
        message.period,
        message.send_type,
        message.reference,
        message.errata,
        {signal.name for signal in message.signals},
    )


def _meaning(signal: Signal) -> tuple[object, ...]:
    return (
        bits(signal),
        signal.signed,
        signal.factor,
        signal.offset,
        signal.minimum,
        signal.maximum,
        signal.unit,
        [code.value for code in signal.value_table.codes] if signal.value_table else [],
        signal.invalid_code,
        signal.abnormal_code,
        signal.start_value,
        signal.reference,
        signal.errata,
    )


def test_every_signal_and_message_knows_its_line(root: Path) -> None:
    for path in (*FILES, root / "dbc" / "caamtb-swap.dbc"):
        lines = path.read_bytes().decode("latin-1").split("\n")
        for message in read_dbc(path).messages:
            assert message.where.path == str(path)
            assert lines[message.where.line - 1].startswith("BO_ ")
            for signal in message.signals:
                line = lines[signal.where.line - 1].split()
                assert line[0] == "SG_"
                assert signal.name.startswith(line[1].split(":")[0][:30])


def test_a_file_carries_what_it_defines() -> None:
    every = {Aspect.ATTRIBUTES}
    assert load("attributes").carries == {*every, Aspect.PERIODS, Aspect.REFERENCES}
    assert load("j1939").carries == {*every, Aspect.ADDRESSES, Aspect.FRAME_FORMATS}
    assert load("start_values").carries == {*every, Aspect.START_VALUES}
    assert load("shared_value_tables").carries == {*every, Aspect.VALUE_TABLE_NAMES}
    assert load("comments").carries == {*every, Aspect.COMMENTS}
    assert load("motorola").carries == every


def test_attributes_become_what_the_model_has_of_them() -> None:
    protocol = load("attributes")
    message = protocol.message("Attributed")
    assert (protocol.name, protocol.buses[0].bit_rate) == ("Attributes", 500_000)
    assert (message.period, message.send_type) == (100, SendType.IF_ACTIVE)
    assert message.reference == "Annex B, 2"
    assert message.signals[0].reference == "Table 3 row 1"
    assert message.signals[0].errata == ("E01", "E07")
    assert [node.address for node in load("j1939").nodes] == [0, 23]


def test_the_frame_format_is_that_of_the_files_messages() -> None:
    assert load("j1939").frame_format == "J1939PG"
    assert load("both_identifiers").frame_format == "ExtendedCAN"
    assert load("motorola").frame_format == "StandardCAN"


def test_limits_of_zero_to_zero_mean_all_that_the_bits_can_hold() -> None:
    assert signal_of(load("sixty_four_bits"), "Big_Open").maximum == 2**64 - 1
    pressure = signal_of(load("floats"), "Pressure")
    assert pressure.minimum + pressure.maximum == 0
    assert float(pressure.maximum) == 3.4028234663852886e38


def test_start_values_are_raw_and_come_from_the_default_where_none_is_given() -> None:
    protocol = load("start_values")
    assert {signal.name: signal.start_value for _, signal in protocol.signals()} == {
        "From_File": 255,
        "From_Default": 5,
        "Negative": -3,
        "Huge": 2**40 - 1,
    }


def test_equal_codes_share_a_table_under_the_name_that_the_file_gives_it() -> None:
    protocol = load("shared_value_tables")
    first, second = protocol.messages
    tables = {
        (message.name, signal.name): signal.value_table.name
        for message, signal in protocol.signals()
        if signal.value_table
    }
    assert tables == {
        ("First", "Lamp"): "OnOff",
        ("First", "Fan"): "OnOff",
        ("First", "Mode"): "Mode",
        ("First", "Range"): "Range",
        ("Second", "Mode"): "Mode_2",
        ("Second", "SameMode"): "Mode",
        ("Second", "OnOff"): "OnOff_2",
    }
    assert {table.name for table in protocol.value_tables} == {*tables.values(), "Unused"}
    assert first.signals[2].value_table is second.signals[1].value_table


def test_a_label_says_that_a_code_is_invalid_if_no_other_one_does() -> None:
    protocol = load("shared_value_tables")
    assert signal_of(protocol, "Range").invalid_code == 255
    assert signal_of(protocol, "Lamp").invalid_code is None
    path = FIXTURES / "dbc" / "shared_value_tables.dbc"
    labels = Labels(invalid=frozenset({"error", "sna"}))
    assert signal_of(read_dbc(path, labels=labels), "Range").invalid_code is None


def test_chinese_comments_are_titles_and_others_english() -> None:
    for name in ("chinese_gbk", "chinese_utf8_bom"):
        message = load(name).message("BMS_Status")
        assert (message.title, message.english) == ("电池状态信息", "")
        assert signal_of(load(name), "BMS_MaxTemp").unit == "℃"
        assert signal_of(load(name), "BMS_MainRelay").invalid_code == 3
    western = signal_of(load("western_cp1252"), "Temperatur")
    assert (western.unit, western.title) == ("°C", "")
    assert western.english == "Temperatur des Kühlmittels – gemessen am Rücklauf"


def test_comments_keep_their_quotes_and_line_breaks() -> None:
    protocol = load("comments")
    assert signal_of(protocol, "Quoted").english == 'The "raw" value, see // section 3'
    assert signal_of(protocol, "Long").english == "First line\nsecond line\n\nlast line"
    assert protocol.english == "Of the whole file; with a semicolon"
    assert [message.name for message in protocol.messages] == ["Commented"]


def test_statements_that_nothing_claims_do_not_cost_the_file() -> None:
    protocol = load("orphans")
    message = protocol.message("Left")
    assert (message.period, message.send_type) == (20, SendType.CYCLIC)
    assert [each.name for each in protocol.messages] == ["Left"]
    table = message.signals[0].value_table
    assert table is not None
    assert table.labels() == {0: "No", 1: "Yes"}


def test_spaces_and_exponents_may_be_as_they_like() -> None:
    protocol = load("other_spacing")
    two = signal_of(protocol, "Two")
    assert (two.factor, two.maximum) == (Decimal("0.001"), Decimal("0.255"))
    assert signal_of(protocol, "One").receivers == ("B", "A")


def test_of_several_senders_the_first_is_kept() -> None:
    assert load("several_senders").message("Shared").sender == "A"


@pytest.mark.parametrize("ending", ["kcd", "sym"])
def test_other_formats_of_the_same_message_give_the_same_bits(ending: str) -> None:
    protocol = read_any(FIXTURES / "other" / f"cabin.{ending}")
    message = protocol.message("DoorState")
    assert (message.frame_id, message.extended, message.length) == (0x10, False, 2)
    assert message.period == 200
    door, angle = message.signals
    assert door.value_table
    assert door.value_table.labels() == {0: "Closed", 1: "Open"}
    assert bits(angle) == tuple(range(8, 16))
    assert (angle.factor, angle.offset, angle.unit) == (Decimal("0.5"), Decimal(-10), "deg")


def test_a_file_of_an_unknown_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "notes.txt"
    path.write_text("BO_", "ascii")
    with pytest.raises(ReadError, match=r"known: \.dbc"):
        read_any(path)
