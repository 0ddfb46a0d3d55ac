"""Whatever is broken in the project's spec, reading or linting names the file and the line."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from dbcspec.config import Config
from dbcspec.errors import SpecError
from dbcspec.project import Project, load

ANNEX = "messages.yaml"
COMMANDS = "tables/14-vcu-command.yaml"
ERRATA = "errata.yaml"
FAULTS = "tables/12-pack-faults.yaml"
RELAYS = "tables/02-relays-and-faults.yaml"
STANDARD = "standard.yaml"


@dataclass(frozen=True, slots=True)
class Line:
    """The line of a file that has ``text``: its first place after the text ``after``."""

    file: str
    text: str
    after: str = ""

    def of(self, spec: Path) -> str:
        """Path and line, as locations show them."""
        content = (spec / self.file).read_text("utf-8", "surrogateescape")
        before = content[: content.index(self.text, content.index(self.after))]
        return f"spec/{self.file}:{before.count(chr(10)) + 1}:"


@dataclass(frozen=True, slots=True)
class Breakage:
    """One edit of a file, the words of the complaint, and the lines that it must name.

    The complaint stands at the first of the lines and mentions the others.
    """

    file: str
    edit: Callable[[str], str]
    complaint: str
    lines: tuple[Line, ...]


def swap(old: str, new: str, after: str = "") -> Callable[[str], str]:
    """Replace the first ``old`` after the text ``after``."""

    def edit(text: str) -> str:
        start = text.index(old, text.index(after))
        return text[:start] + new + text[start + len(old) :]

    return edit


def without_row(name: str) -> Callable[[str], str]:
    """Delete the row of a signal from a table."""
    row = re.compile(rf"  - no: \d+\n    name: {name}\n(?:    .*\n)+")
    return lambda text: row.sub("", text, count=1)


BOMB = "a: &a [x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 9)}]\n"
    for before, name in zip("abcdefghi", "bcdefghij", strict=True)
)

BREAKAGES = {
    "a table row is deleted": Breakage(
        COMMANDS,
        without_row("V2B_CMD_AttConFlt2"),
        "signal-in-table: no table explains V2B_CMD_AttConFlt2 of V2B_CMD",
        (Line(ANNEX, "name: V2B_CMD_AttConFlt2,"),),
    ),
    "an annex row is deleted": Breakage(
        ANNEX,
        swap("      - {name: V2B_CMD_AttConFlt2, length: 2, start: 44}\n", ""),
        "signal-in-message: no message has V2B_CMD_AttConFlt2",
        (Line(COMMANDS, "name: V2B_CMD_AttConFlt2"),),
    ),
    "a length in a table is changed": Breakage(
        COMMANDS,
        swap("length: 2", "length: 3", "name: V2B_CMD_AttConFlt2"),
        "table-annex-agree: V2B_CMD_AttConFlt2 has 3 bits here, but 2 in the annex",
        (Line(COMMANDS, "length: 3"), Line(ANNEX, "name: V2B_CMD_AttConFlt2,")),
    ),
    "a length in the annex is changed": Breakage(
        ANNEX,
        swap("length: 2", "length: 3", "name: V2B_CMD_AttConFlt2,"),
        "table-annex-agree: V2B_CMD_AttConFlt2 has 2 bits here, but 3 in the annex",
        (
            Line(COMMANDS, "length: 2", "name: V2B_CMD_AttConFlt2"),
            Line(ANNEX, "name: V2B_CMD_AttConFlt2,"),
        ),
    ),
    "a start bit is moved": Breakage(
        ANNEX,
        swap("start: 44", "start: 43", "name: V2B_CMD_AttConFlt2,"),
        "signals-overlap: V2B_CMD_AttConFlt2 overlaps V2B_CMD_AttConST2 at bit 43",
        (Line(ANNEX, "name: V2B_CMD_AttConFlt2,"),),
    ),
    "a start bit is moved out of the message": Breakage(
        ANNEX,
        swap("start: 44", "start: 440", "name: V2B_CMD_AttConFlt2,"),
        "signal-inside-message: V2B_CMD_AttConFlt2 takes bit 440",
        (Line(ANNEX, "name: V2B_CMD_AttConFlt2,"),),
    ),
    "a label of a shared value table is misspelt in one row": Breakage(
        RELAYS,
        swap("Closed", "Colsed", "name: B2V_ST0_ST_MainNeg"),
        "value-table-named: the codes of B2V_ST0_ST_MainNeg are not quite RelayState",
        (Line(RELAYS, "Colsed"), Line(RELAYS, "codes:", "name: B2V_ST0_ST_MainPos")),
    ),
    "a label is misspelt in the row that names the value table": Breakage(
        RELAYS,
        swap("Closed", "Colsed", "name: B2V_ST0_ST_MainPos"),
        "code 2 is 'Closed', not 'Colsed'",
        (Line(COMMANDS, "codes:", "name: V2B_CMD_MainPosRelayST"), Line(RELAYS, "Colsed")),
    ),
    "a label is misspelt in the second of two rows": Breakage(
        FAULTS,
        swap("Normal", "Nomral", "name: B2V_ST0_Flt_HeatRelay1Weld"),
        "tables-agree: B2V_ST0_Flt_HeatRelay1Weld: code 0 is 'Nomral', but 'Normal'",
        (Line(FAULTS, "Nomral"), Line(RELAYS, "codes:", "name: B2V_ST0_Flt_HeatRelay1Weld")),
    ),
    "a key is unknown": Breakage(
        COMMANDS,
        swap("length", "lenght", "name: V2B_CMD_AttConFlt2"),
        "unknown key 'lenght'; did you mean 'length'?",
        (Line(COMMANDS, "lenght"),),
    ),
    "a tab indents": Breakage(
        COMMANDS,
        swap("    length", "\tlength", "name: V2B_CMD_AttConFlt2"),
        "tab character",
        (Line(COMMANDS, "\t"),),
    ),
    "a file is empty": Breakage(
        COMMANDS, lambda text: "", "the file is empty", (Line(COMMANDS, ""),)
    ),
    "a byte is not UTF-8": Breakage(
        COMMANDS,
        swap("Signal", "Sign\udcff", "name: V2B_CMD_AttConFlt2"),
        "not UTF-8: byte 0xFF",
        (Line(COMMANDS, "\udcff"),),
    ),
    "anchors make a bomb": Breakage(
        STANDARD, lambda text: BOMB + text, "anchors and aliases", (Line(STANDARD, "&a"),)
    ),
    "a route names an unknown node": Breakage(
        COMMANDS,
        swap("VCU>BMU", "VCU>BMX", "name: V2B_CMD_AttConFlt2"),
        "node-declared: the route of V2B_CMD_AttConFlt2 names BMX",
        (Line(COMMANDS, "VCU>BMX"),),
    ),
    "an erratum has an unknown target": Breakage(
        ERRATA,
        swap("[tables/12-pack-faults/42]", "[tables/12-pack-faults/99]"),
        "erratum-target: erratum E06, tables/12-pack-faults/99: nothing named '99'",
        (Line(ERRATA, "tables/12-pack-faults/99"),),
    ),
    "an erratum changes nothing": Breakage(
        ERRATA,
        swap("unit: kWh", "unit: kwh", "id: E30"),
        "erratum-target: erratum E30, tables/04-energy-counters/1: unit is 'kwh' already",
        (Line(ERRATA, "- at:", "id: E30"),),
    ),
    "an identifier stands twice": Breakage(
        ANNEX,
        swap("id: 0x1801D0F3", "id: 0x1802F3D0"),
        "identifier-unique: B2V_RQ has the identifier 0x1802F3D0 of V2B_CMD",
        (Line(ANNEX, "id: 0x1802F3D0", "name: V2B_CMD"),),
    ),
}


def complaints(root: Path) -> list[str]:
    """What reading, or else linting, says of the spec below a folder."""
    try:
        return list(map(str, load(Config(root=root, name="broken")).findings()))
    except SpecError as error:
        return list(map(str, error.faults))


@pytest.mark.parametrize("name", BREAKAGES)
def test_what_is_broken_is_named_with_file_and_line(
    name: str, tmp_path: Path, project: Project
) -> None:
    breakage = BREAKAGES[name]
    spec = tmp_path / "spec"
    shutil.copytree(project.config.root / project.config.spec, spec)
    path = spec / breakage.file
    sound = path.read_text("utf-8")
    path.write_text(breakage.edit(sound), "utf-8", "surrogateescape")
    said = [each for each in complaints(tmp_path) if breakage.complaint in each]
    place, *mentioned = [line.of(spec) for line in breakage.lines]
    assert [each for each in said if each.startswith(place)], said
    assert all(any(other in each for each in said) for other in mentioned), said
