"""`swapcan simulate`: what it prints, how it ends, and what it refuses before it opens a bus."""

from __future__ import annotations

import json
import signal
import sys

import can
import pytest
from commands.running import as_arguments, bus_options, started

from swapcan import Link, cli
from swapcan.messages import B2V_ST1, V2B_CMD, B2C_Charger, C2B_ACStatus, HvCommand
from swapcan.nodes.faults import FAULTS

COMMAND = ("-m", "swapcan", "simulate")
YES = "--yes-drive-the-bus"


def run(*arguments: str) -> tuple[int, str, str]:
    """Exit status, stdout and stderr of the command."""
    with started(*COMMAND, *arguments) as process:
        out, errors = process.communicate(timeout=30)
        return process.returncode, out, errors


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["BMU", "BMS"], "there is no node 'BMS'; known: BMU, VCU, CHG, TMS, BSU"),
        (["BMU", "bmu"], "BMU is named twice"),
        (
            ["BMU", "--fault", "overheat@3s"],
            "there is no fault 'overheat'; known: lost_frame, ",
        ),
        (
            ["BMU", "--fault", "over_temperature@soon"],
            "expected a time such as 30s, 500ms or 2min, not 'soon'",
        ),
        (
            ["VCU", "--fault", "over_temperature@3s"],
            "over_temperature@3s: it is for BMU, which is not simulated",
        ),
        (
            ["VCU", "--fault", "BMU.lost_frame@3s"],
            "BMU.lost_frame@3s: it is for BMU, which is not simulated",
        ),
        (["BMU", "--plan", "hv_on@1s"], "hv_on@1s: it is for VCU, which is not simulated"),
        (["BMU", "--plan", "fly@1s"], "there is no step 'fly'; known: "),
        (["BMU", "--seconds", "0"], "expected a positive number of seconds"),
    ],
)
def test_what_cannot_be_is_one_line_and_status_2_before_a_bus_is_opened(
    arguments: list[str], problem: str, capsys: pytest.CaptureFixture[str]
) -> None:
    bus = ("-i", "udp_multicast", "-c", "no address at all")
    assert cli.run(["simulate", *arguments, *bus]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith("swapcan: ")
    assert problem in said.err
    assert said.err.count("\n") == 1


def test_a_bus_that_cannot_be_opened_is_one_line_and_status_2(
    capsys: pytest.CaptureFixture[str],
) -> None:
    bus = ("-i", "udp_multicast", "-c", "no address at all")
    assert cli.run(["simulate", "TMS", *bus]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith("swapcan: cannot open the bus: ")
    assert said.err.count("\n") == 1


def test_list_faults_shows_every_fault_and_needs_no_bus(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert cli.run(["simulate", "--list-faults"]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    lines = said.out.splitlines()[2:]
    assert [line.split()[0] for line in lines] == list(FAULTS)
    assert all(line.endswith(FAULTS[line.split()[0]].text) for line in lines)


def test_all_five_talk_on_one_bus_and_it_ends_after_its_seconds() -> None:
    options = bus_options("udp_multicast")
    plan = ("--seconds", "3", "--plan", "hv_on@100ms")
    status, out, errors = run(*as_arguments(options), *plan, YES)
    assert status == 0
    look_out, first, last = errors.splitlines()
    assert look_out == "swapcan: looking for others who send what is to be sent, for 2 s"
    assert first.startswith("swapcan: simulating BMU, VCU, CHG, TMS, BSU on ")
    assert last.startswith("swapcan: simulated BMU, VCU, CHG, TMS, BSU for 3.0 s: frames sent ")
    assert last.endswith(", from others 0, faults 0 (length 0, checksum 0, counter 0)")
    sent = int(last.split("frames sent ")[1].split(",")[0])
    assert sent > 3 * 150
    lines = out.splitlines()
    for line in lines:
        time, node, text = line.split(maxsplit=2)
        assert 0 <= float(time) < 3.1
        assert node in ("BMU", "VCU", "CHG", "TMS", "BSU")
        assert text
    said = [line.split(maxsplit=1)[1] for line in lines]
    for expected in (
        "VCU  off",
        "VCU  contactors closed",
        "VCU  high voltage commanded",
        "VCU  ready",
        "BSU  locked",
        "CHG  connected",
    ):
        assert expected in said


def test_faults_and_what_is_noticed_of_them_are_lines_of_json() -> None:
    options = bus_options("udp_multicast")
    status, out, _ = run(
        *("BMU", "VCU", "--json", "--plan", "", "--seconds", "3", *as_arguments(options), YES),
        *("--fault", "VCU.bus_silence@1s+1s", "--fault", "B2V_ST1.stuck_counter@0.5s+1s"),
    )
    assert status == 0
    lines = [json.loads(line) for line in out.splitlines()]
    assert all({"time", "node", "kind", "text"} <= set(line) for line in lines)
    said = iter((line["node"], line["kind"], line["text"]) for line in lines)
    for expected in (  # a busy machine may be late in between
        ("VCU", "fault", "bus_silence begins"),
        ("BMU", "supervision", "V2B_CMD: alive -> late"),
        ("BMU", "supervision", "V2B_CMD: late -> lost"),
        ("VCU", "fault", "bus_silence ends"),
        ("BMU", "frame", "V2B_CMD: counter goes from "),
        ("BMU", "supervision", "V2B_CMD: lost -> alive"),
    ):
        assert any(
            (node, kind) == expected[:2] and text.startswith(expected[2])
            for node, kind, text in said
        ), expected
    stuck = [line for line in lines if line.get("message") == "B2V_ST1" and line["kind"] == "frame"]
    assert stuck[0]["node"] == "VCU"
    assert stuck[0]["text"].startswith("B2V_ST1: counter stays at ")
    # The same fault, frame after frame, is said no more than once a second.
    assert len([line for line in stuck if "stays" in line["text"]]) <= 3


def test_others_on_the_bus_are_heard_and_answered() -> None:
    options = bus_options("udp_multicast")
    with (
        can.Bus(ignore_config=True, **options) as bus,
        started(*COMMAND, "BMU", *as_arguments(options), YES) as process,
    ):
        assert process.stdout
        link = Link(bus)
        states = set()
        for _ in range(2000):
            message = link.receive(timeout=5.0).message
            if isinstance(message, B2V_ST1):
                states.add(message.bms)
                link.send(V2B_CMD(hv_on_off=HvCommand.HV_ON, vehicle_speed=0.0))
            if len(states) == 3:
                break
        assert len(states) == 3  # open, precharge, closed


def test_pack_and_charger_can_talk_on_a_bus_of_their_own() -> None:
    vehicle = bus_options("udp_multicast")
    other = bus_options("udp_multicast")  # has another port
    with (
        can.Bus(ignore_config=True, **vehicle) as one,
        can.Bus(ignore_config=True, **other) as two,
        started(
            *(*COMMAND, "BMU", "CHG", *as_arguments(vehicle), YES),
            *("--charger-bus", f"port={other['port']}"),
        ) as process,
    ):
        assert process.stderr
        assert "looking for others" in process.stderr.readline()
        assert "simulating" in process.stderr.readline()
        link = Link(two)
        heard = {type(link.receive(timeout=5.0).message) for _ in range(4)}
        assert heard == {B2C_Charger, C2B_ACStatus}
        on_vehicle = {frame.arbitration_id for _ in range(300) if (frame := one.recv(1.0))}
    assert B2V_ST1.FRAME_ID in on_vehicle
    assert not on_vehicle & {B2C_Charger.FRAME_ID, C2B_ACStatus.FRAME_ID}


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT for one process")
def test_ctrl_c_ends_it_with_its_summary_and_no_traceback() -> None:
    options = bus_options("udp_multicast")
    with started(*COMMAND, "TMS", *as_arguments(options)) as process:
        assert process.stdout
        assert process.stdout.readline().split() == ["0.000", "TMS", "Off"]
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=10)
    assert process.returncode == 130
    first, last = errors.splitlines()
    assert first.startswith("swapcan: simulating TMS on ")
    assert last.startswith("swapcan: simulated TMS for ")


def test_it_ends_in_one_line_when_its_reader_goes_away() -> None:
    options = bus_options("udp_multicast")
    with started(*COMMAND, "CHG", *as_arguments(options)) as process:
        assert process.stdout
        assert process.stderr
        process.stdout.readline()
        process.stdout.close()
        assert process.wait(timeout=10) == 2  # at the next line: it does not hear the BMU
        last = process.stderr.read().splitlines()[-1]
        assert last == "swapcan: nobody reads the output any more"
