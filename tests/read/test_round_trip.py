"""What was read from any DBC and written again, as DBC or as spec, reads as the same protocol."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import canmatrix.formats
import cantools.database
import pytest
from cantools.database.can import Database
from emit.acting_protocol import MOVING
from read.views import by_canmatrix, of_model

from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.spec import emit_spec
from dbcspec.read.doors import open_side
from typedcan.databases.dbc import read_dbc
from typedcan.model.protocol import Protocol

FILES = sorted((Path(__file__).parent.parent / "fixtures" / "dbc").glob("*.dbc"))
LONG_NAMES = {"long_names"}
"""canmatrix reads the short names."""


def written(protocol: Protocol, folder: Path) -> Path:
    path = folder / "again.dbc"
    path.write_bytes(emit_dbc(protocol).encode("utf-8"))
    return path


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_dbc_that_is_written_again_reads_as_the_same_protocol(path: Path, tmp_path: Path) -> None:
    protocol = read_dbc(path)
    again = read_dbc(written(protocol, tmp_path))
    named = dataclasses.replace(again, name=protocol.name)
    assert named == protocol
    assert again.carries >= protocol.carries


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_dbc_that_is_written_again_is_sound_to_cantools(path: Path, tmp_path: Path) -> None:
    protocol = read_dbc(path)
    file = written(protocol, tmp_path)
    database = cantools.database.load_file(
        file, encoding="utf-8", strict=path.stem != "overlapping"
    )
    assert isinstance(database, Database)
    assert [each.name for each in database.messages] == [each.name for each in protocol.messages]
    for message, own in zip(database.messages, protocol.messages, strict=True):
        assert message.is_fd == (own.length > 8)


@pytest.mark.parametrize(
    "path", [path for path in FILES if path.stem not in LONG_NAMES], ids=lambda path: path.stem
)
def test_canmatrix_reads_every_line_of_a_dbc_that_is_written_again(
    path: Path, tmp_path: Path
) -> None:
    protocol = read_dbc(path)
    file = written(protocol, tmp_path)
    options = {"dbcImportEncoding": "utf-8", "dbcImportCommentEncoding": "utf-8"}
    matrix: Any = canmatrix.formats.loadp_flat(str(file), **options)
    assert matrix.load_errors == []
    seen = by_canmatrix(file, "utf-8")
    messages, signals = of_model(protocol, open_limits=seen)
    assert messages == seen[0]
    for name, view in seen[1].items():
        assert dataclasses.replace(signals[name], limits=None) == dataclasses.replace(
            view, limits=None
        )


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_spec_made_of_a_dbc_reads_as_the_same_protocol(path: Path, tmp_path: Path) -> None:
    protocol = read_dbc(path)
    assert told_by_a_spec(spec_again(protocol, tmp_path)) == told_by_a_spec(protocol)


def test_a_spec_made_of_the_projects_own_model_reads_as_the_same(
    protocol: Protocol, tmp_path: Path
) -> None:
    assert told_by_a_spec(spec_again(protocol, tmp_path)) == told_by_a_spec(protocol)


def test_a_spec_keeps_which_codes_act_in_which_message(tmp_path: Path) -> None:
    again = spec_again(MOVING, tmp_path)
    assert told_by_a_spec(again) == told_by_a_spec(MOVING)
    acting = {(message.name, each.name): each.acting for message, each in again.signals()}
    assert acting == {(message.name, each.name): each.acting for message, each in MOVING.signals()}
    assert "initial" not in (tmp_path / "spec" / "messages.yaml").read_text("utf-8")


def spec_again(protocol: Protocol, folder: Path) -> Protocol:
    for name, data in emit_spec(protocol).items():
        path = folder / "spec" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return open_side(str(folder / "spec")).protocol


def told_by_a_spec(protocol: Protocol) -> Protocol:
    """The protocol without name, references, errata and value tables that no signal has."""
    used = {signal.value_table for _, signal in protocol.signals()}
    plain: dict[str, Any] = {"reference": "", "errata": ()}
    return dataclasses.replace(
        protocol,
        name="",
        errata=(),
        nodes=tuple(dataclasses.replace(node, errata=()) for node in protocol.nodes),
        buses=tuple(dataclasses.replace(bus, errata=()) for bus in protocol.buses),
        value_tables=tuple(table for table in protocol.value_tables if table in used),
        messages=tuple(
            dataclasses.replace(
                message,
                signals=tuple(dataclasses.replace(each, **plain) for each in message.signals),
                reserved=tuple(
                    dataclasses.replace(each, reference="") for each in message.reserved
                ),
                **plain,
            )
            for message in protocol.messages
        ),
    )


def test_texts_that_mean_something_in_yaml_survive_a_spec(tmp_path: Path) -> None:
    texts = (
        "NO",
        "a: b",
        "- x",
        "{y}",
        "# z",
        "'",
        '"',
        "\\",
        "tab\tin",
        "1.5",
        " spaced ",
        "\x85",
    )
    path = tmp_path / "texts.dbc"
    comments = (text.replace('"', '\\"') for text in texts if not text.endswith("\\"))
    path.write_text(
        "BO_ 1 Texts: 8 A\n"
        + "".join(f' SG_ S{number} : {number}|1@1+ (1,0) [0|1] "" B\n' for number in range(12))
        + "".join(f'CM_ SG_ 1 S{n} "{text}";\n' for n, text in enumerate(comments))
        + 'VAL_ 1 S0 0 "NO" 1 "OFF: x, y" ;\n',
        "utf-8",
    )
    protocol = read_dbc(path)
    assert told_by_a_spec(spec_again(protocol, tmp_path)) == told_by_a_spec(protocol)
    assert protocol.messages[0].signals[0].english == "NO"
