"""What all commands share: help, version, completion, errors, terminals, interruption."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import can
import pytest
from can.interfaces.virtual import VirtualBus
from shell.terminal import in_terminal

from swapcan import cli
from swapcan.messages import MESSAGES

Command = Callable[..., subprocess.CompletedProcess[str]]
NO_TERMINALS = sys.platform == "win32"


@pytest.mark.parametrize(
    "words", [[], ["demo"], ["decode"], ["send"], ["listen"], ["monitor"], ["simulate"]]
)
def test_help_has_examples_and_is_printed_to_stdout(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.run([*words, "--help"]) == 0
    out, errors = capsys.readouterr()
    assert errors == ""
    examples = out.partition("examples:\n")[2]
    assert f"  swapcan {' '.join(words)}".rstrip() in examples


def test_the_version_is_printed(swapcan_command: Command) -> None:
    done = swapcan_command("--version")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("swapcan ")


def test_without_a_command_there_is_help_and_exit_status_2(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert cli.run([]) == 2
    out, errors = capsys.readouterr()
    assert out == ""
    assert "swapcan demo  " in errors


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["dance"], "'dance'"),
        (["--loud"], "--loud"),
        (["decode"], "LOGFILE; see swapcan decode --help"),
        (["demo", "--seconds", "0"], "expected a positive number of seconds, not '0'"),
        (["demo", "--seconds", "nan"], "expected a positive number of seconds, not 'nan'"),
        (["listen", "--seconds", "soon"], "expected a positive number of seconds, not 'soon'"),
        (["listen", "--count", "0"], "expected a positive whole number, not '0'"),
        (["--print-completion", "cmd"], "'cmd'"),
    ],
)
def test_a_wrong_argument_is_one_line(
    words: list[str], text: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.run(words) == 2
    out, errors = capsys.readouterr()
    assert out == ""
    assert errors.startswith("swapcan: ")
    assert text in errors
    assert errors.count("\n") == 1


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_a_completion_script_is_printed(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("shtab")
    assert cli.run(["--print-completion", shell]) == 0
    out, errors = capsys.readouterr()
    assert errors == ""
    assert "swapcan" in out
    assert "listen" in out


def test_completion_without_its_extra_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert cli.run(["--print-completion", "bash"]) == 2
    assert capsys.readouterr().err == (
        "swapcan: completion needs shtab: pip install 'swapcan[completion]'\n"
    )


def test_a_narrow_code_page_gets_question_marks(swapcan_command: Command, tmp_path: Path) -> None:
    log = tmp_path / "drive.log"
    log.write_text("(1.0) 总线 18FFF8A7#0000000000000000\n", encoding="utf-8")
    done = swapcan_command("decode", str(log), PYTHONIOENCODING="ascii", LC_ALL="C.UTF-8")
    assert done.returncode == 0
    assert done.stdout.split()[:4] == ["1.000000", "??", "Rx", "18FFF8A7"]


@pytest.mark.skipif(sys.platform == "win32", reason="needs a POSIX shell")
@pytest.mark.parametrize("closed", [">&-", "2>&-"])
def test_a_closed_output_is_no_reason_for_a_traceback(
    closed: str, environment: dict[str, str], channel: str
) -> None:
    words = [sys.executable, "-m", "swapcan", "send", "V2B_CMD", "-i", "virtual", "-c", channel]
    done = subprocess.run(
        ["sh", "-c", f'"$@" {closed}', "sh", *words],
        env=environment,
        capture_output=True,
        encoding="utf-8",
        timeout=30,
        check=False,
    )
    assert done.returncode == 0
    assert "Traceback" not in done.stdout + done.stderr


@pytest.mark.parametrize("gone", [can.CanOperationError("adapter is gone"), OSError("no device")])
def test_an_adapter_pulled_out_ends_listen_with_summary_and_error(
    gone: Exception, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    class BrokenBus(VirtualBus):
        def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
            raise gone

    monkeypatch.setattr(can, "Bus", BrokenBus)
    assert cli.run(["listen"]) == 2
    _, summary, error = capsys.readouterr().err.splitlines()
    assert summary.startswith("swapcan: frames 0, ")
    assert error == f"swapcan: {gone}"


def test_the_demo_exchanges_every_message_without_a_fault(swapcan_command: Command) -> None:
    done = swapcan_command("demo", "--seconds", "2")
    assert done.returncode == 0
    assert done.stderr == "swapcan: pack and truck talk for 2 s, Ctrl-C ends\n"
    messages, signals, results = done.stdout.split("\n\n")
    rows = {line.split()[0]: line.split() for line in messages.splitlines()[2:]}
    assert list(rows) == [kind.NAME for kind in MESSAGES]
    assert rows["V2B_CMD"][:5] == ["V2B_CMD", "0x1802F3D0", "VCU", ">", "BMU"]
    assert 20 <= int(rows["V2B_CMD"][5]) <= 42
    assert rows["V2B_VIN"][5] == "3"
    assert rows["B2V_ElecEnergy"][5] == "1"
    assert 80 <= int(rows["B2V_Ucell"][5]) <= 168  # 8 frames for 24 cells, ten times a second
    shown = dict(line.split(None, 2)[1:] for line in signals.splitlines()[2:])
    assert len(shown) == 211
    assert shown["B2V_ST1_BMS"].split(None, 1) == ["2", "HV closed"]
    assert shown["B2V_ST2_SOC"].split() == ["76.4", "%"]
    assert shown["B2V_ST0_ST_Prechg"].split() == ["1", "Open"]
    assert shown["BMS_Life"].split()[0] in ("1", "2")  # once a second
    values = {line[:24].strip(): line[24:] for line in results.splitlines()}
    assert values["high voltage"] == "HV open, Precharge, HV closed"
    assert values["messages"] == "25 of 25"
    assert values["faults"] == "0"
    assert len(values["pack code at the truck"]) == 24
    assert has_valid_check_digit(values["VIN at the pack"])


def has_valid_check_digit(vin: str) -> bool:
    """By ISO 3779, position 9."""
    letters = dict(zip("ABCDEFGHJKLMNPRSTUVWXYZ", "12345678123457923456789", strict=True))
    weights = (8, 7, 6, 5, 4, 3, 2, 10, 0, 9, 8, 7, 6, 5, 4, 3, 2)
    total = sum(int(letters.get(c, c)) * w for c, w in zip(vin, weights, strict=True))
    return vin[8] == "0123456789X"[total % 11]


def test_a_demo_too_short_for_all_messages_says_which_are_missing(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert cli.run(["demo", "--seconds", "0.001"]) == 1
    out, errors = capsys.readouterr()
    assert "messages                25 of 25" not in out
    last = errors.splitlines()[-1]
    assert last.startswith("swapcan: not received: ")
    assert "V2B_VIN" in last


@pytest.mark.skipif(NO_TERMINALS, reason="no pseudo-terminals")
def test_a_terminal_gets_the_same_text_as_a_pipe(
    swapcan_command: Command, environment: dict[str, str]
) -> None:
    shown, status = in_terminal(
        "swapcan", "send", "B2V_ST2", "soc=80", "-i", "virtual", environment=environment
    )
    done = swapcan_command("send", "B2V_ST2", "soc=80", "-i", "virtual")
    assert status == done.returncode == 0
    assert shown == done.stdout.replace("\n", "\r\n")
    assert "\x1b" not in shown


@pytest.mark.skipif(NO_TERMINALS, reason="no pseudo-terminals")
@pytest.mark.parametrize("words", [["listen", "-i", "virtual"], ["demo", "--seconds", "60"]])
def test_ctrl_c_typed_in_a_terminal_leaves_no_traceback(
    words: list[str], environment: dict[str, str]
) -> None:
    shown, status = in_terminal(
        "swapcan", *words, environment=environment, after="Ctrl-C ends", typed=b"\x03"
    )
    assert status == 130
    assert "Traceback" not in shown
    assert "KeyboardInterrupt" not in shown
