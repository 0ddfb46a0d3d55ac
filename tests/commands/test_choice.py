"""`--reading` and `--edition`: what is chosen counts in every command that has a protocol."""

from __future__ import annotations

from pathlib import Path

import can
import pytest
from spoken.editions import PUMP

from swapcan import cli
from typedcan.__main__ import main
from typedcan.commands import send
from typedcan.commands.tool import Tool
from typedcan.shell import command_line
from typedcan.shell.command_line import Program

Capture = pytest.CaptureFixture[str]

COMMANDS = ("decode", "listen", "send", "convert", "plot", "monitor", "simulate", "demo")


# V2B_CMD with all contactors' faults at code 1: weld by the standard, open by V4.6.
@pytest.fixture
def log(tmp_path: Path) -> Path:
    data = [0, 0xA0, 0, 0xFE, 0x50, 0x44, 0x44, 0]
    frame = bytes([data[1] ^ data[2] ^ data[3] ^ data[4] ^ data[5] ^ data[6], *data[1:]])
    path = tmp_path / "truck.log"
    path.write_text(f"(1700000000.000000) can0 1802F3D0#{frame.hex().upper()}\n")
    return path


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_knows_both_options(command: str, capsys: Capture) -> None:
    assert cli.run([command, "--help"]) == 0
    text = capsys.readouterr().out
    assert "--reading ID" in text
    assert "--edition NAME" in text


def test_a_log_is_decoded_as_the_edition_means_it(log: Path, capsys: Capture) -> None:
    assert cli.run(["decode", str(log)]) == 0
    usual = capsys.readouterr().out
    assert cli.run(["decode", str(log), "--edition", "v4.6", "--reading", "E50b"]) == 0
    chosen = capsys.readouterr().out
    assert ("main_motor_con_flt=Weld" in usual, "main_motor_con_flt=Opened" in chosen) == (
        True,
        True,
    )


def test_a_label_is_sent_with_the_code_of_the_edition(capsys: Capture) -> None:
    words = ["V2B_CMD", "hv_on_off=2", "hv_acc_on_off=2", "heat_on_off=invalid"]
    words += ["main_motor_con_flt=weld", "-i", "virtual", "-c", "choice"]
    codes = []
    with can.Bus("choice", interface="virtual") as far:
        for options in ([], ["--edition", "v4.6"]):
            assert cli.run(["send", *words, *options]) == 0
            frame = far.recv(1.0)
            assert frame is not None
            codes.append(frame.data[4] >> 4 & 3)
    assert codes == [1, 2]
    assert capsys.readouterr().out.count("main_motor_con_flt=Weld") == 2


def test_a_package_of_any_protocol_has_its_choices(log: Path, capsys: Capture) -> None:
    arguments = ["--protocol", "swapcan._generated", "decode", str(log), "--edition", "v4.6"]
    assert main(arguments) == 0
    assert "main_motor_con_flt=Opened" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ([], "heat = Off makes its receiver act where edition maker is spoken: not sent without"),
        (["--edition", "maker"], "cannot open the bus"),
    ],
)
def test_a_code_that_acts_in_some_edition_needs_consent_unless_one_is_chosen(
    options: list[str], said: str, capsys: Capture
) -> None:
    tool = Tool(program="pump", own=lambda _: PUMP, help={"send": "send"}, examples={})
    program = Program(
        name="pump",
        description="",
        epilog="",
        commands={"send": "send"},
        add=lambda commands, _: send.command(tool).add(commands),
    )
    words = ["send", "Command", "heat=off", "speed=1", *options, "-i", "serial"]
    assert command_line.run(program, words) == 2
    assert said in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--reading", "E50x"], "no reading or edition 'E50x'; did you mean"),
        (["--edition", "V4.6"], "no reading or edition 'V4.6'; did you mean 'v4.6'?"),
        (["--edition", "E50b"], "E50b is a reading, not an edition: --reading E50b chooses it"),
        (["--reading", "v4.6"], "v4.6 is an edition, not a reading: --edition v4.6 chooses it"),
        (["--dbc", "truck.dbc", "--edition", "v4.6"], "--edition chooses in a package"),
        (["--dbc", "truck.dbc", "--reading", "E50b"], "--reading chooses in a package"),
    ],
)
def test_what_cannot_be_chosen_is_one_line(
    log: Path, options: list[str], said: str, capsys: Capture
) -> None:
    assert cli.run(["decode", str(log), *options]) == 2
    errors = capsys.readouterr().err
    assert errors.count("\n") == 1
    assert said in errors
