"""Nobody is talked over: who sends the same is looked for before, and noticed later."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import can
import pytest
from commands.running import as_arguments, bus_options
from drive.quick_pack import QuickPack, living
from drive.trouble import EXCEPTIONS, Progress, Trouble, play
from scenarios.rig import bench

from swapcan import Message, cli, encode
from swapcan.messages import (
    B2V_ST0,
    V2B_CMD,
    V2B_VIN,
    B2C_Charger,
    ChargeControl,
    HvCommand,
    V2B_RQData,
)
from swapcan.scenarios.stage import Left
from typedcan.drive import driving

YES = "--yes-drive-the-bus"
OFF = V2B_CMD(hv_on_off=HvCommand.HV_OFF, vehicle_speed=0.0)
STOP = B2C_Charger(charge_control=ChargeControl.NORMAL_STOP_TO_CHARGE)

Capture = pytest.CaptureFixture[str]


@pytest.fixture(autouse=True)
def _short_look_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 0.4)


class Network:
    """A bus that processes share, and its options at the command line."""

    def __init__(self) -> None:
        self._options = bus_options("udp_multicast")
        self.arguments = as_arguments(self._options)

    def bus(self) -> can.BusABC:
        """One more access to it."""
        return can.Bus(ignore_config=True, **self._options)


def frame(message: Message, counter: int = 0) -> can.Message:
    given = counter if type(message).COUNTER else None
    return can.Message(arbitration_id=message.FRAME_ID, data=encode(message, counter=given))


@contextmanager
def talking(bus: can.BusABC, message: Message, begins: Callable[[], bool]) -> Iterator[None]:
    """Somebody sends a message all the time, once it is time."""
    stopping = threading.Event()

    def talk() -> None:
        counter = 0
        while not stopping.wait(0.02):
            if begins():
                bus.send(frame(message, counter))
                counter = (counter + 1) % 15

    thread = threading.Thread(target=talk)
    thread.start()
    try:
        yield
    finally:
        stopping.set()
        thread.join()


@pytest.mark.parametrize(
    ("command", "others"),
    [
        (("simulate", "VCU"), OFF),
        (("simulate",), V2B_RQData()),
        (("simulate", "VCU"), V2B_VIN()),
        (("simulate", "BMU"), B2V_ST0()),
        (("simulate", "BMU", "CHG"), STOP),
        (("send", "V2B_CMD", "hv_on_off=HV On"), OFF),
        (("send", "B2C_Charger", "charge_control=0"), STOP),
        (("conform", "--active", "hv-on-off"), V2B_RQData()),
    ],
    ids=lambda each: " ".join(each) if isinstance(each, tuple) else each.NAME,
)
def test_beside_somebody_who_sends_the_same_nothing_is_sent(
    command: tuple[str, ...], others: Message, capsys: Capture
) -> None:
    network = Network()
    with network.bus() as bus, network.bus() as listener:
        with talking(bus, others, lambda: True):
            assert cli.run([*command, YES, *network.arguments]) == 2
        heard = set()
        while arrived := listener.recv(0):
            heard.add(arrived.arbitration_id)
    assert heard == {others.FRAME_ID}
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.splitlines()[-1] == (
        f"swapcan: another {others.SENDER} is on the bus: {others.NAME}"
        f" (0x{others.FRAME_ID:08X}) comes from somebody else; nothing is sent beside it"
    )


@pytest.mark.parametrize(
    "command", [("simulate", "VCU", "--plan", "hv_on@0.2s"), ("conform", "--active", "hv-on-off")]
)
def test_another_truck_that_comes_when_the_pack_is_live_ends_it(
    command: tuple[str, ...], capsys: Capture
) -> None:
    network = Network()
    with network.bus() as bus, network.bus() as other:
        pack = QuickPack(bus)
        with living(pack), talking(other, V2B_RQData(), lambda: HvCommand.HV_ON in pack.commands):
            assert cli.run([*command, YES, *network.arguments]) == 2
            pack.wait_for(lambda: len(pack.since_on) >= 3)
        assert not pack.is_closed
        assert set(pack.since_on) == {HvCommand.HV_OFF}
    errors = capsys.readouterr().err.splitlines()
    assert errors[-1].startswith("swapcan: another VCU is on the bus: V2B_RQData (0x")
    assert not any("TAKE IT FOR LIVE" in line for line in errors)


@pytest.mark.parametrize("error", EXCEPTIONS[::4])
def test_a_bus_that_raises_once_while_it_is_only_heard_does_not_end_it(
    error: Callable[[], Exception],
) -> None:
    with bench() as rig:
        progress = Progress(rig)
        trouble = Trouble(error, lambda _: rig.clock.now() > 0.1, for_good=False)
        stage, raised = play(rig, trouble, "recv")
        assert trouble.raised
        assert raised is None
        assert stage.left is Left.SAFE
        progress.look()
        assert HvCommand.HV_ON in progress.commands


@pytest.mark.parametrize("error", EXCEPTIONS[1::4])
@pytest.mark.parametrize("place", ["recv", "watch", "is_over"])
def test_what_fails_for_good_before_anything_was_sent_leaves_the_bus_untouched(
    error: Callable[[], Exception], place: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(driving, "LOOK_OUT", 2.0)
    with bench() as rig:
        trouble = Trouble(error, lambda _: rig.clock.now() > 0.5, for_good=True)
        stage, raised = play(rig, trouble, place)
        assert type(raised) is type(error())
        assert rig.clock.now() < 1.7
        assert stage.left is Left.UNTOUCHED
        assert Progress(rig).look() is None


def test_a_bus_that_works_again_within_a_second_has_not_failed_for_good() -> None:
    with bench() as rig:
        trouble = Trouble(
            lambda: OSError("gone"), lambda _: rig.clock.now() % 2.0 < 0.8, for_good=False
        )

        def again(*given: object) -> None:
            trouble.raised = 0
            trouble(*given)

        stage, raised = play(rig, again, "recv")  # type: ignore[arg-type]
        assert raised is None
        assert stage.left is Left.SAFE
