"""`swapcan conform` on logs: exit status, summary, reports, and what it refuses."""

from __future__ import annotations

import csv
import errno
import json
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import can
import pytest
from rules.recorded import recorded, written
from scenarios.lines import line

from swapcan import cli
from swapcan.conform import RULES
from swapcan.messages import B2V_ST1
from typedcan.commands import log_options

SECONDS = 4.0


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A pack and a truck that does nothing."""
    frames = recorded("", seconds=SECONDS, nodes=("BMU", "VCU"))
    return written(frames, tmp_path_factory.mktemp("conform") / "sound.log")


@pytest.fixture(scope="module")
def spoilt(sound: Path) -> Path:
    """The same with three wrong checksums of B2V_ST1, at 2 s and later."""
    lines = sound.read_text("ascii").splitlines(keepends=True)
    places = [at for at, text in enumerate(lines) if f"{B2V_ST1.FRAME_ID:08X}#" in text]
    for at in places[20:26:2]:
        head, _, data = lines[at].partition("#")
        lines[at] = f"{head}#{int(data[:2], 16) ^ 0xFF:02X}{data[2:]}"
    path = sound.with_name("spoilt.log")
    path.write_text("".join(lines), "ascii", newline="\n")
    return path


def run(*arguments: object) -> int:
    """The exit status of the command."""
    return cli.run(["conform", *map(str, arguments)])


def as_json(capsys: pytest.CaptureFixture[str]) -> Any:
    """What it printed."""
    return json.loads(capsys.readouterr().out)


def test_a_log_that_conforms_is_status_0(sound: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(sound) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert said.out.startswith(f"Conforms: {sound}\n")
    assert "\x1b" not in said.out


def test_a_log_that_does_not_conform_is_status_1_and_what_breaks_it_is_counted(
    spoilt: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(spoilt, "--json") == 1
    (log,) = as_json(capsys)["logs"]
    assert log["log"] == str(spoilt)
    assert log["verdict"] == "violates"
    (failed,) = [rule for rule in log["rules"] if rule["status"] == "failed"]
    assert (failed["id"], failed["count"]) == ("checksum", 3)


def test_one_bad_log_among_good_ones_is_status_1(
    sound: Path, spoilt: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(sound, spoilt, sound, "--json") == 1
    verdicts = [log["verdict"] for log in as_json(capsys)["logs"]]
    assert verdicts == ["conforms", "violates", "conforms"]


def test_only_the_asked_nodes_are_judged(spoilt: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(spoilt, "--judge", "vcu", "--json") == 0
    assert as_json(capsys)["logs"][0]["nodes"] == ["VCU"]
    assert run(spoilt, "--judge", "VCU,BMU") == 1
    assert run(spoilt, "--judge", "VCU", "--judge", "BMU") == 1


def test_a_node_that_was_asked_for_and_is_not_there_is_status_2(
    sound: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(sound, "--judge", "CHG") == 2
    capsys.readouterr()
    assert run(sound, "--judge", "BMU,CHG,TMS") == 2
    assert capsys.readouterr().err.splitlines() == [
        f"swapcan: {sound}: no frame of CHG, TMS",
    ]


def test_a_log_without_frames_could_not_be_judged(tmp_path: Path) -> None:
    empty = tmp_path / "empty.log"
    empty.touch()
    assert run(empty) == 2


@pytest.mark.parametrize("broken", [False, True])
def test_a_damaged_log_is_judged_as_far_as_it_goes(
    *,
    broken: bool,
    sound: Path,
    spoilt: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    whole = tmp_path / "whole.blf"
    with can.LogReader(spoilt if broken else sound) as reader, can.Logger(whole) as writer:
        for frame in reader:
            frame.channel = 0
            writer(frame)
    damaged = tmp_path / "damaged.blf"
    damaged.write_bytes(whole.read_bytes()[:-100])
    status = run(damaged, "--json")
    said = capsys.readouterr()
    (log,) = json.loads(said.out)["logs"]
    assert log["damage"]
    assert "damaged: not all of it could be judged" in said.err
    assert status == (1 if log["verdict"] == "violates" else 2)


def told_on(seconds: float) -> list[str]:
    """A pack that stays open under the command on, which breaks no demand by itself."""
    lines = [
        line(
            number * 0.05,
            "V2B_CMD",
            HV_OnOff=1 if number >= 10 else 2,
            ALIV=number % 15,
        )
        for number in range(round(seconds / 0.05))
    ]
    lines += [
        line(number * 0.1 + 0.02, "B2V_ST1", ALIV=number % 15)
        for number in range(round(seconds / 0.1))
    ]
    return sorted(lines)


def test_a_recommendation_counts_where_it_is_asked_for(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "open.log"
    log.write_text("".join(told_on(5.0)), "ascii")
    assert run(log, "--only", "hv-on-in-time") == 0
    capsys.readouterr()
    assert run(log, "--only", "hv-on-in-time", "--strict") == 1
    assert "--strict: a recommendation that is not heeded counts" in capsys.readouterr().err


def test_a_tolerance_can_be_given(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "open.log"
    log.write_text("".join(told_on(5.0)), "ascii")
    options = ("--only", "hv-on-in-time", "--strict", "--json")
    assert run(log, *options, "--tolerance", "hv-on-in-time.seconds=4.9") == 0
    assert as_json(capsys)["logs"][0]["rules"][0]["tolerances"][0]["value"] == 4.9
    assert run(log, *options, "--tolerance", "hv-on-in-time.seconds=4") == 1


def test_only_and_skip_choose_rules(spoilt: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(spoilt, "--skip", "checksum", "--json") == 0
    ids = [rule["id"] for rule in as_json(capsys)["logs"][0]["rules"]]
    assert ids == [rule.id for rule in RULES if rule.id != "checksum"]
    assert run(spoilt, "--only", "frame-length,checksum", "--skip", "checksum", "--json") == 0
    assert [rule["id"] for rule in as_json(capsys)["logs"][0]["rules"]] == ["frame-length"]


def test_a_part_of_the_log_can_be_judged(spoilt: Path) -> None:
    assert run(spoilt, "--only", "checksum", "--to", "1.5") == 0
    assert run(spoilt, "--only", "checksum", "--from", "1.5") == 1


def test_the_language_is_the_one_that_is_asked_for_and_no_other(
    sound: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("LANG", "zh_CN.UTF-8")
    monkeypatch.setenv("LC_ALL", "zh_CN.UTF-8")
    assert run(sound) == 0
    assert capsys.readouterr().out.isascii()
    assert run(sound, "--language", "zh") == 0
    assert "符合" in capsys.readouterr().out


def test_verbose_names_the_rules_that_passed(
    sound: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(sound, "--only", "checksum")
    assert "checksum" not in capsys.readouterr().out
    run(sound, "--only", "checksum", "--verbose")
    assert "checksum" in capsys.readouterr().out


def test_reports_are_written_and_replaced(
    sound: Path, spoilt: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page, junit, table = (tmp_path / "out" / name for name in ("a.html", "a.xml", "a.csv"))
    options = ("--html", page, "--junit", junit, "--csv", table)
    assert run(sound, *options) == 0
    before = table.read_bytes()
    assert run(sound, spoilt, *options) == 1
    said = capsys.readouterr().err
    assert [f"wrote {each}" in said for each in (page, junit, table)] == [True] * 3
    assert sorted(each.name for each in page.parent.iterdir()) == ["a.csv", "a.html", "a.xml"]
    assert page.read_text("utf-8").startswith("<!DOCTYPE html>")
    assert str(spoilt) in page.read_text("utf-8")
    suites = ET.parse(junit).getroot().findall("testsuite")
    assert [(suite.get("name"), suite.get("failures")) for suite in suites] == [
        (str(sound), "0"),
        (str(spoilt), "1"),
    ]
    rows = list(csv.DictReader(table.read_text("utf-8").splitlines()))
    found = [row["rule"] for row in rows if row["status"] != "not_judged"]
    assert found == ["checksum"] * 3
    assert table.read_bytes() != before


def test_a_report_that_cannot_be_finished_leaves_the_old_one(
    sound: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    table = tmp_path / "a.csv"
    table.write_text("old", "ascii")

    def fail(*_: object) -> None:
        raise OSError(errno.ENOSPC, "full")

    monkeypatch.setattr(Path, "replace", fail)
    assert run(sound, "--csv", table) == 2
    assert capsys.readouterr().err == f"swapcan: {table}: cannot be written: full\n"
    assert [each.name for each in tmp_path.iterdir()] == ["a.csv"]
    assert table.read_text("ascii") == "old"


def test_a_report_never_takes_the_place_of_a_log_or_of_another(
    sound: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    link = tmp_path / "link.csv"
    link.symlink_to(sound)
    before = sound.read_bytes()
    for options, problem in (
        (("--csv", sound), f"--csv: {sound} is the log"),
        (("--html", link), f"--html: {sound} is the log"),
        (("--csv", tmp_path / "a", "--junit", tmp_path / "a"), "is written already"),
        (("--csv", tmp_path), f"{tmp_path}: there is a folder of that name"),
    ):
        assert run(sound, *options) == 2
        said = capsys.readouterr()
        assert said.out == ""
        assert problem in said.err
        assert said.err.count("\n") == 1
    assert sound.read_bytes() == before


def test_without_numpy_it_says_what_to_install(
    sound: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(log_options, "find_spec", lambda _name: None)
    assert run(sound) == 2
    assert capsys.readouterr().err == "swapcan: this needs numpy: pip install 'swapcan[logs]'\n"


def test_help_has_examples(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--help") == 0
    examples = capsys.readouterr().out.partition("examples:\n")[2]
    assert "  swapcan conform drive.blf\n" in examples
    assert "exit status: 0 it conforms, 1 it does not, 2" in examples
