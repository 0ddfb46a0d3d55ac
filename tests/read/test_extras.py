"""What a DBC says beside messages is in every DBC that is made of it, as cantools reads both."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import cantools.database
import pytest
from cantools.database.can import Database

from dbcspec.artifacts import foreign_artifacts
from dbcspec.emit.dbc import emit_dbc
from dbcspec.emit.spec import emit_spec
from dbcspec.errors import SpecError
from dbcspec.read.doors import open_side
from typedcan.databases.dbc import read_dbc

FILE = Path(__file__).parent.parent / "fixtures" / "dbc" / "extras.dbc"
OURS = {
    *("BusType", "Baudrate", "DBName", "SpecDigest", "VFrameFormat", "SpecReference"),
    *("SpecErrata", "GenMsgCycleTime", "GenSigStartValue", "NmStationAddress"),
}
"""Attributes that a DBC has because it is written here."""

DEFINED = "definitions: [{name: N, type: STRING}]\n"

Told = dict[tuple[object, ...], object]


def told(text: str) -> Told:
    """All that a DBC says beside the bits, by what it is of."""
    database = cantools.database.load_string(text, "dbc", strict=False)
    assert isinstance(database, Database)
    dbc = database.dbc
    assert dbc is not None
    relations = dbc.relation_attributes
    assert relations is not None
    facts: Told = {("version",): database.version, ("bus",): database.buses[0].comment}
    definitions = {**dbc.attribute_definitions, **dbc.relation_attribute_definitions}
    for name, each in definitions.items():
        kind = (each.kind, each.type_name, each.minimum, each.maximum, tuple(each.choices or ()))
        facts["definition", name] = (kind, each.default_value)
    for name, variable in dbc.environment_variables.items():
        facts["variable", name] = (
            *(variable.env_type, variable.minimum, variable.maximum, variable.unit),
            *(variable.initial_value, variable.env_id, variable.access_type, variable.comment),
            *(tuple(variable.access_nodes), variable.data_size),
        )
        facts.update(values(("of variable", name), variable.dbc.attributes))
    facts.update(values(("of database",), dbc.attributes))
    facts.update(nested(("node signal",), relations.node_signal_relations))
    facts.update(nested(("node message",), relations.node_message_relations))
    for node in database.nodes:
        facts["node", node.name] = node.comment
        facts.update(values(("of node", node.name), node.dbc.attributes if node.dbc else {}))
    for message in database.messages:
        name = message.name
        facts["message", name] = (message.comment, tuple(message.senders))
        facts.update(values(("of message", name), message.dbc.attributes if message.dbc else {}))
        for group in message.signal_groups or ():
            facts["group", name, group.name] = (group.repetitions, tuple(group.signal_names))
        for signal in message.signals:
            facts["signal", name, signal.name] = (signal.comment, signal.spn)
            attributes = signal.dbc.attributes if signal.dbc else {}
            facts.update(values(("of signal", name, signal.name), attributes))
    return {key: fact for key, fact in facts.items() if key[-1] not in OURS}


def values(owner: tuple[object, ...], attributes: Mapping[str, Any]) -> Told:
    return {(*owner, name): each.value for name, each in attributes.items()}


def nested(owner: tuple[object, ...], found: Mapping[Any, Any]) -> Iterator[tuple[Any, object]]:
    for key, inner in found.items():
        if isinstance(inner, Mapping):
            yield from nested((*owner, key), inner)
        else:
            yield (*owner, key), inner.value


@pytest.fixture(scope="module")
def original() -> Told:
    """What the file says."""
    return told(FILE.read_text("utf-8"))


def test_the_file_has_something_of_every_kind(original: Told) -> None:
    kinds = {key[0] for key in original}
    assert kinds == {
        *("version", "bus", "definition", "variable", "of variable", "of database"),
        *("node signal", "node message", "node", "of node", "message", "of message", "group"),
        *("signal", "of signal"),
    }
    assert original["signal", "Status", "Speed"] == ("Of the vehicle", 84)


def test_a_normalised_dbc_says_all_that_the_file_says(original: Told) -> None:
    files = foreign_artifacts(read_dbc(FILE), "extras")
    assert told(files["extras.dbc"].decode("utf-8")) == original


def test_a_dbc_of_an_imported_spec_says_all_that_the_file_says(
    original: Told, tmp_path: Path
) -> None:
    for name, data in emit_spec(read_dbc(FILE)).items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(data)
    assert told(emit_dbc(open_side(str(tmp_path)).protocol)) == original


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("attributes: [{name: SPN, value: 1}]", "SPN has no definition: add it to definitions"),
        ("groups: [{name: G, message: Status, signals: [No]}]", "G: there is no Status.No"),
        (
            f"{DEFINED}attributes: [{{name: N, node: Nobody, value: x}}]",
            "N: there is no Nobody",
        ),
        (
            f"{DEFINED}attributes: [{{name: N, node: ECU, message: Gone, value: x}}]",
            "N: there is no Gone",
        ),
    ],
)
def test_a_value_of_what_is_not_there_is_refused_with_its_place(
    line: str, reason: str, tmp_path: Path
) -> None:
    for name, data in emit_spec(read_dbc(FILE)).items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(data)
    (tmp_path / "database.yaml").write_text(f"{line}\n", "utf-8")
    with pytest.raises(SpecError) as caught:
        open_side(str(tmp_path))
    assert [each.text for each in caught.value.faults] == [reason]
    assert caught.value.faults[0].where.line == line.count("\n") + 1
