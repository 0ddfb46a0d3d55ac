"""`decode` shows what is asked for, counts everything, and fits the terminal."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import can
import pytest

from swapcan import Link
from swapcan.cli import run
from swapcan.messages import B2V_ST2, BSU_BMS_0, V2B_CMD
from typedcan.commands.transcript import wrapped
from typedcan.model.signal_state import SignalState

Capture = pytest.CaptureFixture[str]


def frames() -> list[can.Message]:
    """SOC 80, 80, 19 %, invalid; a command; a swap controller's frame that is too short."""
    with can.Bus(interface="virtual", channel="shown", receive_own_messages=True) as bus:
        link = Link(bus)
        for soc in (80.0, 80.0, 19.0, SignalState.INVALID):
            link.send(B2V_ST2(soc=soc))
        link.send(V2B_CMD())
        bus.send(can.Message(arbitration_id=BSU_BMS_0.FRAME_ID, data=bytes(7)))
        found: list[can.Message] = []
        while (frame := bus.recv(0.2)) is not None:
            frame.timestamp = len(found) / 10
            found.append(frame)
        return found


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("shown") / "drive.log"
    with can.Logger(path) as logger:
        for frame in frames():
            logger.on_message_received(frame)
    return path


def times(log: Path, capsys: Capture, *arguments: str) -> list[float]:
    """The time stamps of the lines that are shown; everything is counted."""
    assert run(["decode", str(log), *arguments]) == 0
    out, errors = capsys.readouterr()
    assert "frames 6, decoded 5, " in errors
    return [float(line.split()[0]) for line in out.splitlines()]


@pytest.mark.parametrize(
    ("arguments", "found"),
    [
        ((), [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]),
        (("--messages", "b2v_st2"), [0.0, 0.1, 0.2, 0.3]),
        (("--messages", "V2B_CMD,BSU_BMS_0"), [0.4, 0.5]),
        (("--nodes", "vcu"), [0.4]),
        (("--where", "soc<20"), [0.2]),
        (("--where", "soc <= 80"), [0.0, 0.1, 0.2]),
        (("--where", "B2V_ST2.B2V_ST2_SOC != 80"), [0.2, 0.3]),
        (("--where", "soc=invalid"), [0.3]),
        (("--where", "soc>20", "--where", "soc<70"), []),
        (("--where", "heat_on_off=Signal Invalid"), [0.4]),
        (("--faults",), [0.5]),
        (("--changes", "--messages", "B2V_ST2"), [0.0, 0.2, 0.3]),
        (("--from", "0.15", "--to", "0.35"), None),
    ],
)
def test_what_is_asked_for_is_shown(
    log: Path, capsys: Capture, arguments: tuple[str, ...], found: list[float] | None
) -> None:
    if found is None:
        assert run(["decode", str(log), *arguments]) == 0
        assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == [
            "0.200000",
            "0.300000",
        ]
    else:
        assert times(log, capsys, *arguments) == found


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--where", "soc"), "expected a condition such as soc<20"),
        (("--where", "sox<1"), "no message has a field 'sox'"),
        (("--where", "soc<low"), "expected a number, not 'low'"),
        (("--where", "B2V_ST9.soc<1"), "there is no message 'B2V_ST9'"),
        (("--nodes", "EMS"), "there is no node 'EMS' that sends; known: BMU, BSU, CHG, TMS, VCU"),
        (("--messages", "B2V_ST22"), "did you mean B2V_ST2"),
    ],
)
def test_what_cannot_be_asked_for_is_said(
    log: Path, capsys: Capture, arguments: tuple[str, ...], said: str
) -> None:
    assert run(["decode", str(log), *arguments]) == 2
    out, errors = capsys.readouterr()
    assert said in errors
    assert not out


def test_a_line_says_when_where_which_way_what_and_the_values(log: Path, capsys: Capture) -> None:
    assert run(["decode", str(log), "--messages", "B2V_ST2", "--to", "0"]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert line.split()[:8] == [
        *("0.000000", "shown", "Tx", "1882D0F3", "C8FFFFFFFFFFFFFF", "B2V_ST2", "soc=80", "%"),
    ]


def test_lines_are_no_longer_than_the_terminal_and_lose_nothing() -> None:
    values = [f"value_{number}={number} V" for number in range(40)]
    line = "  ".join(("         0.100000  0  Rx  1882D0F3", *values))
    folded = wrapped(line, 80)
    assert max(map(len, folded.splitlines())) <= 80
    assert folded.split() == line.split()
    assert wrapped(line, None) == line


def test_a_log_that_grows_is_followed(log: Path, tmp_path: Path) -> None:
    path = tmp_path / "grows.log"
    lines = log.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[:2]))
    command = [sys.executable, "-m", "swapcan", "decode", str(path), "--follow"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        first = [process.stdout.readline() for _ in range(2)]
        with path.open("a") as file:
            file.write("".join(lines[2:5]))
        more = [process.stdout.readline() for _ in range(3)]
        process.terminate()
    assert [line.split()[0] for line in first + more] == [
        f"{number / 10:.6f}" for number in range(5)
    ]
