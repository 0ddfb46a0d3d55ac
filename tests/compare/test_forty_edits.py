"""One edit of the real DBC file is one finding, under the one promise that it breaks.

canmatrix witnesses by its own comparison that each edit changed something; where it is blind,
cantools by what it writes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import canmatrix.compare
import canmatrix.formats
import cantools
import pytest
from cantools.database.can import Database
from compare.edits import EDITS, Edit

from dbcspec.compare.registry import PROMISES
from dbcspec.compare.run import compare
from typedcan.databases.dbc import read_dbc
from typedcan.model.protocol import Protocol

NOT_IN_A_DBC = frozenset(
    {
        "message-checksum-same",
        "message-counter-same",
        "transfer-layout-same",
        "transfer-name-same",
        "transfer-reception-same",
        "request-same",
        "bus-present",
        "bus-added",
        "bus-name-same",
        "bus-nodes-same",
        "signal-invalid-code-same",
        "signal-acts-same",
        "field-name-same",
        "erratum-same",
    }
)
NOT_IN_THIS_FILE = frozenset(
    {
        "message-extended-same",  # no identifier of it fits into 11 bits
        "message-frame-format-same",  # its attribute knows no CAN FD
        "attribute-same",  # it has none of other tools
        "attribute-definition-same",
        "signal-group-same",
        "environment-variable-same",
        "reserved-signal-present",  # it gives reserved bits no names
        "signal-float-same",  # no signal of it has 32 bits
        "frame-format-same",  # one attribute for each message, so no single edit
    }
)


@pytest.fixture(scope="module")
def text(root: Path) -> str:
    return (root / "dbc" / "caamtb-swap.dbc").read_bytes().decode("ascii")


@pytest.fixture(scope="module")
def unchanged(root: Path) -> Protocol:
    return read_dbc(root / "dbc" / "caamtb-swap.dbc")


@pytest.fixture(scope="module")
def unchanged_matrix(root: Path) -> Any:
    return matrix(root / "dbc" / "caamtb-swap.dbc")


def matrix(path: Path) -> Any:
    return canmatrix.formats.loadp_flat(str(path))


def rewritten_by_cantools(text: str) -> str:
    database = cantools.database.load_string(text, "dbc", strict=False)
    assert isinstance(database, Database)
    return database.as_dbc_string()


@pytest.fixture(scope="module")
def rewritten(text: str) -> str:
    return rewritten_by_cantools(text)


over_all_edits = pytest.mark.parametrize("edit", EDITS, ids=lambda edit: edit.what)


@over_all_edits
def test_an_edit_gives_its_one_finding(
    edit: Edit, text: str, unchanged: Protocol, tmp_path: Path
) -> None:
    path = tmp_path / "edited.dbc"
    path.write_bytes(edit.change(text).encode("ascii"))
    items = compare(unchanged, read_dbc(path))
    assert [(item.rule, item.level, item.subject) for item in items] == [
        (edit.rule, edit.level, edit.subject)
    ]


@over_all_edits
def test_other_tools_see_that_an_edit_changed_something(
    edit: Edit, text: str, rewritten: str, unchanged_matrix: Any, tmp_path: Path
) -> None:
    edited = edit.change(text)
    assert edited != text
    path = tmp_path / "edited.dbc"
    path.write_bytes(edited.encode("ascii"))
    seen_by_canmatrix = canmatrix.compare.compare_db(unchanged_matrix, matrix(path)).result
    assert (seen_by_canmatrix is None) == ("canmatrix" in edit.unseen_by)
    if seen_by_canmatrix is None:
        same = rewritten_by_cantools(edited) == rewritten
        assert same == ("cantools" in edit.unseen_by)


def test_there_are_forty_edits_and_one_for_each_promise_that_this_file_can_break() -> None:
    assert len(EDITS) > 40
    assert {edit.rule for edit in EDITS} == (
        {promise.id for promise in PROMISES} - NOT_IN_A_DBC - NOT_IN_THIS_FILE
    )
