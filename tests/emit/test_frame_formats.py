"""Frame formats and senders through each form in which a protocol is written and read again."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import canmatrix.formats
import pytest

from dbcspec.compare.run import compare
from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.spec import emit_spec
from dbcspec.matrix.write import emit_matrix
from dbcspec.read.doors import open_side
from typedcan.databases.dbc import read_dbc
from typedcan.model.protocol import Message, Protocol

FIXTURES = Path(__file__).parents[1] / "fixtures"
FORMATS = read_dbc(FIXTURES / "databases" / "formats.dbc")
GROUPS = read_dbc(FIXTURES / "databases" / "groups.dbc")


def _as_dbc(protocol: Protocol, folder: Path) -> Path:
    (folder / "made.dbc").write_text(emit_dbc(protocol), newline="")
    return folder / "made.dbc"


def _as_matrix(protocol: Protocol, folder: Path) -> Path:
    (folder / "made.xlsx").write_bytes(emit_matrix(protocol))
    return folder / "made.xlsx"


def _as_spec(protocol: Protocol, folder: Path) -> Path:
    for name, data in emit_spec(protocol).items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
    return folder


def _facts(message: Message) -> tuple[object, ...]:
    by_pgn = message.extended, message.by_pgn
    return (message.name, message.length, message.frame_kind, message.senders, by_pgn)


@pytest.mark.parametrize("written", [_as_dbc, _as_matrix, _as_spec])
@pytest.mark.parametrize("protocol", [FORMATS, GROUPS], ids=["formats", "groups"])
def test_what_is_written_says_format_length_and_senders_of_each_message(
    written: Callable[[Protocol, Path], Path], protocol: Protocol, tmp_path: Path
) -> None:
    again = open_side(str(written(protocol, tmp_path))).protocol
    assert list(map(_facts, again.messages)) == list(map(_facts, protocol.messages))
    rules = {item.rule for item in compare(protocol, again)}
    kept = {"message-frame-format-same", "frame-format-same", "message-sender-same"}
    assert not rules & {*kept, "message-length-same"}


def test_a_spec_says_of_each_message_how_it_is_found(tmp_path: Path) -> None:
    written = _as_spec(GROUPS, tmp_path)
    assert "frame_format: J1939PG" in (written / "standard.yaml").read_text("utf-8")
    messages = (written / "messages.yaml").read_text("utf-8")
    assert messages.count("by_pgn: no") == 1  # Whole; that of 11 bits is never found so
    assert "by_pgn: yes" not in messages


def test_another_reader_finds_the_same_formats_in_the_dbc(tmp_path: Path) -> None:
    loaded = canmatrix.formats.loadp(str(_as_dbc(FORMATS, tmp_path)))
    assert loaded
    (theirs,) = loaded.values()
    found = {frame.name: frame.is_fd for frame in theirs.frames}
    assert found == {message.name: message.is_fd for message in FORMATS.messages}
    loaded = canmatrix.formats.loadp(str(_as_dbc(GROUPS, tmp_path)))
    assert loaded
    (groups,) = loaded.values()
    by_pgn = {frame.name: bool(frame.is_j1939) for frame in groups.frames}
    assert by_pgn == {message.name: message.by_pgn for message in GROUPS.messages}
    assert theirs.frame_by_name("Between").transmitters == ["GATE", "ECU"]


def test_a_database_that_only_differs_in_its_frame_formats_breaks_the_wire() -> None:
    mixed, not_mixed = (
        read_dbc(FIXTURES / "cases" / f"{each}.dbc") for each in ("mixed", "mixednot")
    )
    (item,) = compare(not_mixed, dataclasses.replace(mixed, name=not_mixed.name))
    assert (item.level, item.rule) == ("wire", "message-frame-format-same")
    assert item.subject == "FDMSG"


def test_a_second_sender_that_is_gone_breaks_the_wire(tmp_path: Path) -> None:
    source = FIXTURES / "cases" / "starts.dbc"
    path = tmp_path / "starts.dbc"
    path.write_text(source.read_text().replace("BO_TX_BU_ 256 : AA,CC;", ""))
    (item,) = compare(read_dbc(source), read_dbc(path))
    assert (item.level, item.rule, item.old, item.new) == (
        "wire",
        "message-sender-same",
        "AA, CC",
        "AA",
    )
