"""What the DBC files say about timing, language and origin, held against the standard."""

from __future__ import annotations

import platform
import re
from importlib.metadata import version
from pathlib import Path

import pytest
from emit.dbc_lines import Dbc

import dbcspec
import swapcan._generated
from dbcspec.spec.folder import read_spec
from dbcspec.spec.rows import Spec

ENGLISH = ("caamtb-swap", "caamtb-swap-vehicle", "caamtb-swap-charger")
SEND_TYPES = {
    **dict.fromkeys(("B2V_RQ", "V2B_VIN", "V2B_RQData"), "8"),
    **dict.fromkeys((f"B2V_SysCode{number}" for number in (1, 2, 3, 4)), "7"),
    **dict.fromkeys(("B2V_BattInfo1", "B2V_BattInfo2"), "7"),
}
"""GenMsgSendType of the messages that are not always sent; that of all others is 0."""


@pytest.fixture(scope="module")
def files(root: Path) -> dict[str, Dbc]:
    encodings = dict.fromkeys(ENGLISH, "ascii")
    encodings |= {"caamtb-swap.zh": "gb2312", "caamtb-swap.zh-utf8": "utf-8"}
    return {
        name: Dbc(name, (root / "dbc" / f"{name}.dbc").read_bytes(), encoding)
        for name, encoding in encodings.items()
    }


@pytest.fixture(scope="module")
def printed(root: Path) -> Spec:
    """The spec before any erratum is applied."""
    return read_spec(root / "spec", "spec")


def names(dbc: Dbc) -> dict[str, str]:
    return {parts["id"]: parts["name"] for parts in dbc.of("BO_")}


def test_cycle_times_stand_where_a_period_is_printed_and_nowhere_else(
    files: dict[str, Dbc], printed: Spec
) -> None:
    periods = {row.name: row.period for row in printed.messages.messages if row.period}
    periods["C2B_ACStatus"] = periods.pop("C2B_ACStatu")
    for dbc in files.values():
        cycle_times = dbc.values("GenMsgCycleTime")
        assert {names(dbc)[key]: int(value) for key, value in cycle_times.items()} == {
            name: period for name, period in periods.items() if name in names(dbc).values()
        }


def test_send_types_are_numbered_as_the_common_templates_do(files: dict[str, Dbc]) -> None:
    for dbc in files.values():
        definition = next(each for each in dbc.of("BA_DEF_") if each["name"] == "GenMsgSendType")
        words = definition["words"].replace('"', "").split(",")
        assert words == ["Cyclic", *["NotUsed"] * 6, "IfActive", "NoMsgSendType"]
        assert dbc.values("GenMsgSendType") == {
            key: SEND_TYPES.get(name, "0") for key, name in names(dbc).items()
        }


def test_a_message_without_a_period_is_sent_on_events(files: dict[str, Dbc]) -> None:
    for dbc in files.values():
        for key, send_type in dbc.values("GenMsgSendType").items():
            assert (send_type == "8") == (key not in dbc.values("GenMsgCycleTime"))


def test_every_file_gives_the_bit_rate_of_its_bus(files: dict[str, Dbc]) -> None:
    for dbc in files.values():
        assert dbc.values("Baudrate") == {"": "250000"}


def test_english_files_are_ascii(files: dict[str, Dbc]) -> None:
    for name in ENGLISH:
        assert files[name].data.isascii()


def test_the_gbk_file_stays_inside_gb2312_and_no_character_ends_in_a_backslash(
    files: dict[str, Dbc],
) -> None:
    data = files["caamtb-swap.zh"].data
    characters = [letter.encode("gb2312") for letter in data.decode("gb2312")]
    two_bytes = [each for each in characters if len(each) == 2]
    assert len(two_bytes) > 1000
    assert all(each[1] != 0x5C for each in two_bytes)
    assert data.decode("gbk") == data.decode("gb2312")


def test_the_two_chinese_files_are_one_text(files: dict[str, Dbc]) -> None:
    assert files["caamtb-swap.zh"].text == files["caamtb-swap.zh-utf8"].text


def test_the_chinese_files_say_in_chinese_what_the_english_one_says(
    files: dict[str, Dbc],
) -> None:
    english, chinese = files["caamtb-swap"], files["caamtb-swap.zh"]
    for one, other in zip(english.lines, chinese.lines, strict=True):
        assert re.sub(r'"[^"]*"', '""', one.text) == re.sub(r'"[^"]*"', '""', other.text)
        if one.kind not in ("CM_", "VAL_", "VAL_TABLE_"):
            assert one.text == other.text
    comments = [parts["text"] for parts in chinese.of("CM_")]
    assert all(re.search(r"[\u4e00-\u9fff]", text) or text == "CRC 校验" for text in comments)


def test_every_signal_has_a_comment(files: dict[str, Dbc]) -> None:
    for dbc in files.values():
        comments = {(parts["owner"], parts["signal"]) for parts in dbc.of("CM_") if parts["text"]}
        assert {(str(signal.message), signal.name) for signal in dbc.signals} <= comments


def test_a_file_says_from_which_model_it_was_made_and_so_do_the_stubs(
    files: dict[str, Dbc],
) -> None:
    for dbc in files.values():
        assert dbc.values("SpecDigest") == {"": swapcan._generated.DIGEST}


def test_nothing_in_a_file_depends_on_day_machine_or_tool(files: dict[str, Dbc]) -> None:
    for dbc in files.values():
        assert not re.search(r"\b(19|20)\d\d[-/.]\d{1,2}|\d\d:\d\d", dbc.text)
        words = set(re.findall(r"[\w.-]+", dbc.text))
        assert words.isdisjoint((platform.node(), dbcspec.__name__, version("swapcan")))


def test_the_packaged_file_is_the_one_for_people(root: Path, files: dict[str, Dbc]) -> None:
    packaged = root / "src" / "swapcan" / "_generated" / "caamtb-swap.dbc"
    assert packaged.read_bytes() == files["caamtb-swap"].data


def test_the_file_of_a_bus_has_the_lines_of_the_whole_for_its_messages(
    files: dict[str, Dbc],
) -> None:
    whole = {line.text for line in files["caamtb-swap"].lines}
    for name in ENGLISH[1:]:
        of_the_bus = [
            line.text for line in files[name].lines if line.kind in ("BO_", "SG_", "VAL_")
        ]
        assert of_the_bus
        assert set(of_the_bus) <= whole


def test_references_and_errata_are_cited(files: dict[str, Dbc]) -> None:
    dbc = files["caamtb-swap"]
    references, errata = dbc.values("SpecReference"), dbc.values("SpecErrata")
    volt = next(
        f"{signal.message} {signal.name}" for signal in dbc.signals if signal.name == "BMS_Volt"
    )
    assert references[volt] == "Table 19 row 5 (5.5)"
    assert errata[volt].split() == ["E21", "E36"]
    assert len(references) == 25 + 211
    assert all(re.fullmatch(r"E\d\d( E\d\d)*", numbers) for numbers in errata.values())
