"""`dbcspec lint` on files of others: what is wrong is found, and what only looks odd is not."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from dbcspec.cli import run
from dbcspec.lint.units import is_known
from typedcan.databases.dbc import read_dbc
from typedcan.model.errors import ReadError

FILES = Path(__file__).with_name("files")
ROOT = Path(__file__).parents[2]

HEAD = 'VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: AA BB\n\nBO_ 256 MSG: 8 AA\n'


def linted(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str]:
    """The exit status of lint and all that it prints."""
    status = run(["lint", *words])
    captured = capsys.readouterr()
    return status, captured.out + captured.err


def written(folder: Path, lines: str) -> str:
    """The name of a file with these lines after those of a message."""
    path = folder / "case.dbc"
    path.write_text(HEAD + lines, "utf-8")
    return str(path)


@pytest.mark.parametrize("name", ["signedval", "pow2", "cat", "esc"])
def test_a_file_with_nothing_wrong_has_no_finding(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status, printed = linted(capsys, str(FILES / f"{name}.dbc"))
    assert (status, printed.splitlines()[-1]) == (0, "no findings")


@pytest.mark.parametrize(
    ("name", "rule"), [("pow2", "scale-digits"), ("cat", "name-is-identifier")]
)
def test_what_is_exact_and_what_is_no_word_of_dbc_is_sound_by_the_rules_of_the_house_too(
    name: str, rule: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = str(FILES / f"{name}.dbc")
    status, printed = linted(capsys, path, "--profile", "house", "--select", rule)
    assert (status, printed.splitlines()[-1]) == (0, "no findings")


def test_seven_digits_that_are_no_power_of_two_are_a_finding_of_the_house(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, ' SG_ Pxx : 0|8@1+ (0.0009765626,0) [0|0.2] "" BB\n')
    status, printed = linted(capsys, path, "--profile", "house", "--select", "scale-digits")
    assert status == 1
    assert "0.0009765626" in printed


def test_an_identifier_without_its_mark_is_a_finding_in_its_line_and_the_rest_is_linted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "extraflag.dbc"
    codes = 'VAL_ 274877907 Pos 1 "x" 256 "y" ;\n'
    path.write_text((FILES / "extraflag.dbc").read_text("utf-8") + codes, "utf-8")
    status, printed = linted(capsys, str(path))
    assert status == 1
    assert f"{path}:9:1  identifier-unique" in printed
    assert "add 2147483648" in printed
    assert f"{path}:10:1  code-in-raw-range" in printed
    with pytest.raises(ReadError, match=r"extraflag\.dbc:9:1: BIGID: 274877907 is no identifier"):
        read_dbc(path)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("len1e8", ":10:1: a: no message has so many bits"),
        ("period", ":7:1: M: no cycle time is so long"),
    ],
)
def test_numbers_that_nothing_can_have_are_refused_in_one_line(
    name: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = FILES / f"{name}.dbc"
    assert linted(capsys, str(path)) == (2, f"dbcspec: {path}{said}\n")


def test_control_characters_of_a_file_reach_no_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    status, printed = linted(capsys, str(FILES / "esc.dbc"), "--profile", "house")
    assert status == 1
    assert "\\x1b]0;PWN" in printed
    assert not {*printed} & {"\x1b", "\x07"}


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ('SG_ Sxx : 0|64@1+ (1,0) [0|1.84467440737096E+19] "" BB', False),
        ('SG_ Sxx : 0|64@1+ (1,0) [0|1.845E+19] "" BB', True),
        ('SG_ Sxx : 0|32@1- (1E-007,0) [-214.748|214.748] "" BB', False),
        ('SG_ Sxx : 0|8@1+ (1,0) [0|256] "" BB', True),
        ('SG_ Sxx : 0|8@1+ (1,0) [0|255] "" BB', False),
        ('SG_ Sxx : 0|8@1+ (1,0) [7|7] "" BB', True),
    ],
)
def test_a_range_may_be_rounded_as_tools_print_it_and_no_more(
    line: str, *, found: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, printed = linted(capsys, written(tmp_path, f" {line}\n"))
    assert ("range-fits-bits" in printed) is found
    assert status == found


@pytest.mark.parametrize(("code", "found"), [(-4096, False), (-4097, True), (4096, True)])
def test_codes_of_a_signed_signal_are_those_that_its_bits_hold(
    code: int, *, found: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    signal = ' SG_ Torque : 0|13@1- (0.25,0) [-1024|1023.75] "Nm" BB\n'
    path = written(tmp_path, f'{signal}\nVAL_ 256 Torque {code} "SNA" ;\n')
    assert linted(capsys, path)[0] == found


ADDRESSES = """
BO_ 2566834449 OTHER: 8 AA
 SG_ Sxx : 0|8@1+ (1,0) [0|255] "" BB

BA_DEF_ BU_ "NmStationAddress" INT 0 255;
BA_DEF_ BO_ "VFrameFormat" ENUM "StandardCAN","ExtendedCAN","reserved","J1939PG";
BA_DEF_DEF_ "NmStationAddress" 254;
BA_DEF_DEF_ "VFrameFormat" "ExtendedCAN";
BA_ "NmStationAddress" BU_ AA 1;
"""


@pytest.mark.parametrize("j1939", [False, True])
def test_an_identifier_has_addresses_only_where_the_message_is_of_j1939(
    *, j1939: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = 'BA_ "VFrameFormat" BO_ 2566834449 3;\n' if j1939 else ""
    status, printed = linted(capsys, written(tmp_path, ADDRESSES + said))
    assert ("source-address" in printed) is j1939
    assert status == j1939


def test_one_number_in_both_widths_is_two_messages(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, "\nBO_ 2147483904 Wide: 8 AA\n")
    assert linted(capsys, path)[0] == 0
    status, printed = linted(capsys, path, "--profile", "house", "--select", "identifier-unique")
    assert (status, "identifier 0x100 of MSG" in printed) == (1, True)


def test_what_a_project_generates_is_linted_as_the_project_asks(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = sorted(path.name for path in (ROOT / "dbc").glob("*.dbc"))
    assert names
    for name in names:
        status, printed = linted(capsys, str(ROOT / "dbc" / name))
        assert (status, printed.splitlines()[-1]) == (0, "no findings"), name
        elsewhere = shutil.copy(ROOT / "dbc" / name, tmp_path)
        assert linted(capsys, str(elsewhere))[0] == 0, name


def test_the_level_that_fails_can_be_chosen(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, ' SG_ Sxx : 0|8@1+ (1,0) [0|300] "" BB\n')
    statuses = [linted(capsys, path, "--fail-on", each)[0] for each in ("error", "warning", "note")]
    assert statuses == [0, 1, 1]


def test_a_note_alone_fails_where_it_is_asked_to_only(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = ADDRESSES + (
        '\nBO_ 2566834450 AGAIN: 8 AA\n SG_ Sxx : 0|8@1+ (1,0) [0|255] "" BB\n'
        'BA_ "VFrameFormat" BO_ 2566834449 3;\nBA_ "VFrameFormat" BO_ 2566834450 3;\n'
    )
    path = written(tmp_path, lines)
    status, printed = linted(capsys, path, "--select", "pgn-unique")
    assert (status, printed.splitlines()[-1]) == (0, "1 finding: 1 note")
    assert linted(capsys, path, "--select", "pgn-unique", "--fail-on", "note")[0] == 1


@pytest.mark.parametrize(
    ("unit", "known"),
    [
        *(("kWh", True), ("m/s^2", True), ("1/min", True), ("Degrees", True), ("Volts", True)),
        *(("meters/sec", True), ("furlong", True), ("knot", True), ("millimeter", True)),
        *(("degc", False), ("kwh", False), ("enum", False), ("SED", False), ("unitless", False)),
    ],
)
def test_units_are_known_as_people_write_them(unit: str, *, known: bool) -> None:
    assert is_known(unit) is known


@pytest.mark.parametrize("rule", ["signals-overlap", "unit-known", "range-fits-bits", "dbc-form"])
def test_a_rule_is_explained_by_a_finding_in_the_lines_it_is_about(
    rule: str, capsys: pytest.CaptureFixture[str]
) -> None:
    expected = (Path(__file__).with_name("cases") / rule / "expected.txt").read_text("utf-8")
    assert run(["explain", rule]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith(f"{rule}: ")
    first = expected.splitlines()[0]
    assert f"  {first}" in printed.splitlines()
    number = first.split(":")[1]
    assert f"> {number:>4} | " in printed


def test_a_promise_is_explained_and_an_unknown_name_has_its_neighbour(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["explain", "signal-scale-same"]) == 0
    assert "class wire" in capsys.readouterr().out
    assert run(["explain", "signal-overlap"]) == 2
    assert "did you mean signals-overlap?" in capsys.readouterr().err


GROUP = (
    ' SG_ Group : 0|16@1+ (1,0) [0|0] "" BB\n SG_ Low : 0|8@1+ (1,0) [0|0] "" BB\n'
    ' SG_ High : 8|8@1+ (1,0) [0|0] "" BB\n'
)


def test_a_signal_that_covers_others_wholly_is_one_note_in_a_file_of_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, GROUP)
    status, printed = linted(capsys, path)
    assert (status, printed.splitlines()[-1]) == (0, "1 finding: 1 note")
    assert "Group covers Low, High of MSG: a group of signals, or a wrong length" in printed
    status, printed = linted(capsys, path, "--profile", "house", "--select", "signals-overlap")
    assert (status, printed.splitlines()[-1]) == (1, "2 findings: 2 error")


def test_a_signal_that_covers_one_other_or_is_covered_in_part_overlaps(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = written(tmp_path, "".join(GROUP.splitlines(keepends=True)[:2]))
    assert "error     Low overlaps Group at bit 0" in linted(capsys, one)[1]
    beside = ' SG_ Other : 12|8@1+ (1,0) [0|0] "" BB\n'
    status, printed = linted(capsys, written(tmp_path, GROUP + beside))
    assert (status, printed.splitlines()[-1]) == (1, "3 findings: 2 error, 1 note")


def test_a_node_that_is_not_declared_is_named_once_however_often_it_is_mentioned(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = ' SG_ Sxx : 0|8@1+ (1,0) [0|1] "" CC\n SG_ Syy : 8|8@1+ (1,0) [0|1] "" CC,DD\n'
    status, printed = linted(capsys, written(tmp_path, lines))
    assert (status, printed.count("node-declared")) == (1, 2)
    text = (HEAD + lines).replace("BU_: AA BB", "BU_:")
    (tmp_path / "none.dbc").write_text(text, "utf-8")
    assert linted(capsys, str(tmp_path / "none.dbc"))[0] == 0


@pytest.mark.parametrize(
    ("limits", "house", "foreign"), [("-128|128", 1, 0), ("-128|128.1", 1, 1), ("-129|0", 1, 1)]
)
def test_a_limit_of_others_may_be_rounded_to_the_next_step(
    limits: str, house: int, foreign: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, f' SG_ Sxx : 0|11@1+ (0.125,-128) [{limits}] "" BB\n')
    assert linted(capsys, path)[0] == foreign
    words = ("--profile", "house", "--select", "range-fits-bits")
    assert linted(capsys, path, *words)[0] == house
