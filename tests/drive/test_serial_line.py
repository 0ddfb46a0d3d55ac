"""A pack behind python-can's slcan, on a serial line that loses characters."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable

import pytest
from drive.quick_pack import QuickPack, living
from drive.trouble import QUICK

from swapcan import cli
from swapcan.messages import HvCommand
from swapcan.scenarios import scenarios
from typedcan.drive import driving

if sys.platform == "win32":
    pytest.skip("Windows has no pseudo-terminals", allow_module_level=True)
pytest.importorskip("serial", reason="python-can's slcan needs pyserial")

from drive.serial_adapter import Adapter, adapter

YES = "--yes-drive-the-bus"


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 0.3)
    monkeypatch.setattr(driving, "LEAVING", 0.8)
    monkeypatch.setattr(scenarios, "SCENARIOS", {QUICK.name: QUICK})


def shortened(line: bytes, chance: random.Random) -> bytes:
    """A line that has lost some of its characters, be it the end of the line."""
    count = chance.choice((1, 1, 2, 5, 12, len(line) - 1))
    lost = set(chance.sample(range(len(line)), count))
    return bytes(byte for place, byte in enumerate(line) if place not in lost)


def garbled(line: bytes, chance: random.Random) -> bytes:
    """A line of which some characters have become others, no ASCII among them."""
    found = bytearray(line)
    for place in chance.sample(range(len(line) - 1), 4):
        found[place] = chance.randrange(256)
    return bytes(found)


def cut(line: bytes, _: random.Random) -> bytes:
    """A line that ends early: too early for python-can."""
    return line[:6] + b"\r"


def spoiling(
    there: Adapter, pack: QuickPack, damage: Callable[[bytes, random.Random], bytes], every: int
) -> None:
    """Damage each so many-th line from when the pack is closed."""
    chance = random.Random(1)
    count = 0

    def spoil(line: bytes) -> bytes:
        nonlocal count
        count += pack.is_closed or count > 0
        return damage(line, chance) if count and count % every == 0 else line

    there.bus.spoil = spoil


@pytest.mark.parametrize("damage", [cut, shortened])
def test_lines_that_lose_characters_now_and_then_do_not_end_it(
    damage: Callable[[bytes, random.Random], bytes], capsys: pytest.CaptureFixture[str]
) -> None:
    with adapter() as there:
        pack = QuickPack(there.bus)
        spoiling(there, pack, damage, every=5)
        with living(pack):
            status = cli.run(["conform", *there.options, "--active", QUICK.name, YES])
    assert status in (0, 1)  # a verdict
    assert HvCommand.HV_ON in pack.commands
    assert len(pack.since_on) >= 3
    assert set(pack.since_on) == {HvCommand.HV_OFF}
    errors = capsys.readouterr().err
    assert f"{QUICK.name}: the pack has reported that it is off" in errors


@pytest.mark.parametrize(
    ("command", "damage"),
    [
        (("conform", "--active", QUICK.name), cut),
        (("simulate", "VCU", "--plan", "hv_on@300ms", "--seconds", "1"), cut),
        # After bytes that are no ASCII python-can reads nothing more.
        (("simulate", "VCU", "--plan", "hv_on@300ms"), garbled),
    ],
)
def test_a_line_on_which_nothing_is_whole_any_more_leaves_the_pack_open_and_is_told(
    command: tuple[str, ...],
    damage: Callable[[bytes, random.Random], bytes],
    capsys: pytest.CaptureFixture[str],
) -> None:
    with adapter() as there:
        pack = QuickPack(there.bus)
        spoiling(there, pack, damage, every=1)
        with living(pack):
            status = cli.run([*command, YES, *there.options])
    assert status in ((1, 2) if command[0] == "conform" else (2,))
    assert HvCommand.HV_ON in pack.commands
    assert len(pack.since_on) >= 3
    assert set(pack.since_on) == {HvCommand.HV_OFF}
    assert not pack.is_closed
    assert "TAKE IT FOR LIVE, switch it off by other means" in capsys.readouterr().err
