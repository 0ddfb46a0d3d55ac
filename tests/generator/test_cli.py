"""The `dbcspec` command as a user runs it: exit status, messages, and what is left on disk."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from generator.command import dbcspec, in_a_process_of_its_own, refused, snapshot
from generator.small_spec import FILES, edited, write_project

OVERLAP = edited("messages.yaml", "H_Temp, length: 8, start: 16", "H_Temp, length: 8, start: 13")


def findings(folder: Path) -> list[dict[str, object]]:
    """What the linter finds, as JSON has it."""
    result = dbcspec(folder, "lint", "--json")
    found: list[dict[str, object]] = json.loads(result.stdout)["findings"]
    assert result.returncode == (1 if found else 0)
    return found


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A sound project that nothing has been generated from."""
    return write_project(tmp_path)


def test_generating_the_project_itself_makes_the_files_that_are_committed(
    root: Path, tmp_path: Path
) -> None:
    shutil.copy(root / "pyproject.toml", tmp_path)
    shutil.copytree(root / "spec", tmp_path / "spec", ignore=shutil.ignore_patterns("schema"))
    result = in_a_process_of_its_own(tmp_path, "generate")
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.startswith("caamtb-swap: 25 messages, 211 signals, ")
    made = snapshot(tmp_path)
    written = [line.removeprefix("wrote ") for line in result.stdout.splitlines()[1:-1]]
    assert len(written) == 26
    for name in written:
        assert made[name] == (root / name).read_bytes(), name


def test_generate_then_check_then_generate_again(small: Path) -> None:
    first = dbcspec(small, "generate")
    assert first.returncode == 0
    assert first.stdout.startswith("thermo: 2 messages, 5 signals, 2 value tables, 0 errata")
    assert "wrote out/thermo.dbc\n" in first.stdout
    made = snapshot(small)
    check = dbcspec(small, "check")
    assert check.returncode == 0
    assert "files are current, digest " in check.stdout
    again = dbcspec(small, "generate")
    assert again.returncode == 0
    assert "wrote" not in again.stdout
    assert snapshot(small) == made


def test_generate_says_in_json_what_it_did(small: Path) -> None:
    result = dbcspec(small, "generate", "--json")
    said = json.loads(result.stdout)
    assert (said["messages"], said["signals"], said["errata"]) == (2, 5, 0)
    assert "out/thermo-house.dbc" in said["changed"]
    assert json.loads(dbcspec(small, "generate", "--json").stdout)["changed"] == []


def test_check_names_each_file_that_is_not_current_and_exits_1(small: Path) -> None:
    dbcspec(small, "generate")
    path = small / "out" / "thermo.dbc"
    path.write_bytes(path.read_bytes().replace(b'"Temperature"', b'"Warmth"'))
    (small / "out" / "thermo.zh.dbc").unlink()
    (small / "out" / "thermo-old.dbc").write_bytes(b"")
    before = snapshot(small)
    result = dbcspec(small, "check")
    assert (result.returncode, result.stdout) == (1, "")
    assert [line for line in result.stderr.splitlines() if line.startswith("out/")] == [
        "out/thermo.dbc: edited by hand",
        "out/thermo.zh.dbc: missing",
        "out/thermo-old.dbc: no longer generated: delete it",
    ]
    assert "Warmth" in result.stderr
    last = result.stderr.splitlines()[-1]
    assert "files are not current: dbcspec generate writes them; delete the 1 no longer" in last
    assert last.startswith("2 of ")
    in_json = dbcspec(small, "check", "--json")
    assert in_json.returncode == 1
    assert [each["path"] for each in json.loads(in_json.stdout)] == [
        "out/thermo.dbc",
        "out/thermo.zh.dbc",
        "out/thermo-old.dbc",
    ]
    assert snapshot(small) == before


def test_check_finds_every_file_stale_after_the_spec_changed(small: Path) -> None:
    dbcspec(small, "generate")
    write_project(small, **{"02-panel": edited("tables/02-panel.yaml", "5~30", "5~35")})
    result = dbcspec(small, "check", "--json")
    assert result.returncode == 1
    assert {each["why"] for each in json.loads(result.stdout)} == {"stale"}


def test_lint_has_nothing_against_a_sound_spec(small: Path) -> None:
    assert dbcspec(small, "lint").returncode == 0
    assert findings(small) == []


def test_lint_names_a_finding_with_its_place_and_rule_and_exits_1(tmp_path: Path) -> None:
    write_project(tmp_path, messages=OVERLAP)
    result = dbcspec(tmp_path, "lint")
    assert result.returncode == 1
    for part in ("spec/messages.yaml:15:", "signals-overlap", "H_Temp overlaps H_Mode at bit 13"):
        assert part in result.stdout
    (found,) = findings(tmp_path)
    assert (found["rule"], found["subject"]) == ("signals-overlap", "H_Temp")
    assert (found["path"], found["line"]) == ("spec/messages.yaml", 15)


def test_a_waived_finding_is_none_and_a_waiver_of_nothing_is_one(tmp_path: Path) -> None:
    write_project(tmp_path, messages=OVERLAP)
    with (tmp_path / "pyproject.toml").open("a", encoding="utf-8") as file:
        file.write(
            "\n[[tool.dbcspec.waivers]]\n"
            'rule = "signals-overlap"\nsubject = "H_Temp"\nreason = "seen"\n'
        )
    assert findings(tmp_path) == []
    assert dbcspec(tmp_path, "generate").returncode == 0
    (tmp_path / "spec" / "messages.yaml").write_text(FILES["messages.yaml"], "utf-8")
    (found,) = findings(tmp_path)
    assert (found["rule"], found["path"], found["line"]) == ("waiver-used", "pyproject.toml", 6)


def test_findings_keep_generate_and_check_from_doing_anything(tmp_path: Path) -> None:
    dbcspec(write_project(tmp_path), "generate")
    write_project(tmp_path, messages=OVERLAP)
    before = snapshot(tmp_path)
    for command in ("generate", "check"):
        result = dbcspec(tmp_path, command)
        assert (result.returncode, result.stdout) == (1, "")
        assert "spec/messages.yaml:" in result.stderr
        assert ": signals-overlap: " in result.stderr
    assert snapshot(tmp_path) == before


def test_all_faults_of_all_files_are_shown_at_once_and_nothing_is_written(tmp_path: Path) -> None:
    dbcspec(write_project(tmp_path), "generate")
    write_project(
        tmp_path,
        standard=FILES["standard.yaml"].replace("english: Thermostat", "englsh: Thermostat"),
        messages=FILES["messages.yaml"].replace("period: 100", "period: often"),
        **{
            "01-heater": FILES["tables/01-heater.yaml"].replace("range: 0~15", "range: 0-15"),
            "02-panel": FILES["tables/02-panel.yaml"].replace("unit: ℃", "unit: ℃\n    unit: K"),
        },
    )
    expected = [
        "spec/messages.yaml:9:13: expected a whole number, not 'often'",
        "spec/standard.yaml:1:1: key 'english' is missing",
        "spec/standard.yaml:3:1: unknown key 'englsh'; did you mean 'english'?",
        "spec/tables/01-heater.yaml:24:12: expected a range such as 0~255, not '0-15'",
        "spec/tables/02-panel.yaml:14:5: key 'unit' stands here twice",
    ]
    for command in (("generate",), ("check",), ("lint",), ("show", "Heater"), ("lint", "--json")):
        assert refused(tmp_path, *command) == expected


@pytest.mark.parametrize(
    ("name", "data", "fault"),
    [
        ("messages.yaml", b"", "spec/messages.yaml:1:1: the file is empty"),
        ("messages.yaml", b"a: \xff\n", "spec/messages.yaml:1:4: not UTF-8: byte 0xFF"),
        ("messages.yaml", b"a: [\n", "spec/messages.yaml:2:1: not YAML: "),
        ("messages.yaml", b"[" * 99_999, "spec/messages.yaml:1:"),
        ("messages.yaml", b"- a\n", "spec/messages.yaml:1:1: expected a mapping"),
        ("errata.yaml", b"errata: 3\n", "spec/errata.yaml:1:9: expected a list"),
        ("tables/03-x.yaml", b"\x00", "spec/tables/03-x.yaml:1:1: not YAML: "),
    ],
)
def test_a_file_that_is_no_spec_is_told_with_its_place(
    name: str, data: bytes, fault: str, small: Path
) -> None:
    (small / "spec" / name).write_bytes(data)
    (line,) = refused(small, "generate")
    assert line.startswith(fault)


def test_a_missing_file_of_the_spec_is_told(small: Path) -> None:
    (small / "spec" / "messages.yaml").unlink()
    (line,) = refused(small, "generate")
    assert line.startswith("spec/messages.yaml:1:1: cannot be read: ")


def test_a_configuration_that_cannot_be_used_is_told_in_one_line(small: Path) -> None:
    (small / "pyproject.toml").write_text("[tool.dbcspec]\nname = 3\n", "utf-8")
    (line,) = refused(small, "generate")
    assert line.startswith("dbcspec: ")
    assert line.endswith("pyproject.toml: [tool.dbcspec] name must be text")


def test_a_folder_above_the_current_one_may_hold_the_configuration(small: Path) -> None:
    result = dbcspec(small / "spec" / "tables", "lint")
    assert result.returncode == 0


def test_another_folder_may_be_named(small: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    assert dbcspec(elsewhere, "lint", "-C", str(small)).returncode == 0
    (line,) = refused(elsewhere, "lint")
    assert line.startswith("dbcspec: no pyproject.toml")


def test_an_output_folder_that_is_a_file_is_told(small: Path) -> None:
    (small / "out").write_text("")
    (line,) = refused(small, "generate")
    assert line.startswith("dbcspec: ")
    assert "out" in line


def test_show_prints_a_message_with_its_bits_signals_and_codes(small: Path) -> None:
    by_message, by_signal = (dbcspec(small, "show", name) for name in ("Heater", "H_Temp"))
    assert by_message.returncode == 0
    assert by_message.stdout == by_signal.stdout
    lines = by_message.stdout.splitlines()
    assert lines[0] == "Heater  0x18FF0120  8 bytes  HEATER > PANEL  every 100 ms"
    # Bits 12 and 13 are the third signal, 8 to 11 the second, 14 and 15 nobody's.
    assert "byte 1   .  .  c  c  b  b  b  b" in lines
    assert "byte 3   .  .  .  .  .  .  .  ." in lines
    assert "HeaterMode: 0 Off (关), 1 On (开), 2 ECO, 3 Invalid" in lines


def test_show_suggests_a_name_that_is_close(small: Path) -> None:
    (line,) = refused(small, "show", "H_Tmp")
    assert line.startswith("dbcspec: there is no message or signal 'H_Tmp'; did you mean H_Temp")


def test_rules_lists_every_rule_with_its_purpose(small: Path) -> None:
    text, in_json = dbcspec(small, "rules"), dbcspec(small, "rules", "--json")
    rules = json.loads(in_json.stdout)
    assert (text.returncode, in_json.returncode) == (0, 0)
    assert [line.split()[0] for line in text.stdout.splitlines()] == [rule["id"] for rule in rules]
    assert all(rule["purpose"] in text.stdout for rule in rules)
    assert "signals-overlap" in text.stdout


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("generat",), "COMMAND"),
        (("generat",), "'generat'"),
        (("matrix",), "COMMAND; see dbcspec matrix --help"),
        (("show",), "MESSAGE; see dbcspec show --help"),
        (("lint", "--jsn"), "--jsn"),
        (("load", "--groups", "0"), "expected a positive whole number, not '0'"),
    ],
)
def test_a_command_line_that_makes_no_sense_is_one_line(
    arguments: tuple[str, ...], text: str, small: Path
) -> None:
    (line,) = refused(small, *arguments)
    assert line.startswith("dbcspec: ")
    assert text in line


def test_without_a_command_there_is_help(small: Path) -> None:
    assert any(line.startswith("  dbcspec generate  ") for line in refused(small))


def test_a_process_of_its_own_ends_with_the_same_status_and_words(tmp_path: Path) -> None:
    sound, faulty = tmp_path / "sound", tmp_path / "faulty"
    for folder in (sound, faulty):
        folder.mkdir()
    write_project(sound)
    write_project(faulty, messages=OVERLAP)
    for folder, status in ((sound, 0), (faulty, 1), (tmp_path, 2)):
        result = in_a_process_of_its_own(folder, "lint")
        assert result.returncode == status
        assert result == dbcspec(folder, "lint")


def test_a_code_page_without_chinese_gets_question_marks(small: Path) -> None:
    result = in_a_process_of_its_own(small, "show", "Heater", encoding="ascii")
    assert result.returncode == 0
    assert "Off (?)" in result.stdout
