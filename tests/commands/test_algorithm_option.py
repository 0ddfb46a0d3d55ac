"""Every command that encodes or decodes takes an algorithm of the user's by its name."""

from __future__ import annotations

import json
from pathlib import Path

import can
import pyarrow.parquet as pq
import pytest

from swapcan.cli import run
from swapcan.messages import BMS_TMS_0, HvRequest

Capture = pytest.CaptureFixture[str]

OURS = "BMS_CRC=commands.crc_of_ours:inverted_sum"
MESSAGE = bytes.fromhex("00ffff00000000")


def sealed(data: bytes, wrong: int = 0) -> bytes:
    return data + bytes([~sum(data) & 0xFF ^ wrong])


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """Four frames of the message whose checksum the standard leaves open; the third is spoilt."""
    path = tmp_path / "drive.log"
    lines = []
    for count in range(4):
        data = sealed(MESSAGE[:6] + bytes([count]), wrong=count == 2)
        lines.append(f"({count}.0) can0 {BMS_TMS_0.FRAME_ID:08X}#{data.hex()}")
    path.write_text("\n".join(lines) + "\n", "ascii")
    return path


@pytest.mark.parametrize("function", ["inverted_sum", "closure"])
def test_decode_refuses_what_the_function_does_not_make(
    function: str, log: Path, capsys: Capture
) -> None:
    assert run(["decode", str(log)]) == 0
    assert "decoded 4" in capsys.readouterr().err  # nothing verifies it
    option = f"BMS_CRC=commands.crc_of_ours:{function}"
    assert run(["decode", str(log), "--algorithm", option]) == 0
    out, errors = capsys.readouterr()
    assert "decoded 3" in errors
    assert "faults 2 (length 0, checksum 1, counter 1)" in errors
    assert "! checksum is 0xFE, the bytes make 0xFF" in out


@pytest.mark.parametrize("function", ["inverted_sum", "closure"])
def test_convert_counts_it_in_one_process_and_in_several(
    function: str, log: Path, tmp_path: Path, capsys: Capture
) -> None:
    option = f"BMS_CRC=commands.crc_of_ours:{function}"
    second = log.with_name("second.log")
    with can.LogReader(log) as frames, can.Logger(second) as logger:
        for frame in frames:
            frame.timestamp += 1000
            logger.on_message_received(frame)
    for logs, jobs in (([log], "1"), ([log, second], "2")):
        output = tmp_path / f"{function}-{jobs}.parquet"
        names = [str(each) for each in logs]
        given = ["--messages", "BMS_TMS_0", "--algorithm", option, "--jobs", jobs]
        assert run(["convert", *names, *given, "-o", str(output)]) == 0
        assert f"wrong checksum: BMS_TMS_0 {len(logs)}" in capsys.readouterr().err
        assert pq.read_table(output).num_rows == 3 * len(logs)


def test_plot_leaves_it_out(log: Path, tmp_path: Path, capsys: Capture) -> None:
    output = tmp_path / "life.html"
    given = ["--signals", "BMS_TMS_0.BMS_Life", "-o", str(output), "--algorithm", OURS]
    assert run(["plot", str(log), *given]) == 0
    assert "1 frame with a wrong length or checksum left out" in capsys.readouterr().err


def test_conform_judges_it(log: Path, capsys: Capture) -> None:
    assert run(["conform", str(log), "--judge", "BMU", "--only", "checksum", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)
    # The standard leaves the algorithm open, so that a wrong one is no broken demand.
    given = ["--judge", "BMU", "--only", "checksum", "--algorithm", OURS, "--strict"]
    assert run(["conform", str(log), *given]) == 1
    assert "checksum 0xFE, the bytes make 0xFF" in capsys.readouterr().out


def test_send_fills_it_in(channel: str, far: can.BusABC, capsys: Capture) -> None:
    bus = ["-i", "virtual", "-c", channel]
    words = ["BMS_TMS_0", f"reqst_tms_hv_on={HvRequest.REQUEST_HV_OFF.value}"]
    for given, factor, offset in (([], 0, 0), ([OURS], -1, -1), (["BMS_CRC=sum"], 1, 0)):
        options = [word for each in given for word in ("--algorithm", each)]
        assert run(["send", *words, *options, *bus]) == 0
        frame = far.recv(1.0)
        assert frame
        assert frame.data[7] == factor * sum(frame.data[:7]) + offset & 0xFF
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("command", [["listen"], ["monitor", "--plain"]])
def test_listen_and_monitor_verify_it(
    command: list[str], channel: str, far: can.BusABC, capsys: Capture
) -> None:
    spoilt = can.Message(arbitration_id=BMS_TMS_0.FRAME_ID, data=sealed(MESSAGE, wrong=1))
    bus = ["-i", "virtual", "-c", channel, "--seconds", "0.3"]
    far.send_periodic(spoilt, 0.02)  # until the bus is shut down
    assert run([*command, *bus, "--algorithm", OURS]) == 0
    verified = capsys.readouterr()
    assert run([*command, *bus]) == 0
    assert "checksum is 0x00, the bytes make 0x01" in verified.out
    assert "checksum is" not in capsys.readouterr().out


def test_simulated_nodes_send_it(channel: str, far: can.BusABC) -> None:
    bus = ["-i", "virtual", "-c", channel, "--seconds", "0.4", "--algorithm", OURS]
    assert run(["simulate", "BMU", "TMS", *bus]) == 0
    found = []
    while frame := far.recv(0):
        if frame.arbitration_id == BMS_TMS_0.FRAME_ID:
            found.append(frame.data[7] == ~sum(frame.data[:7]) & 0xFF)
    assert found
    assert all(found)


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ("BMS_CRC", "--algorithm 'BMS_CRC': expected NAME=MODULE:FUNCTION or NAME=ALGORITHM"),
        ("=sum", "--algorithm '=sum': expected NAME=MODULE:FUNCTION or NAME=ALGORITHM"),
        (
            "BMS_CRC=no_such:crc",
            "--algorithm BMS_CRC: no_such cannot be imported: ModuleNotFoundError: No",
        ),
        ("BMS_CRC=commands.crc_of_ours:crc", "commands.crc_of_ours has no crc"),
        ("BMS_CRC=commands.crc_of_ours:no_function", "crc_of_ours:no_function is no function"),
        ("BMS_CRC=not a name:crc", "'not a name:crc' is no MODULE:FUNCTION"),
        ("BMS_CRC=commands.crc_of_ours:", "'commands.crc_of_ours:' is no MODULE:FUNCTION"),
        ("BMS_CRC=crc_of_nobody", "nothing here computes 'crc_of_nobody'"),
        ("BMS_CRC=CRC-16/ARC", "BMS_CRC makes 16 bits, its signal has 8"),
        ("BMX_CRC=sum", "no message has the algorithm 'BMX_CRC'; known: xor, BMS_CRC"),
        ("BMS_CRC=commands.crc_of_ours:too_wide", "BMS_CRC made 263, its signal has 8 bits"),
        ("BMS_CRC=commands.crc_of_ours:failing", "BMS_CRC raised LookupError: no table for 7"),
    ],
)
@pytest.mark.parametrize("command", ["decode", "convert", "plot", "conform", "send"])
def test_what_makes_no_checksum_is_one_line(
    command: str, given: str, problem: str, log: Path, tmp_path: Path, capsys: Capture
) -> None:
    words = {
        "decode": [str(log)],
        "convert": [str(log), "-o", str(tmp_path / "all")],
        "plot": [str(log), "--signals", "BMS_Life", "-o", str(tmp_path / "life.html")],
        "conform": [str(log), "--judge", "BMU"],
        "send": ["BMS_TMS_0", "reqst_tms_hv_on=0", "-i", "virtual", "-c", "nobody"],
    }
    assert run([command, *words[command], "--algorithm", given]) == 2
    out, errors = capsys.readouterr()
    assert out == ""
    assert problem in errors
    assert errors.count("\n") == 1
    assert [each.name for each in tmp_path.iterdir()] == ["drive.log"]


def test_simulate_and_listen_refuse_it_before_a_bus_is_opened(capsys: Capture) -> None:
    for command in (["simulate", "BMU"], ["listen"], ["monitor", "--plain"]):
        bus = ["-i", "virtual", "-c", "nobody", "--seconds", "0.1"]
        assert run([*command, *bus, "--algorithm", "BMX_CRC=sum"]) == 2
        assert "no message has the algorithm 'BMX_CRC'" in capsys.readouterr().err


def test_an_algorithm_is_given_once(log: Path, capsys: Capture) -> None:
    twice = ["--algorithm", "BMS_CRC=sum", "--algorithm", "BMS_CRC=xor"]
    assert run(["decode", str(log), *twice]) == 2
    assert capsys.readouterr().err == "swapcan: --algorithm BMS_CRC: given twice\n"


def test_a_module_is_found_in_the_folder_that_the_command_runs_in(
    log: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    (log.parent / "crc_beside_the_log.py").write_text("class Crc:\n    eight = ord\n", "ascii")
    monkeypatch.chdir(log.parent)
    monkeypatch.setattr("sys.path", [each for each in __import__("sys").path if each])
    assert run(["decode", "drive.log", "--algorithm", "BMS_CRC=crc_beside_the_log:Crc.eight"]) == 2
    assert "the algorithm BMS_CRC raised TypeError: ord()" in capsys.readouterr().err
