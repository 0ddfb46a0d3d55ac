"""Which messages of a DBC file are found by their PGN: what the file says of each, or of itself."""

from __future__ import annotations

from pathlib import Path

import pytest

from typedcan.databases.dbc import read_dbc

TYPE = 'BA_DEF_  "ProtocolType" STRING ;\n'
DEFAULT = 'BA_DEF_DEF_  "ProtocolType" "";\n'
OF_J1939 = 'BA_ "ProtocolType" "J1939";\n'
FORMAT = 'BA_DEF_ BO_  "VFrameFormat" ENUM  "StandardCAN","ExtendedCAN","reserved","J1939PG";\n'
GROUPS = f'{FORMAT}BA_DEF_DEF_  "VFrameFormat" "J1939PG";\n'
WHOLE = f'{FORMAT}BA_DEF_DEF_  "VFrameFormat" "ExtendedCAN";\n'


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ("", set()),
        (f"{TYPE}{DEFAULT}", set()),
        (f"{TYPE}{DEFAULT}{OF_J1939}", {"WIDE", "OTHER"}),
        (f'{TYPE}BA_DEF_DEF_  "ProtocolType" "J1939";\n', {"WIDE", "OTHER"}),
        (GROUPS, {"WIDE", "OTHER"}),
        (f'{GROUPS}BA_ "VFrameFormat" BO_ 2566844926 1;\n', {"OTHER"}),
        (f'{WHOLE}BA_ "VFrameFormat" BO_ 2566844926 3;\n', {"WIDE"}),
        (f"{TYPE}{DEFAULT}{WHOLE}{OF_J1939}", set()),
    ],
)
def test_what_is_found_by_its_pgn_is_what_the_file_says_to_be_of_j1939(
    attributes: str, expected: set[str], tmp_path: Path
) -> None:
    """Each message by its frame format; without formats all with 29 bits where the file says so."""
    path = tmp_path / "groups.dbc"
    messages = "BO_ 256 SHORT: 8 A\n\nBO_ 2566844926 WIDE: 8 A\n\nBO_ 2566844670 OTHER: 8 A\n\n"
    path.write_text(f'VERSION ""\n\nBS_:\n\nBU_: A\n\n{messages}{attributes}')
    assert {each.name for each in read_dbc(path).messages if each.by_pgn} == expected
