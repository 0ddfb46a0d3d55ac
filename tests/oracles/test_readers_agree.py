"""cantools and canmatrix must read the same from every DBC file, and that must be the model."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from oracles.readers import Facts, by_canmatrix, by_cantools, of_model

from typedcan.model.protocol import Protocol

ENCODINGS = {
    "caamtb-swap": "ascii",
    "caamtb-swap-vehicle": "ascii",
    "caamtb-swap-charger": "ascii",
    "caamtb-swap.zh": "gbk",
    "caamtb-swap.zh-utf8": "utf-8",
}
ON_CHARGER_BUS = {"B2C_Charger", "C2B_ACStatus"}
ANNEX_A = {
    "V2B_CMD": 0x1802F3D0,
    "B2V_RQ": 0x1801D0F3,
    "V2B_VIN": 0x18E1F3D0,
    "V2B_RQData": 0x1801F3EF,
    "B2V_SysCode1": 0x18E1D0F3,
    "B2V_SysCode2": 0x18E2D0F3,
    "B2V_SysCode3": 0x18E3D0F3,
    "B2V_SysCode4": 0x18E4D0F3,
    "B2V_BattInfo1": 0x18E5D0F3,
    "B2V_BattInfo2": 0x18E6D0F3,
    "B2V_Ucell": 0x18C1D0F3,
    "B2V_Temp": 0x18C2D0F3,
    "B2V_ST0": 0x1880D0F3,
    "B2V_ST1": 0x1881D0F3,
    "B2V_ST2": 0x1882D0F3,
    "B2V_ST3": 0x1883D0F3,
    "B2V_ST4": 0x1884D0F3,
    "B2V_ST5": 0x1885D0F3,
    "B2V_ST6": 0x1886D0F3,
    "B2V_ElecEnergy": 0x18F1D0F3,
    "B2C_Charger": 0x180156F3,
    "C2B_ACStatus": 0x1801F356,
    "BMS_TMS_0": 0x18FF45F4,
    "TMS_BMS_0": 0x18FFC13A,
    "BSU_BMS_0": 0x18FFF8A7,
}
"""The identifiers as printed, copied by hand."""
every_file = pytest.mark.parametrize("name", ENCODINGS)


@cache
def cantools_facts(path: Path, encoding: str) -> Facts:
    return by_cantools(path, encoding)


@cache
def canmatrix_facts(path: Path, encoding: str) -> Facts:
    return by_canmatrix(path, encoding)


def both(root: Path, name: str) -> tuple[Facts, Facts]:
    path, encoding = root / "dbc" / f"{name}.dbc", ENCODINGS[name]
    return cantools_facts(path, encoding), canmatrix_facts(path, encoding)


def model_facts(protocol: Protocol, name: str) -> Facts:
    buses = {f"caamtb-swap-{bus.name}": bus for bus in protocol.buses}
    return of_model(protocol, buses.get(name), english=".zh" not in name)


def test_these_are_all_the_files(root: Path) -> None:
    names = {path.name.removesuffix(".dbc") for path in (root / "dbc").glob("*.dbc")}
    assert names == set(ENCODINGS)


@every_file
def test_nodes_are_read_as_the_model_has_them(name: str, root: Path, protocol: Protocol) -> None:
    for facts in both(root, name):
        assert facts.nodes == model_facts(protocol, name).nodes


@every_file
def test_messages_are_read_as_the_model_has_them(name: str, root: Path, protocol: Protocol) -> None:
    for facts in both(root, name):
        assert facts.messages == model_facts(protocol, name).messages


@every_file
def test_signals_are_read_as_the_model_has_them(name: str, root: Path, protocol: Protocol) -> None:
    for facts in both(root, name):
        assert facts.signals == model_facts(protocol, name).signals


@every_file
def test_comments_of_messages_are_read_alike(name: str, root: Path) -> None:
    by_one, by_other = both(root, name)
    assert by_one.comments == by_other.comments
    assert all(by_one.comments.values())


def test_an_english_comment_says_what_a_message_carries_when_and_how_often(
    root: Path, protocol: Protocol
) -> None:
    comments = both(root, "caamtb-swap")[0].comments
    for message in protocol.messages:
        assert comments[message.name].startswith(message.english)
        assert message.condition in comments[message.name]
        assert (f"every {message.period} ms" in comments[message.name]) == bool(message.period)


def test_a_chinese_comment_is_the_caption_of_the_table(root: Path, protocol: Protocol) -> None:
    for name in ("caamtb-swap.zh", "caamtb-swap.zh-utf8"):
        comments = both(root, name)[0].comments
        assert comments == {message.name: message.title for message in protocol.messages}


def test_a_message_is_in_the_files_of_the_buses_that_carry_it(root: Path) -> None:
    everything, vehicle, charger = (
        set(both(root, name)[0].messages)
        for name in ("caamtb-swap", "caamtb-swap-vehicle", "caamtb-swap-charger")
    )
    assert len(everything) == 25
    assert charger == ON_CHARGER_BUS
    assert vehicle == everything - ON_CHARGER_BUS


def test_the_file_of_a_bus_names_the_nodes_of_that_bus(root: Path) -> None:
    assert set(both(root, "caamtb-swap-vehicle")[0].nodes) == {"BMU", "VCU", "TMS", "BSU"}
    assert set(both(root, "caamtb-swap-charger")[0].nodes) == {"BMU", "CHG"}


def test_the_chinese_files_differ_from_the_english_one_in_texts_only(root: Path) -> None:
    english = both(root, "caamtb-swap")[0]
    for name in ("caamtb-swap.zh", "caamtb-swap.zh-utf8"):
        chinese = both(root, name)[0]
        assert chinese.messages == english.messages
        for key, signal in english.signals.items():
            other = chinese.signals[key]
            assert (other.start, other.length, other.intel) == (
                signal.start,
                signal.length,
                signal.intel,
            )
            assert [code for code, _ in other.codes] == [code for code, _ in signal.codes]


def test_a_start_bit_of_a_motorola_signal_is_its_most_significant_bit(root: Path) -> None:
    for facts in both(root, "caamtb-swap"):
        volt = facts.signals["BMS_TMS_0", "BMS_Volt"]
        assert (volt.start, volt.length, volt.intel) == (15, 16, False)


def test_identifiers_are_those_of_annex_a(root: Path) -> None:
    for facts in both(root, "caamtb-swap"):
        assert {name: each.frame_id for name, each in facts.messages.items()} == ANNEX_A
        assert all(each.extended for each in facts.messages.values())
