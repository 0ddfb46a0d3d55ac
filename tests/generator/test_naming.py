"""Names for DBC files and for Python."""

from __future__ import annotations

import keyword

import pytest
from hypothesis import given
from hypothesis import strategies as st

from typedcan.model.naming import field_name, member_names, name_fault, shared_prefix, snake_case

IDENTIFIERS = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,40}", fullmatch=True)


@pytest.mark.parametrize(
    ("name", "snake"),
    [
        ("MaxLmt_DisChgCurr", "max_lmt_dis_chg_curr"),
        ("SOC", "soc"),
        ("GBT32960FltNum", "gbt32960_flt_num"),
        ("B1_8_15", "b1_8_15"),
        ("VehicleSpeed", "vehicle_speed"),
        ("HVILState", "hvil_state"),
        ("already_snake", "already_snake"),
        ("__Odd__Name_", "odd_name"),
        ("Class", "class_"),
        ("None", "none"),
        ("8bit", "_8bit"),
        ("_", "_"),
    ],
)
def test_snake_case_parts_words_and_keeps_numbers_with_them(name: str, snake: str) -> None:
    assert snake_case(name) == snake


@given(IDENTIFIERS)
def test_snake_case_makes_a_python_name_that_is_no_keyword(name: str) -> None:
    snake = snake_case(name)
    assert snake.isidentifier()
    assert snake == snake.lower()
    assert not keyword.iskeyword(snake)
    assert not snake.startswith("__")


@given(IDENTIFIERS)
def test_snake_case_of_snake_case_is_itself(name: str) -> None:
    assert snake_case(snake_case(name)) == snake_case(name)


@pytest.mark.parametrize("name", ["ab", "_a", "B2V_ST2", "A" * 32, "Int", "Mm", "Version"])
def test_an_identifier_of_2_to_32_characters_is_a_dbc_name(name: str) -> None:
    assert name_fault(name) is None


@pytest.mark.parametrize(
    ("name", "fault"),
    [
        ("", "is not an identifier (letters, digits and underscores)"),
        ("2nd", "is not an identifier (letters, digits and underscores)"),
        ("a-b", "is not an identifier (letters, digits and underscores)"),
        ("温度", "is not an identifier (letters, digits and underscores)"),
        ("Größe", "is not an identifier (letters, digits and underscores)"),
        ("ab\n", "is not an identifier (letters, digits and underscores)"),
        ("x", "has 1 characters; 2 to 32 are allowed"),
        ("A" * 33, "has 33 characters; 2 to 32 are allowed"),
        *((word, "is a word of the DBC language") for word in ("INT", "HEX", "FLOAT", "ENUM")),
        *((word, "is a word of the DBC language") for word in ("STRING", "VERSION", "BO_", "SG_")),
        *((word, "is a word of the DBC language") for word in ("CM_", "VAL_TABLE_", "SIG_GROUP_")),
    ],
)
def test_what_is_no_dbc_name_is_told_why(name: str, fault: str) -> None:
    assert name_fault(name) == fault


@pytest.mark.parametrize(
    ("names", "prefix"),
    [
        (["B2V_ST2_SOC", "B2V_ST2_SOH", "B2V_ST2_Current"], "B2V_ST2_"),
        (["TMS_WorkSts", "TMS_WaterTemp"], "TMS_"),
        (["Speed", "Spin"], ""),
        (["A_B", "A_B_C"], "A_"),
        (["only_one"], ""),
        ([], ""),
    ],
)
def test_the_shared_prefix_ends_at_an_underscore(names: list[str], prefix: str) -> None:
    assert shared_prefix(names) == prefix


@given(st.lists(IDENTIFIERS, min_size=2, max_size=5))
def test_every_name_begins_with_the_shared_prefix(names: list[str]) -> None:
    prefix = shared_prefix(names)
    assert all(name.startswith(prefix) for name in names)
    assert prefix == "" or prefix.endswith("_")


@pytest.mark.parametrize(
    ("signal", "prefixes", "field"),
    [
        ("B2V_ST2_SOC", ("B2V_ST2_", "B2V_"), "soc"),
        ("B2V_ST2_SOC", ("B2V_", "B2V_ST2_"), "soc"),
        ("TMS_WorkSts", ("BMS_",), "tms_work_sts"),
        ("TMS_", ("TMS_",), "tms"),
        ("Speed", ("",), "speed"),
    ],
)
def test_a_field_leaves_off_the_longest_prefix_it_has(
    signal: str, prefixes: tuple[str, ...], field: str
) -> None:
    assert field_name(signal, prefixes) == field


@pytest.mark.parametrize(
    ("labels", "members"),
    [
        ([(0, "HV open"), (1, "Fault(overtime)")], {0: "HV_OPEN", 1: "FAULT_OVERTIME"}),
        ([(1, "1 级"), (2, "2nd")], {1: "_1", 2: "_2ND"}),
        ([(10, "Reserved"), (11, "Reserved")], {10: "RESERVED_10", 11: "RESERVED_11"}),
        ([(0, "关机"), (1, "制冷")], {0: "CODE_0", 1: "CODE_1"}),
        ([(1, "A"), (2, "A"), (3, "A 1")], {1: "A_1_", 2: "A_2", 3: "A_1"}),
    ],
)
def test_members_are_named_after_their_labels(
    labels: list[tuple[int, str]], members: dict[int, str]
) -> None:
    assert member_names(labels) == members


@given(st.dictionaries(st.integers(0, 300), st.sampled_from(["A", "A 1", "a", "A_1_1", "级", "2"])))
def test_members_have_names_of_their_own(labels: dict[int, str]) -> None:
    names = member_names(list(labels.items()))
    assert names.keys() == labels.keys()
    assert len(set(names.values())) == len(names)
    assert all(name.isidentifier() for name in names.values())
