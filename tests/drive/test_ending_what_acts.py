"""What a bus knows of what acts on it, and how it is ended, whatever else is going on."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import can
import pytest
from node.rough_bus import HEAT_LEFT
from scenarios.lines import values

from swapcan import encode
from swapcan.messages import (
    BMS_TMS_0,
    V2B_CMD,
    AccessoryHvCommand,
    B2C_Charger,
    ChargeControl,
    HeatCommand,
    HvCommand,
    HvRequest,
    ThermalMode,
)
from swapcan.wire import Codec
from typedcan.drive.noting_bus import EndedError, NotingBus
from typedcan.node.clock import SimulatedClock
from typedcan.wire.message import Message


class Wire(can.BusABC):
    """Keeps what is sent; ``before`` may raise."""

    def __init__(self) -> None:
        self.frames: list[can.Message] = []
        self.timeouts: list[float | None] = []
        self.before: Callable[[can.Message], object] = lambda _: None
        super().__init__(channel="wire")

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        self.timeouts.append(timeout)
        self.before(msg)
        self.frames.append(msg)

    @property
    def last(self) -> dict[str, object]:
        """The signals of the last frame."""
        return values(self.frames[-1])


Both = tuple[Wire, NotingBus]


@pytest.fixture
def both() -> Iterator[Both]:
    """A wire, and the bus that notes."""
    with Wire() as wire, NotingBus(wire, Codec(), lambda _: None, clock=SimulatedClock()) as bus:
        yield wire, bus


def frame(message: Message, counter: int | None = None) -> can.Message:
    return can.Message(arbitration_id=message.FRAME_ID, data=encode(message, counter=counter))


ON = V2B_CMD(
    hv_on_off=HvCommand.HV_ON,
    hv_acc_on_off=AccessoryHvCommand.HV_ACC_ON,
    heat_on_off=HeatCommand.HEAT_ON,
    vehicle_speed=42.0,
)
OFF = V2B_CMD(hv_on_off=HvCommand.HV_OFF, vehicle_speed=42.0)
CHARGE = B2C_Charger(
    voltage_set=700.0, current_set=50.0, charge_control=ChargeControl.START_TO_CHARGE
)
COOL = BMS_TMS_0(
    reqst_set_tms_sts=ThermalMode.COOLING, reqst_tms_hv_on=HvRequest.REQUEST_HV_ON, volt=700.0
)


def test_the_safe_codes_take_the_place_of_those_that_act_and_the_rest_stays(both: Both) -> None:
    wire, bus = both
    bus.send(frame(ON, 13))
    assert [message.NAME for message in bus.acting] == ["V2B_CMD"]
    bus.send_safe_codes()
    assert bus.acting == ()
    named = {name.removeprefix("V2B_CMD_"): value for name, value in wire.last.items()}
    assert (named["HV_OnOff"], named["HV_ACC_OnOff"], named["Heat_OnOff"]) == (2, 2, HEAT_LEFT)
    assert named["VehicleSpeed"] == 42.0
    bus.send_safe_codes()
    assert wire.timeouts[1:] == [0, 0]  # a full queue is not waited for
    assert [values(each)["V2B_CMD_ALIV"] for each in wire.frames] == [13, 14, 0]
    xor = 0
    for byte in wire.frames[-1].data[1:]:
        xor ^= byte
    assert wire.frames[-1].data[0] == xor


def test_all_that_acts_is_ended_though_one_frame_cannot_be_sent(both: Both) -> None:
    wire, bus = both
    bus.send(frame(CHARGE))
    bus.send(frame(COOL, 0))

    def refuse(sent: can.Message) -> None:
        if sent.arbitration_id == B2C_Charger.FRAME_ID:
            raise KeyboardInterrupt

    wire.before = refuse
    assert isinstance(bus.send_safe_codes(), KeyboardInterrupt)
    assert [message.NAME for message in bus.acting] == ["B2C_Charger"]
    assert wire.last["BMS_ReqstSetTMSts"] == ThermalMode.OFF
    assert wire.last["BMS_ReqstTMSHVon"] == HvRequest.REQUEST_HV_OFF
    wire.before = lambda _: None
    assert bus.send_safe_codes() is None
    assert bus.acting == ()
    stop = next(each for each in wire.frames[::-1] if each.arbitration_id == B2C_Charger.FRAME_ID)
    assert values(stop)["B2V_S_ChargeControl"] == ChargeControl.NORMAL_STOP_TO_CHARGE
    assert values(stop)["B2C_S_CurrentSet"] == 50.0


@pytest.mark.parametrize("message", [CHARGE, COOL, ON], ids=lambda each: each.NAME)
def test_nothing_acts_any_more_once_it_was_ended_and_what_is_safe_is_sent(
    both: Both, message: Message
) -> None:
    wire, bus = both
    bus.send_safe_codes()
    with pytest.raises(EndedError, match=rf"^{message.NAME} would act, and is not sent"):
        bus.send(frame(message, 0))
    assert wire.frames == []
    bus.send(frame(OFF, 0))
    assert wire.last["V2B_CMD_HV_OnOff"] == HvCommand.HV_OFF


def test_what_is_on_its_way_while_another_thread_ends_it_is_ended_after_that(both: Both) -> None:
    wire, bus = both
    others: list[threading.Thread] = []

    def end(_: can.Message) -> None:
        if not others:
            others.append(threading.Thread(target=bus.send_safe_codes))
            others[0].start()
            others[0].join()  # its off overtakes this on

    wire.before = end
    bus.send(frame(ON, 0))
    commands = [values(each)["V2B_CMD_HV_OnOff"] for each in wire.frames]
    assert commands == [HvCommand.HV_OFF, HvCommand.HV_ON, HvCommand.HV_OFF]
    assert bus.acting == ()


def test_a_frame_that_may_have_gone_out_counts_as_sent(both: Both) -> None:
    wire, bus = both

    def raise_all_the_same(sent: can.Message) -> None:
        wire.frames.append(sent)
        raise IndexError("list index out of range")

    wire.before = raise_all_the_same
    with pytest.raises(IndexError):
        bus.send(frame(ON, 0))
    assert bus.has_acted
    assert bus.acting


def test_what_its_receiver_passes_over_has_ended_nothing(both: Both) -> None:
    _, bus = both
    bus.send(frame(ON, 4))
    spoilt = frame(OFF, 5)
    spoilt.data[0] ^= 0xFF
    bus.send(spoilt)
    assert bus.acting
    bus.send(frame(ON, 6))
    bus.send(frame(OFF, 6))  # the counter stands still
    assert bus.acting
    bus.send(frame(OFF, 7))
    assert bus.acting == ()


def test_a_message_without_a_counter_ends_what_it_began(both: Both) -> None:
    _, bus = both
    bus.send(frame(CHARGE))
    assert bus.acting
    bus.send(frame(B2C_Charger(charge_control=ChargeControl.FAULT_STOP_TO_CHARGE)))
    assert bus.acting == ()


def test_frames_that_are_no_message_pass_as_they_are(both: Both) -> None:
    wire, bus = both
    number = V2B_CMD.FRAME_ID
    strange = [
        can.Message(arbitration_id=number & 0x7FF, is_extended_id=False, data=bytes(8)),
        can.Message(arbitration_id=number, data=b"\x00\x10"),
        can.Message(arbitration_id=number, is_remote_frame=True),
    ]
    for each in strange:
        bus.send(each)
    assert wire.frames == strange
    assert bus.acting == ()
    assert not bus.has_acted


def test_what_sends_the_safe_codes_is_not_held_up_by_the_record_which_has_them_later() -> None:
    noted: list[can.Message] = []
    threads: list[threading.Thread] = []

    def note(each: can.Message) -> None:
        noted.append(each)
        threads.append(threading.current_thread())

    clock = SimulatedClock(10.0)
    with Wire() as wire, NotingBus(wire, Codec(), note, clock=clock) as bus:
        bus.send(frame(ON, 0))
        clock.advance_to(11.0)
        other = threading.Thread(target=bus.send_safe_codes)
        other.start()
        other.join()
        assert len(wire.frames) == 2
        assert len(noted) == 0
        clock.advance_to(12.0)
        bus.send(frame(OFF, 2))
    assert [each.timestamp for each in noted] == [10.0, 11.0, 12.0]
    assert [each.is_rx for each in noted] == [False] * 3
    assert set(threads) == {threading.current_thread()}


def test_the_last_reports_of_others_count_from_the_last_code_that_acts() -> None:
    class Talking(Wire):
        def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
            return can.Message(arbitration_id=0x123, is_extended_id=False), False

    with Talking() as wire, NotingBus(wire, Codec(), lambda _: None, clock=SimulatedClock()) as bus:
        bus.recv(0)
        bus.send(frame(OFF, 0))
        assert set(bus.latest) == {(0x123, False)}
        bus.send(frame(ON, 1))
        assert bus.latest == {}
        bus.recv(0)
        bus.send(frame(OFF, 2))  # what came before it may have been said before the last on
        assert bus.latest == {}
        bus.recv(0)
        bus.send(frame(OFF, 3))
        assert set(bus.latest) == {(0x123, False)}


@pytest.mark.parametrize("error", [ValueError("full"), KeyboardInterrupt(), SystemExit(0)])
def test_a_recorder_that_raises_holds_nobody_up_and_is_told_no_more(error: BaseException) -> None:
    told: list[can.Message] = []

    def note(each: can.Message) -> None:
        told.append(each)
        raise error

    clock = SimulatedClock()
    with Wire() as wire, NotingBus(wire, Codec(), note, clock=clock) as bus:
        for second in range(5):
            clock.advance_to(float(second))
            bus.send(frame(ON, second))
        assert bus.failure is error
        assert bus.send_safe_codes() is None
    assert len(told) == 1
    assert len(wire.frames) == 6


def test_trouble_lasts_until_the_same_direction_works_again() -> None:
    troubled = {"send": False, "recv": False}

    class Half(Wire):
        def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
            if troubled["recv"]:
                raise IndexError("cut short")
            return None, False

    clock = SimulatedClock()
    with Half() as wire, NotingBus(wire, Codec(), lambda _: None, clock=clock) as bus:

        def refuse(_: can.Message) -> None:
            if troubled["send"]:
                raise OSError("no")

        wire.before = refuse
        troubled["recv"] = True
        for second in (1.0, 2.0):
            clock.advance_to(second)
            with pytest.raises(IndexError):
                bus.recv(0)
            bus.send(frame(OFF, int(second)))
        assert bus.trouble
        assert (bus.trouble[0], type(bus.trouble[1])) == (1.0, IndexError)
        troubled["send"] = True
        clock.advance_to(3.0)
        with pytest.raises(OSError, match="no"):
            bus.send(frame(OFF, 3))
        assert bus.trouble[0] == 1.0  # the one that has lasted longer
        troubled["recv"] = False
        assert bus.recv(0) is None
        assert (bus.trouble[0], type(bus.trouble[1])) == (3.0, OSError)
        troubled["send"] = False
        bus.send(frame(OFF, 4))
        assert bus.trouble is None
