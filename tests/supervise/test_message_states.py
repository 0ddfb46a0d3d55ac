"""States of messages at times worked out by hand: B2V_ST2 has a period of 100 ms."""

import math

import pytest
from supervise.arrivals import received, refused

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import (
    B2V_RQ,
    B2V_ST2,
    B2V_ST3,
    V2B_CMD,
    B2V_ElecEnergy,
    B2V_SysCode1,
    B2V_Ucell,
)
from typedcan.supervise import NotSeen, State, StateChanged, SupervisionEvent, Supervisor
from typedcan.wire.errors import UnknownMessageError, UnknownNodeError

NEVER_SEEN, ALIVE, LATE, LOST = State


def vcu(**options: object) -> Supervisor:
    """A VCU's supervision of B2V_ST2 alone, begun at 0 s."""
    supervisor = Supervisor(PROTOCOL, "VCU", expect=[B2V_ST2], **options)  # type: ignore[arg-type]
    supervisor.start(0.0)
    return supervisor


def test_the_first_frame_makes_a_message_alive() -> None:
    supervisor = vcu()
    assert supervisor.state(B2V_ST2) is NEVER_SEEN
    (event,) = supervisor.take(received("B2V_ST2"), 0.02)
    assert event == StateChanged(B2V_ST2, NEVER_SEEN, ALIVE, 0.02, math.inf)
    assert str(event) == "B2V_ST2: never seen -> alive"
    assert supervisor.state(B2V_ST2) is ALIVE


def test_a_message_is_late_after_one_and_a_half_periods_and_lost_after_five() -> None:
    supervisor = vcu()
    supervisor.take(received("B2V_ST2"), 0.0)
    assert supervisor.check(0.149) == ()
    assert supervisor.check(0.151) == (StateChanged(B2V_ST2, ALIVE, LATE, 0.151, 0.151),)
    assert supervisor.check(0.499) == ()
    (lost,) = supervisor.check(0.501)
    assert lost == StateChanged(B2V_ST2, LATE, LOST, 0.501, 0.501)
    assert str(lost) == "B2V_ST2: late -> lost after 0.501 s of silence"
    assert supervisor.check(100.0) == ()
    assert supervisor.state(B2V_ST2) is LOST


def test_a_message_that_comes_back_is_alive_again() -> None:
    supervisor = vcu()
    supervisor.take(received("B2V_ST2"), 0.0)
    supervisor.check(0.75)
    assert supervisor.take(received("B2V_ST2"), 2.0) == (
        StateChanged(B2V_ST2, LOST, ALIVE, 2.0, 2.0),
    )
    assert supervisor.check(2.125) == ()
    assert [event.new for event in supervisor.check(2.5) if isinstance(event, StateChanged)] == [
        LOST
    ]


def test_a_silence_that_nobody_looked_at_is_reported_with_the_next_frame() -> None:
    supervisor = vcu()
    supervisor.take(received("B2V_ST2"), 0.0)
    assert supervisor.take(received("B2V_ST2"), 0.75) == (
        StateChanged(B2V_ST2, ALIVE, LOST, 0.75, 0.75),
        StateChanged(B2V_ST2, LOST, ALIVE, 0.75, 0.75),
    )
    assert supervisor.take(received("B2V_ST2"), 1.0) == (
        StateChanged(B2V_ST2, ALIVE, LATE, 1.0, 0.25),
        StateChanged(B2V_ST2, LATE, ALIVE, 1.0, 0.25),
    )


def test_frames_that_waited_for_a_receiver_were_not_lost() -> None:
    """The receiver slept for a second; the timestamps say that the frames came in time."""
    supervisor = vcu()
    supervisor.take(received("B2V_ST2", 50.0), 0.0)
    waiting = [received("B2V_ST2", 50.0 + 0.1 * n) for n in range(1, 11)]
    assert [supervisor.take(one, 1.0) for one in waiting] == [()] * 10
    assert supervisor.check(1.0) == ()


@pytest.mark.parametrize("seconds", [0.7, 3600.0])
def test_setting_the_time_of_day_forward_loses_no_message(seconds: float) -> None:
    supervisor = vcu()
    supervisor.take(received("B2V_ST2", 50.0), 1.0)
    assert supervisor.take(received("B2V_ST2", 50.1 + seconds), 1.1) == ()


def test_an_expected_message_that_never_comes_is_reported_once() -> None:
    supervisor = vcu()
    assert supervisor.check(0.499) == ()
    (event,) = supervisor.check(0.5)
    assert event == NotSeen(B2V_ST2, 0.5)
    assert str(event) == "B2V_ST2: not seen"
    assert supervisor.check(10.0) == ()
    assert supervisor.state(B2V_ST2) is NEVER_SEEN
    assert supervisor.next_check == math.inf


def test_a_refused_frame_does_not_keep_a_message_alive() -> None:
    supervisor = vcu()
    supervisor.take(received("B2V_ST2"), 0.0)
    for n in range(1, 6):
        assert supervisor.fault(refused("B2V_ST2"), n * 0.1) == ()
    supervisor.check(0.51)
    assert supervisor.state(B2V_ST2) is LOST
    (message,) = (m for m in supervisor.snapshot(0.6).messages if m.name == "B2V_ST2")
    assert (message.frames, message.faults["length"]) == (1, 5)


def test_nothing_is_late_before_supervision_has_begun() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    supervisor.take(received("B2V_ST2"), 0.0)
    assert supervisor.check(50.0) == ()
    supervisor.start(50.0)
    assert supervisor.next_check == pytest.approx(50.15)
    assert supervisor.state(B2V_ST2) is ALIVE
    assert supervisor.take(received("B2V_ST2"), 50.1) == ()


def test_a_node_expects_what_is_sent_to_it_at_all_times() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    supervisor.start(0.0)
    missing = {event.message.NAME for event in supervisor.check(1000.0)}
    # Tables 1, 2, 4 to 7, 9, 10, 12 and 17; not B2V_RQ, which has no period, nor what
    # V2B_RQData asks for: B2V_SysCode1 to 4, B2V_BattInfo1 and 2.
    status = {f"B2V_ST{n}" for n in range(7)}
    assert missing == status | {"B2V_ElecEnergy", "B2V_Ucell", "B2V_Temp", "BSU_BMS_0"}


def test_messages_that_need_not_come_are_measured_but_never_late() -> None:
    supervisor = vcu()
    supervisor.check(1.0)
    for name, kind in (("B2V_RQ", B2V_RQ), ("B2V_SysCode1", B2V_SysCode1)):
        supervisor.take(received(name), 1.0)
        supervisor.take(received(name), 2.0)
        assert supervisor.check(3600.0) == ()
        assert supervisor.state(kind) is ALIVE
    measured = {m.name: m for m in supervisor.snapshot(3600.0).messages}
    assert measured["B2V_RQ"].period.mean == 1.0
    assert measured["B2V_RQ"].age == 3598.0


def test_what_happens_together_is_reported_in_the_order_in_which_it_happened() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU", expect=[B2V_ST2, B2V_ST3, B2V_ElecEnergy])
    supervisor.start(0.0)
    supervisor.take(received("B2V_ST3"), 0.01)
    supervisor.take(received("B2V_ST2"), 0.02)
    events = supervisor.check(60.0)
    assert [(event.message, type(event)) for event in events] == [
        (B2V_ST3, StateChanged),
        (B2V_ST2, StateChanged),
        (B2V_ElecEnergy, NotSeen),
    ]


def test_driving_by_next_check_finds_every_change_at_its_time() -> None:
    supervisor = vcu()
    supervisor.take(received("B2V_ST2"), 0.0)
    noticed: list[SupervisionEvent] = []
    for _ in range(20):
        now = supervisor.next_check
        if math.isinf(now):
            break
        noticed += supervisor.check(now)
    assert [event.new for event in noticed if isinstance(event, StateChanged)] == [LATE, LOST]
    assert [event.at for event in noticed] == pytest.approx([0.15, 0.5])
    supervisor.take(received("B2V_ST2"), 3.0)
    assert supervisor.next_check <= 3.15


def test_timeouts_are_configurable_for_all_and_for_one() -> None:
    supervisor = Supervisor(
        PROTOCOL,
        "VCU",
        expect=[B2V_ST2, B2V_ST3, B2V_RQ],
        timeout_periods=10,
        late_periods=3,
        timeouts={B2V_ST3: 0.2, B2V_RQ: 60.0},
    )
    supervisor.start(0.0)
    for name in ("B2V_ST2", "B2V_ST3", "B2V_RQ"):
        supervisor.take(received(name), 0.0)
    state = supervisor.state
    supervisor.check(0.21)
    assert (state(B2V_ST2), state(B2V_ST3), state(B2V_RQ)) == (ALIVE, LOST, ALIVE)
    supervisor.check(0.31)
    assert state(B2V_ST2) is LATE
    supervisor.check(0.99)
    assert state(B2V_ST2) is LATE
    supervisor.check(1.01)
    assert state(B2V_ST2) is LOST
    supervisor.check(60.0)
    assert state(B2V_RQ) is LOST


def test_a_message_may_be_lost_before_it_would_be_late() -> None:
    supervisor = vcu(timeouts={B2V_ST2: 0.125})
    for now in (0.0, 0.125):
        supervisor.take(received("B2V_ST2"), now)
    assert supervisor.take(received("B2V_ST2"), 0.265625) == (
        StateChanged(B2V_ST2, ALIVE, LOST, 0.265625, 0.140625),
        StateChanged(B2V_ST2, LOST, ALIVE, 0.265625, 0.140625),
    )
    assert supervisor.check(0.390625) == (StateChanged(B2V_ST2, ALIVE, LOST, 0.390625, 0.125),)


def test_a_period_of_ones_own_replaces_the_standards() -> None:
    supervisor = vcu()
    supervisor.expect_period(B2V_ST2, 1.0)
    supervisor.take(received("B2V_ST2"), 0.0)
    assert supervisor.check(1.49) == ()
    supervisor.check(1.5)
    assert supervisor.state(B2V_ST2) is LATE
    supervisor.check(5.0)
    assert supervisor.state(B2V_ST2) is LOST


def test_an_answer_is_expected_while_it_is_asked_for() -> None:
    supervisor = vcu()
    supervisor.take(received("B2V_SysCode1"), 0.0)
    supervisor.expect_period(B2V_SysCode1, 1.0, now=60.0)
    supervisor.expect_period(B2V_ST2, None)
    assert supervisor.check(60.0) == ()
    assert supervisor.next_check == 61.5
    assert supervisor.check(61.0) == ()
    assert supervisor.take(received("B2V_SysCode1"), 61.0) == ()
    supervisor.check(66.0)
    assert supervisor.state(B2V_SysCode1) is LOST
    supervisor.expect_period(B2V_SysCode1, None)
    supervisor.take(received("B2V_SysCode1"), 67.0)
    assert supervisor.check(1000.0) == ()
    assert supervisor.next_check == math.inf


def test_any_frame_of_a_cycle_keeps_its_message_alive() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU", expect=[B2V_Ucell])
    supervisor.start(0.0)
    for n in range(1, 21):
        supervisor.take(received("B2V_Ucell", FrameNo=n, CSCNo=1), n * 0.1)
        assert supervisor.check(n * 0.1 + 0.14) == ()
    assert supervisor.state(B2V_Ucell) is ALIVE


def test_an_answer_that_never_comes_is_reported_though_nothing_else_is_expected() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU", expect=[])
    supervisor.start(0.0)
    assert supervisor.next_check == math.inf
    supervisor.expect_period(B2V_SysCode1, 1.0, now=60.0)
    assert supervisor.next_check == 65.0
    assert supervisor.check(65.0) == (NotSeen(B2V_SysCode1, 65.0),)


def test_beginning_anew_gives_all_messages_their_time() -> None:
    supervisor = vcu()
    supervisor.check(1.0)
    supervisor.start(10.0)
    assert supervisor.check(10.4) == ()
    assert supervisor.check(10.5) == (NotSeen(B2V_ST2, 10.5),)


def test_settings_without_sense_are_refused() -> None:
    with pytest.raises(UnknownNodeError, match="XCU"):
        Supervisor(PROTOCOL, "XCU")
    with pytest.raises(ValueError, match="timeout_periods is 0"):
        Supervisor(PROTOCOL, "VCU", timeout_periods=0)
    with pytest.raises(ValueError, match="late_periods is nan"):
        Supervisor(PROTOCOL, "VCU", late_periods=math.nan)
    with pytest.raises(ValueError, match="the timeout of B2V_ST2 is -1"):
        Supervisor(PROTOCOL, "VCU", timeouts={B2V_ST2: -1.0})
    with pytest.raises(ValueError, match="the period of V2B_CMD is 0"):
        vcu().expect_period(V2B_CMD, 0.0)


def test_a_message_of_another_protocol_is_no_message_of_this_one() -> None:
    class Foreign(B2V_ST2):
        """Not among the protocol's."""

    with pytest.raises(UnknownMessageError, match="Foreign"):
        vcu().state(Foreign)
