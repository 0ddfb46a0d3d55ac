"""What says the same in another form is the same: other writers, other languages, the spec."""

from __future__ import annotations

import re
from pathlib import Path

import canmatrix.formats
import cantools
import pytest
from cantools.database.can import Database

from dbcspec.compare.run import compare
from typedcan.databases.dbc import read_dbc
from typedcan.model.protocol import Bus, Protocol

FILES = ("caamtb-swap.dbc", "caamtb-swap.zh.dbc", "caamtb-swap.zh-utf8.dbc")
ENCODINGS = {"caamtb-swap.zh.dbc": "gbk"}
over_all_files = pytest.mark.parametrize("name", FILES)


def encoding(name: str) -> str:
    return ENCODINGS.get(name, "utf-8")


@over_all_files
def test_a_dbc_of_the_spec_is_no_different_from_the_spec(
    name: str, root: Path, protocol: Protocol
) -> None:
    dbc = read_dbc(root / "dbc" / name)
    assert compare(protocol, dbc) == []
    assert compare(dbc, protocol) == []


def test_the_same_dbc_in_chinese_and_in_english_is_no_different(root: Path) -> None:
    files = [read_dbc(root / "dbc" / name) for name in FILES]
    for one in files:
        for other in files:
            assert compare(one, other) == []


def test_a_dbc_of_one_bus_lacks_just_what_is_not_on_that_bus(
    root: Path, protocol: Protocol
) -> None:
    everything = read_dbc(root / "dbc" / "caamtb-swap.dbc")
    assert protocol.buses
    for bus in protocol.buses:
        part = read_dbc(root / "dbc" / f"caamtb-swap-{bus.name}.dbc")
        absent = {message.name for message in protocol.messages if not is_on(bus, message.sender)}
        absent |= {
            message.name
            for message in protocol.messages
            if not any(is_on(bus, node) for node in message.receivers)
        }
        elsewhere = {node.name for node in protocol.nodes if not is_on(bus, node.name)}
        items = compare(everything, part)
        assert {item.subject for item in items if item.rule == "message-present"} == absent
        assert {item.subject for item in items if item.rule == "node-present"} == elsewhere
        others = {item.rule for item in items} - {"message-present", "node-present"}
        assert others <= {"signal-receivers-same"}


def is_on(bus: Bus, node: str) -> bool:
    return node in bus.nodes


@over_all_files
def test_a_file_that_cantools_writes_again_is_no_different(
    name: str, root: Path, tmp_path: Path
) -> None:
    # cantools knows an attribute by its name alone, so that of the two kinds of SpecReference
    # and SpecErrata it spoils one: they are left out on both sides.
    text = (root / "dbc" / name).read_bytes().decode(encoding(name))
    lines = text.splitlines(keepends=True)
    plain = "".join(each for each in lines if not re.search(r'"Spec(Reference|Errata)"', each))
    before, after = tmp_path / "before.dbc", tmp_path / "after.dbc"
    before.write_bytes(plain.encode("utf-8"))
    database = cantools.database.load_string(plain, "dbc", sort_signals=None)
    assert isinstance(database, Database)
    after.write_bytes(database.as_dbc_string(sort_signals=None).encode("utf-8"))
    assert compare(read_dbc(before), read_dbc(after)) == []


@over_all_files
def test_a_file_that_canmatrix_writes_again_loses_the_comment_of_the_file_and_has_its_version(
    name: str, root: Path, tmp_path: Path
) -> None:
    path, after = root / "dbc" / name, tmp_path / "after.dbc"
    matrix = canmatrix.formats.loadp_flat(
        str(path),
        dbcImportEncoding=encoding(name),
        dbcImportCommentEncoding=encoding(name),
    )
    canmatrix.formats.dumpp(
        {"": matrix}, str(after), dbcExportEncoding="utf-8", dbcExportCommentEncoding="utf-8"
    )
    items = compare(read_dbc(path), read_dbc(after))
    assert [(item.rule, item.subject) for item in items] == [
        ("comment-same", "protocol"),
        ("attribute-definition-same", "version"),
    ]
