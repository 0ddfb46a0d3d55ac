"""Nothing that acts is sent on a real bus that nobody has agreed to drive."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import can
import pytest
from commands.running import as_arguments, bus_options

from swapcan import cli
from typedcan.drive import driving

ON = ("send", "V2B_CMD", "hv_on_off=HV On")
TRUCK = ("simulate", "VCU", "--seconds", "0.1", "--plan", "")
YES = "--yes-drive-the-bus"

Capture = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def _nothing_configured(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("CAN_INTERFACE", "CAN_CHANNEL", "CAN_BITRATE", "CAN_CONFIG"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setattr(driving, "LOOK_OUT", 0.1)


def refuse(*_: Any, **__: Any) -> can.BusABC:
    """What no command may call."""
    raise AssertionError("a bus was opened")


def asks(*arguments: str, capsys: Capture) -> bool:
    """Whether a command wants consent; else it does its work."""
    status = cli.run(arguments)
    errors = capsys.readouterr().err
    if status == 0:
        return False
    assert status == 2
    assert YES in errors
    assert errors.count("\n") == 1
    assert len(errors) < 120
    return True


@pytest.mark.parametrize("command", [ON, TRUCK], ids=["send", "simulate"])
@pytest.mark.parametrize(
    "bus",
    [
        ("-i", "udp_multicast", "-c", "239.74.163.2"),
        ("-i", "socketcan", "-c", "vcan0"),
        ("-i", "slcan", "-c", "/dev/ttyACM0"),
        ("-i", "pcan"),
        ("--bus-kwargs", "interface=socketcan", "channel=can0"),
        ("--bus-kwargs", "bustype=socketcan", "channel=can0"),
        ("-c", "can0"),  # no interface is named at all
    ],
    ids=" ".join,
)
def test_every_interface_but_the_virtual_one_wants_a_yes_before_it_is_opened(
    command: tuple[str, ...],
    bus: tuple[str, ...],
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.setattr(can, "Bus", refuse)
    assert asks(*command, *bus, capsys=capsys)


@pytest.mark.parametrize("command", [ON, TRUCK], ids=["send", "simulate"])
def test_the_virtual_interface_wants_none_wherever_its_name_comes_from(
    command: tuple[str, ...], channel: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    assert not asks(*command, "-i", "virtual", "-c", channel, capsys=capsys)
    given = ("--bus-kwargs", "interface=virtual", f"channel={channel}")
    assert not asks(*command, *given, capsys=capsys)
    monkeypatch.setenv("CAN_INTERFACE", "virtual")
    assert not asks(*command, "-c", channel, capsys=capsys)
    monkeypatch.setattr(can, "Bus", refuse)
    assert asks(*command, "-i", "socketcan", "-c", channel, capsys=capsys)


@pytest.mark.parametrize("command", [ON, TRUCK], ids=["send", "simulate"])
def test_a_section_of_pythoncans_configuration_decides_as_it_does_for_the_bus(
    command: tuple[str, ...],
    channel: str,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: Capture,
) -> None:
    text = "[default]\ninterface = {}\n[bench]\ninterface = {}\n"
    section = ("-c", channel, "--bus-kwargs", "config_context=bench")
    # pathlib and os.path take the home folder from different places on different systems.
    monkeypatch.setattr(can.util, "CONFIG_FILES", [str(tmp_path / "can.conf")])
    (tmp_path / "can.conf").write_text(text.format("socketcan", "virtual"), "ascii")
    assert not asks(*command, *section, capsys=capsys)
    (tmp_path / "can.conf").write_text(text.format("virtual", "socketcan"), "ascii")
    monkeypatch.setattr(can, "Bus", refuse)
    assert asks(*command, *section, capsys=capsys)


@pytest.mark.parametrize("command", [ON, TRUCK], ids=["send", "simulate"])
def test_a_bus_that_turns_out_not_to_be_virtual_is_closed_again(
    command: tuple[str, ...], channel: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    opened: list[Other] = []

    class Other(can.BusABC):
        def __init__(self, **_: Any) -> None:
            super().__init__(channel="other")
            self.is_closed = False
            opened.append(self)

        def send(self, msg: can.Message, timeout: float | None = None) -> None:
            raise AssertionError("something was sent")

        def shutdown(self) -> None:
            self.is_closed = True
            super().shutdown()

    monkeypatch.setattr(can, "Bus", Other)
    assert cli.run([*command, "-i", "virtual", "-c", channel]) == 2
    assert capsys.readouterr().err == "swapcan: the bus is not virtual: name it with --interface\n"
    assert [each.is_closed for each in opened] == [True]


def test_a_charger_bus_that_is_real_wants_a_yes_too(
    channel: str, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    vehicle = ("-i", "virtual", "-c", channel)
    pack = ("simulate", "BMU", "--seconds", "0.1", *vehicle)
    assert not asks(*pack, "--charger-bus", f"channel={channel}-2", capsys=capsys)
    monkeypatch.setattr(can, "Bus", refuse)
    assert asks(*pack, "--charger-bus", "interface=socketcan", "channel=can1", capsys=capsys)


LEFT_OUT = "would make others act: left out without --yes-drive-the-bus"
NOBODY = "would make others act: not simulated without --yes-drive-the-bus"
VCU, BMU = "VCU (V2B_CMD)", "BMU (B2C_Charger, BMS_TMS_0)"


@pytest.mark.parametrize(
    ("nodes", "first", "simulated"),
    [
        ((), f"{BMU} and {VCU} {LEFT_OUT}", "CHG, TMS, BSU"),
        (("VCU",), f"{VCU} {NOBODY}", ""),
        (("BMU",), f"{BMU} {NOBODY}", ""),
        (("BMU", "VCU"), f"{BMU} and {VCU} {NOBODY}", ""),
        (("BMU", "CHG"), f"{BMU} {LEFT_OUT}", "CHG"),
        (("CHG", "TMS", "BSU"), "", "CHG, TMS, BSU"),
    ],
)
def test_without_a_yes_the_rest_is_simulated_and_with_it_all(
    nodes: tuple[str, ...], first: str, simulated: str, capsys: Capture
) -> None:
    bus = as_arguments(bus_options("udp_multicast"))
    command = ("simulate", *nodes, "--seconds", "0.2", *bus)
    assert cli.run(command) == (0 if simulated else 2)
    lines = capsys.readouterr().err.splitlines()
    if first:
        assert lines.pop(0) == f"swapcan: {first}"
    if simulated:
        begin, end = lines
        assert begin.startswith(f"swapcan: simulating {simulated} on ")
        assert end.startswith(f"swapcan: simulated {simulated} for ")
    else:
        assert lines == []
    assert cli.run([*command, YES]) == 0
    lines = capsys.readouterr().err.splitlines()
    everybody = ", ".join(nodes) or "BMU, VCU, CHG, TMS, BSU"
    looks_out = bool(first)
    assert any("looking for others" in line for line in lines) is looks_out
    assert any(line.startswith(f"swapcan: simulating {everybody} on ") for line in lines)


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (("--plan", "hv_on@1s"), "hv_on@1s: it is for VCU, which is not simulated"),
        (
            ("--fault", "over_temperature@1s"),
            "over_temperature@1s: it is for BMU, which is not simulated",
        ),
        (
            ("--fault", "VCU.lost_frame@1s"),
            "VCU.lost_frame@1s: it is for VCU, which is not simulated",
        ),
    ],
)
def test_what_is_asked_of_a_node_that_is_left_out_is_one_line_that_says_how(
    arguments: tuple[str, ...],
    problem: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Capture,
) -> None:
    monkeypatch.setattr(can, "Bus", refuse)
    assert cli.run(["simulate", "-i", "socketcan", "-c", "can0", *arguments]) == 2
    assert capsys.readouterr().err == f"swapcan: {problem} without {YES}\n"


def test_plan_and_faults_of_the_others_are_as_they_were(capsys: Capture) -> None:
    bus = as_arguments(bus_options("udp_multicast"))
    plan = ("--plan", "unlock@0s", "--fault", "TMS.lost_frame@0s")
    assert cli.run(["simulate", "--seconds", "0.2", *plan, *bus]) == 0
    assert "lost_frame begins" in capsys.readouterr().out


@pytest.mark.parametrize(
    "message",
    [
        ("V2B_CMD", "hv_on_off=1"),
        ("V2B_CMD", "hv_acc_on_off=1"),
        ("V2B_CMD", "heat_on_off=Heat On"),
        ("B2C_Charger", "charge_control=Start to charge"),
        ("B2C_Charger", "charge_control=0"),
        ("BMS_TMS_0", "reqst_tms_hv_on=0"),
        ("BMS_TMS_0", "reqst_tms_hv_on=1", "reqst_set_tms_sts=Heating"),
    ],
    ids=" ".join,
)
def test_whatever_acts_is_sent_with_a_yes_only(
    message: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(can, "Bus", refuse)
    assert asks("send", *message, "-i", "socketcan", "-c", "can0", capsys=capsys)


@pytest.mark.parametrize(
    "message",
    [
        ("V2B_CMD", "hv_on_off=HV Off"),
        ("V2B_CMD",),
        ("V2B_CMD", "hv_on_off=3"),
        ("B2C_Charger", "charge_control=1"),
        ("B2V_ST1", "bms=HV closed"),
        ("B2V_RQ",),
    ],
    ids=" ".join,
)
def test_what_does_not_act_is_sent_at_once(message: tuple[str, ...], capsys: Capture) -> None:
    bus = as_arguments(bus_options("udp_multicast"))
    assert cli.run(["send", *message, *bus]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert said.out.count("\n") == 1


@pytest.mark.parametrize(
    "message", [("B2C_Charger", "voltage_set=700", "current_set=50"), ("BMS_TMS_0",)], ids=" ".join
)
def test_what_would_act_by_omission_is_not_sent_with_a_yes_either(
    message: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.setattr(can, "Bus", refuse)
    assert cli.run(["send", *message, YES, "-i", "socketcan", "-c", "can0"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.parametrize("command", ["conform", "simulate", "send"])
def test_help_and_readme_say_what_no_program_can_do_and_what_follows(
    command: str, capsys: Capture, root: Path
) -> None:
    assert cli.run([command, "--help"]) == 0
    helped = " ".join(capsys.readouterr().out.split())
    readme = " ".join((root / "README.md").read_text("utf-8").split())
    for text in (helped, readme):
        assert YES in text
        assert "own timeout, which the " in text  # the draft does not give it
        assert "at speed opens contactors under load" in text
        if command != "send":  # ends nothing
            for word in ("SIGKILL", "crash", "power", "freez" if text is readme else "frozen"):
                assert word in text
