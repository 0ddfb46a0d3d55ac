"""The DBC rules of the design, held against the bytes of the generated files."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from emit.dbc_lines import SECTIONS, Dbc, codes

ENCODINGS = {
    "caamtb-swap": "ascii",
    "caamtb-swap-vehicle": "ascii",
    "caamtb-swap-charger": "ascii",
    "caamtb-swap.zh": "gb2312",
    "caamtb-swap.zh-utf8": "utf-8",
}
DBC_WORDS = {"M", "m", "INT", "HEX", "FLOAT", "ENUM", "STRING"}


@pytest.fixture(scope="module", params=ENCODINGS)
def dbc(request: pytest.FixtureRequest, root: Path) -> Dbc:
    """Each file in turn; a line that has not the one allowed shape fails here."""
    name = str(request.param)
    return Dbc(name, (root / "dbc" / f"{name}.dbc").read_bytes(), ENCODINGS[name])


def test_lines_end_in_crlf_and_so_does_the_file(dbc: Dbc) -> None:
    assert dbc.data.count(b"\r\n") == dbc.data.count(b"\n") == dbc.data.count(b"\r")
    assert dbc.data.endswith(b"\r\n")


def test_the_file_begins_with_its_version_and_no_byte_order_mark(dbc: Dbc) -> None:
    assert dbc.data.startswith(b'VERSION ""\r\n\r\nNS_ :\r\n\tNS_DESC_\r\n')


def test_sections_stand_in_order_and_are_not_mixed(dbc: Dbc) -> None:
    kinds = ["BO_" if line.kind == "SG_" else line.kind for line in dbc.lines]
    assert [kind for kind, above in zip(kinds, ["", *kinds], strict=False) if kind != above] == [
        section for section in SECTIONS if section in kinds
    ]


def test_comments_go_from_network_to_nodes_to_messages_with_their_signals(dbc: Dbc) -> None:
    ranks = []
    for parts in dbc.of("CM_"):
        of_a_message = parts["message"] or parts["owner"]
        ranks.append(2 if of_a_message else 1 if parts["node"] else 0)
    assert ranks == sorted(ranks)
    assert ranks.count(0) == 1
    order = [
        (parts["message"] or parts["owner"], parts["signal"])
        for parts in dbc.of("CM_")
        if parts["message"] or parts["owner"]
    ]
    objects: list[tuple[str, str]] = []
    for line in dbc.lines:
        if line.kind == "BO_":
            objects.append((line.parts["id"], ""))
        elif line.kind == "SG_":
            objects.append((objects[-1][0], line.parts["name"]))
    assert order == objects


def test_there_are_no_line_comments(dbc: Dbc) -> None:
    assert not [line.text for line in dbc.lines if "//" in re.sub(r'"[^"]*"', "", line.text)]


def test_no_section_or_name_is_used_that_some_reader_stumbles_over(dbc: Dbc) -> None:
    used = "\n".join(line.text for line in dbc.lines if not line.text.startswith("\t"))
    for word in ("EV_", "BO_TX_BU_", "SIG_GROUP_", "BA_DEF_REL_", "SG_MUL_VAL_", "LongSymbol"):
        assert not re.search(rf"\b{word}", used)
    assert "VECTOR__INDEPENDENT_SIG_MSG" not in used


def test_names_are_ascii_identifiers_of_2_to_32_characters(dbc: Dbc) -> None:
    names = [*dbc.nodes, *(signal.name for signal in dbc.signals)]
    names += [parts["name"] for kind in ("VAL_TABLE_", "BO_", "BA_DEF_") for parts in dbc.of(kind)]
    for name in names:
        assert re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]{1,31}", name, re.ASCII)
        assert name not in DBC_WORDS


def test_message_names_and_identifiers_are_unique(dbc: Dbc) -> None:
    for key in ("id", "name"):
        found = [parts[key] for parts in dbc.of("BO_")]
        assert len(found) == len(set(found))
    keys = [(signal.message, signal.name) for signal in dbc.signals]
    assert len(keys) == len(set(keys))


def test_every_identifier_has_29_bits_and_says_so_in_bit_31(dbc: Dbc) -> None:
    for parts in dbc.of("BO_"):
        assert int(parts["id"]) >> 29 == 0b100


def test_senders_and_receivers_are_nodes_of_the_file(dbc: Dbc) -> None:
    assert {parts["sender"] for parts in dbc.of("BO_")} <= set(dbc.nodes)
    for signal in dbc.signals:
        assert set(signal.receivers) <= set(dbc.nodes)
        assert len(set(signal.receivers)) == len(signal.receivers)


def test_numbers_are_plain_and_factor_and_offset_have_at_most_6_digits(dbc: Dbc) -> None:
    for parts in dbc.of("SG_"):
        for key in ("factor", "offset", "minimum", "maximum"):
            assert re.fullmatch(r"-?(0|[1-9]\d*)(\.\d*[1-9])?", parts[key])
        for key in ("factor", "offset"):
            assert len(parts[key].lstrip("-0.").replace(".", "")) <= 6
        assert float(parts["factor"]) > 0


def test_ranges_are_not_empty_and_lie_inside_what_the_bits_hold(dbc: Dbc) -> None:
    for signal in dbc.signals:
        low, high = (raw * signal.factor + signal.offset for raw in signal.raw_limits)
        assert low <= signal.minimum < signal.maximum <= high


def test_texts_have_no_character_that_ends_them_early(dbc: Dbc) -> None:
    for line in dbc.lines:
        for text in re.findall(r'"([^"]*)"', line.text):
            assert not set(text) & set("\\;\r\n\t")


def test_units_and_labels_have_no_comma_and_labels_fit(dbc: Dbc) -> None:
    assert not [signal.unit for signal in dbc.signals if "," in signal.unit]
    for kind in ("VAL_", "VAL_TABLE_"):
        for parts in dbc.of(kind):
            for _, label in codes(parts["codes"]):
                assert "," not in label
                assert label.strip()
                assert len(label.encode(dbc.encoding)) <= 63


def test_units_are_ascii_in_every_language(dbc: Dbc) -> None:
    units = {signal.unit for signal in dbc.signals}
    assert all(unit.isascii() for unit in units)
    assert "degC" in units or dbc.name.endswith("charger")


def test_a_value_line_is_short_and_ends_in_a_space_and_a_semicolon(dbc: Dbc) -> None:
    lines = [line.text for line in dbc.lines if line.kind in ("VAL_", "VAL_TABLE_")]
    assert lines
    for line in lines:
        assert line.endswith('" ;')
        assert len(line.encode(dbc.encoding)) < 6000


def test_codes_ascend_and_fit_into_their_signals(dbc: Dbc) -> None:
    limits = {(str(signal.message), signal.name): signal.raw_limits[1] for signal in dbc.signals}
    for parts in dbc.of("VAL_"):
        values = [code for code, _ in codes(parts["codes"])]
        assert values == sorted(set(values))
        assert values[-1] <= limits[parts["id"], parts["name"]]


def test_every_value_table_is_used_and_every_value_line_has_its_table(dbc: Dbc) -> None:
    tables = {parts["codes"] for parts in dbc.of("VAL_TABLE_")}
    assert tables == {parts["codes"] for parts in dbc.of("VAL_")}


def test_every_attribute_has_one_default_of_its_kind(dbc: Dbc) -> None:
    kinds = {parts["name"]: parts["type"] for parts in dbc.of("BA_DEF_")}
    defaults = {parts["name"]: parts["value"] for parts in dbc.of("BA_DEF_DEF_")}
    assert kinds.keys() == defaults.keys()
    assert len(dbc.of("BA_DEF_DEF_")) == len(defaults)
    for name, kind in kinds.items():
        if kind.startswith("ENUM"):
            assert defaults[name] in kind.removeprefix("ENUM ").split(",")
        else:
            assert defaults[name].startswith('"') == (kind == "STRING")


def test_attribute_values_fit_their_definitions_and_enums_are_given_by_index(dbc: Dbc) -> None:
    defined = {(parts["on"], parts["name"]): parts for parts in dbc.of("BA_DEF_")}
    for parts in dbc.of("BA_"):
        on = "BU_ " if parts["node"] else "BO_ " if parts["message"] else ""
        definition = defined["SG_ " if parts["signal"] else on, parts["name"]]
        kind, *numbers = definition["type"].split(" ", 1)[0], *definition["type"].split(" ")[1:]
        if kind == "STRING":
            assert parts["value"].startswith('"')
        elif kind == "INT":
            assert int(numbers[0]) <= int(parts["value"]) <= int(numbers[1])
        else:
            assert 0 <= int(parts["value"]) < len(definition["words"].split(","))


def test_values_are_given_only_to_objects_of_the_file(dbc: Dbc) -> None:
    messages = {parts["id"] for parts in dbc.of("BO_")}
    signals = {(str(signal.message), signal.name) for signal in dbc.signals}
    for parts in [*dbc.of("BA_"), *dbc.of("CM_")]:
        assert not parts["node"] or parts["node"] in dbc.nodes
        assert not parts["message"] or parts["message"] in messages
        assert not parts["signal"] or (parts["owner"], parts["signal"]) in signals


def test_every_node_has_its_address_and_every_message_its_frame_format(dbc: Dbc) -> None:
    definition = next(each for each in dbc.of("BA_DEF_") if each["name"] == "VFrameFormat")
    assert definition["words"] == '"StandardCAN","ExtendedCAN","reserved","J1939PG"'
    identifiers = [parts["id"] for parts in dbc.of("BO_")]
    assert dbc.values("VFrameFormat") == dict.fromkeys(identifiers, "1")
    assert list(dbc.values("NmStationAddress")) == dbc.nodes


def test_every_signal_has_a_start_value_that_is_raw_and_whole(dbc: Dbc) -> None:
    limits = {f"{signal.message} {signal.name}": signal.raw_limits for signal in dbc.signals}
    assert dbc.values("GenSigStartValue").keys() == limits.keys()
    for key, value in dbc.values("GenSigStartValue").items():
        low, high = limits[key]
        assert low <= int(value) <= high
