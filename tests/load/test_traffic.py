"""What a bus carries in a scenario, by hand from annex A.1 and the sizes of a pack."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest

from dbcspec.cli import run
from dbcspec.config import find_config
from dbcspec.load.analysis import analyse
from dbcspec.load.traffic import Scenario, Size, frames_of
from dbcspec.project import load
from typedcan.model.protocol import Protocol

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def protocol() -> Protocol:
    return load(find_config(ROOT)).protocol


def transfer_frames(protocol: Protocol, name: str, size: Size) -> int:
    return frames_of(next(each for each in protocol.transfers if each.name == name), size)


def test_eighteen_cscs_of_twelve_cells_need_72_frames_of_three(protocol: Protocol) -> None:
    assert transfer_frames(protocol, "cell_voltages", Size(18, 216)) == 72


def test_what_does_not_divide_evenly_goes_to_the_first_groups(protocol: Protocol) -> None:
    # 3 CSCs of 5, 4 and 4 cells: 2 frames each.
    assert transfer_frames(protocol, "cell_voltages", Size(3, 13)) == 6
    # 2 CSCs of 7 and 6 probes, 6 a frame.
    assert transfer_frames(protocol, "probe_temperatures", Size(2, 13)) == 3


def test_a_vin_has_three_frames_whatever_the_pack(protocol: Protocol) -> None:
    assert transfer_frames(protocol, "vin", Size()) == 3


def test_the_load_is_the_sum_of_bits_over_periods(protocol: Protocol) -> None:
    # Charger bus: two messages of 8 bytes every 500 ms, 131 bits, 160 with the most stuff bits.
    charger = next(bus for bus in protocol.buses if bus.name == "charger")
    found = analyse(protocol, charger, Scenario())
    assert found.bare == Fraction(2 * 131 * 2, 250_000)
    assert found.stuffed == Fraction(2 * 160 * 2, 250_000)
    # Each waits at most for the other: 2 x 160 bits at 250 kbit/s are 1.28 ms.
    assert {each.response.worst for each in found.messages} == {Fraction(128, 100_000)}


def test_event_messages_count_only_with_an_interval(protocol: Protocol) -> None:
    vehicle = next(bus for bus in protocol.buses if bus.name == "vehicle")
    without = analyse(protocol, vehicle, Scenario())
    assert {each.name for each in without.silent} == {"B2V_RQ", "V2B_VIN", "V2B_RQData"}
    counted = analyse(protocol, vehicle, Scenario(event_interval=Fraction(1, 10)))
    assert not counted.silent
    # 1 + 3 + 1 frames more, ten times a second.
    assert counted.bare - without.bare == Fraction(5 * 131 * 10, 250_000)


def test_one_cell_more_than_fits_makes_a_message_late(protocol: Protocol) -> None:
    vehicle = next(bus for bus in protocol.buses if bus.name == "vehicle")

    def with_cells(items: int) -> Scenario:
        return Scenario(sizes={"cell_voltages": Size(18, items)})

    most = analyse(protocol, vehicle, with_cells(216)).fitting["cell_voltages"]
    assert not analyse(protocol, vehicle, with_cells(most)).late
    assert analyse(protocol, vehicle, with_cells(most + 1)).late


def test_the_command_says_by_its_status_whether_a_message_can_be_late(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    assert run(["load", "--groups", "18", "--items", "cell_voltages=216", "--json"]) == 0
    vehicle, charger = json.loads(capsys.readouterr().out)
    assert (vehicle["bus"], charger["bus"]) == ("vehicle", "charger")
    assert vehicle["in_time"]
    assert run(["load", "--bus", "vehicle", "--items", "cell_voltages=765"]) == 1
    assert "B2V_Ucell can be later than its period of 100 ms" in capsys.readouterr().out


def test_a_picture_has_a_bar_for_each_message(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    path = tmp_path / "load.svg"
    assert run(["load", "--bus", "charger", "--plot", str(path)]) == 0
    text = path.read_text("utf-8")
    assert "B2C_Charger" in text
    assert text.count("<rect x=") == 2


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--items", "cells=3"], "there is no transfer 'cells'; known: vin, pack_code,"),
        (["--bus", "body"], "there is no bus 'body'; known: vehicle, charger"),
    ],
)
def test_what_is_not_there_is_named_in_one_line(
    arguments: list[str],
    problem: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(ROOT)
    assert run(["load", *arguments]) == 2
    said = capsys.readouterr().err
    assert problem in said
    assert said.count("\n") == 1
