"""Files of tables, on file systems that tell case apart and on those that do not."""

from __future__ import annotations

from pathlib import Path

from typedcan.__main__ import main
from typedcan.logs.write.target import file_names

DBC = """VERSION ""

NS_ :

BS_:

BU_: A

BO_ 256 Speed: 1 A
 SG_ S : 0|8@1+ (1,0) [0|255] "" A

BO_ 257 SPEED: 1 A
 SG_ S : 0|8@1+ (1,0) [0|255] "" A
"""


def test_no_two_tables_have_names_that_differ_by_case_alone() -> None:
    assert file_names(["a", "B", "A", "A_2"]) == {"a": "a", "B": "B", "A": "A_2", "A_2": "A_2_2"}


def test_both_tables_are_there(tmp_path: Path) -> None:
    (tmp_path / "x.dbc").write_text(DBC)
    (tmp_path / "x.log").write_text("(1.0) can0 100#05\n(1.1) can0 101#06\n")
    arguments = ["--dbc", str(tmp_path / "x.dbc"), "convert", str(tmp_path / "x.log")]
    assert main([*arguments, "-o", str(tmp_path / "out.csv")]) == 0
    names = [path.name for path in (tmp_path / "out").iterdir()]
    assert len({name.casefold() for name in names}) == len(names) == 2
