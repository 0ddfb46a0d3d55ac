"""`swapcan conform`: what it refuses before it does anything, and what it shows of itself."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from pathlib import Path

import pytest

from swapcan import cli
from swapcan.conform import RULES
from swapcan.scenarios.scenarios import SCENARIOS


def run(*arguments: object) -> int:
    """The exit status of the command."""
    return cli.run(["conform", *map(str, arguments)])


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ([], "what is to be judged? give logs, or a bus with -i and -c"),
        (["no.log"], f"no.log: {os.strerror(errno.ENOENT)}"),
        (["{log}", "--judge", "BMS"], "there is no node 'BMS'; BMU, VCU, CHG, TMS, BSU"),
        (["{log}", "--only", "checksums"], "there is no rule 'checksums'; see --list-rules"),
        (["{log}", "--skip", "reaction-hv-on"], "there is no rule 'reaction-hv-on'; see"),
        (["{log}", "--only", "checksum", "--skip", "checksum"], "leave no rule to judge by"),
        (["{log}", "--tolerance", "a.b=1"], "there is no tolerance 'a.b'; see --list-tolerances"),
        (["{log}", "--tolerance", "a.b=nan"], "expected NAME=NUMBER, not 'a.b=nan'"),
        (["{log}", "--tolerance", "a.b=-1"], "expected NAME=NUMBER, not 'a.b=-1'"),
        (["{log}", "--tolerance", "a.b=1_0"], "expected NAME=NUMBER, not 'a.b=1_0'"),
        (["{log}", "--tolerance", "a.b"], "expected NAME=NUMBER, not 'a.b'"),
        (["{log}", "--language", "de"], "--language"),
        (["{log}", "--from", "soon"], "expected seconds or a date like"),
        (["{log}", "-i", "virtual"], "--interface is for a bus: judge logs, or a bus, not both"),
        (["{log}", "--yes-drive-the-bus"], "--yes-drive-the-bus is for a bus"),
        (["-i", "virtual", "--from", "1"], "--from and --to are for logs"),
        (["-i", "virtual", "--duration", "0"], "expected a time longer than none"),
        (["-i", "virtual", "--duration", "soon"], "expected a time such as 30s, 500ms or 2min"),
        (["-i", "virtual", "--active", "fly"], "there is no scenario 'fly'; known: hv-on-off"),
        (["-i", "virtual", "--active", "charge", "--duration", "1m"], "a scenario has its own"),
        (["-i", "virtual", "--play", "VCU"], "nothing is sent without --active"),
        (["-i", "virtual", "--active", "charge", "--play", "VCU"], "charge has to play CHG"),
        (["-i", "virtual", "--active", "requests", "--judge", "VCU"], "plays VCU: it cannot be"),
    ],
)
def test_what_makes_no_sense_is_one_line_and_status_2(
    arguments: Sequence[str], problem: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "empty.log"
    log.touch()
    assert run(*(each.format(log=log) for each in arguments)) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert problem in said.err
    assert said.err.count("\n") == 1


def test_rules_and_tolerances_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--list-rules", "--language", "zh") == 0
    lines = {text.split()[0]: text for text in capsys.readouterr().out.splitlines()}
    for rule in RULES:
        assert rule.severity.name.lower() in lines[rule.id]
        assert rule.clause in lines[rule.id]
        assert rule.title.zh in lines[rule.id]
    assert run("--list-tolerances") == 0
    lines = {text.split()[0]: text for text in capsys.readouterr().out.splitlines()}
    for tolerance in (each for rule in RULES for each in rule.tolerances):
        assert lines[tolerance.name].split()[1] == f"{tolerance.value:g}"


def test_scenarios_are_listed_with_what_they_send(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--list-scenarios") == 0
    said = capsys.readouterr().out
    assert [text.partition(":")[0] for text in said.splitlines() if text[:1].islower()] == list(
        SCENARIOS
    )
    assert "V2B_CMD 0x1802F3D0 every 50 ms" in said
    assert "THE PACK MAY CLOSE ITS CONTACTORS" in said
