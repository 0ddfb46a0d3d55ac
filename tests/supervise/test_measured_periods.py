"""Which times count as the period of a message, and how exactly they are kept."""

from itertools import cycle, islice

import pytest
from supervise.arrivals import received

from swapcan._generated.protocol import PROTOCOL
from typedcan.supervise import Supervisor
from typedcan.supervise.periods import Periods
from typedcan.supervise.snapshot import MessageSnapshot


def measured(supervisor: Supervisor, name: str) -> MessageSnapshot:
    (message,) = (m for m in supervisor.snapshot(1000.0).messages if m.name == name)
    return message


def test_the_period_is_that_of_the_timestamps_not_of_the_receivers_turns() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    for stamp, taken in ((7.0, 0.0), (7.1, 0.19), (7.2, 0.2), (7.3, 0.35)):
        supervisor.take(received("B2V_ST2", stamp), taken)
    period = measured(supervisor, "B2V_ST2").period
    assert period.count == 3
    assert (period.shortest, period.mean, period.worst) == pytest.approx((0.1, 0.1, 0.1))
    assert period.jitter == pytest.approx(0.0, abs=1e-9)


def test_worst_is_the_longest_time_between_frames() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    for now in (0.0, 0.125, 0.25, 0.5, 0.5625):
        supervisor.take(received("B2V_ST2"), now)
    period = measured(supervisor, "B2V_ST2").period
    assert (period.worst, period.shortest, period.mean) == (0.25, 0.0625, 0.140625)


def test_one_frame_makes_no_period() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    supervisor.take(received("B2V_ST2", 5.0), 0.0)
    period = measured(supervisor, "B2V_ST2").period
    assert (period.count, period.mean, period.jitter) == (0, None, None)
    assert (period.worst, period.shortest) == (None, None)


def test_a_simulated_clock_measures_simulated_time() -> None:
    """The frames of a simulated second are made, and stamped, within a millisecond."""
    supervisor = Supervisor(PROTOCOL, "VCU", timestamps=False)
    for n in range(11):
        supervisor.take(received("B2V_ST2", 7e8 + n * 1e-5), n * 0.125)
    period = measured(supervisor, "B2V_ST2").period
    assert (period.mean, period.jitter) == (0.125, 0.0)


@pytest.mark.parametrize("stamps", [(0.0, 0.0, 0.0), (5.0, 5.0, 5.0), (5.0, 4.9, 4.8)])
def test_timestamps_that_stand_still_or_go_back_are_not_used(stamps: tuple[float, ...]) -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    for n, stamp in enumerate(stamps):
        supervisor.take(received("B2V_ST2", stamp), n * 0.125)
    period = measured(supervisor, "B2V_ST2").period
    assert (period.count, period.shortest, period.worst) == (2, 0.125, 0.125)


def test_the_time_of_day_being_set_is_no_time_between_frames() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    for n, stamp in enumerate((50.0, 3650.0, 3650.125, 20.0, 20.125)):
        supervisor.take(received("B2V_ST2", stamp), n * 0.125)
    period = measured(supervisor, "B2V_ST2").period
    assert (period.count, period.worst, period.shortest) == (4, 0.125, 0.125)


def test_the_period_of_several_frames_is_that_of_each_number() -> None:
    """Three frames of each of two CSCs, 10 ms apart, every 100 ms: the period is 100 ms."""
    supervisor = Supervisor(PROTOCOL, "VCU")
    for turn in range(5):
        frames = [(csc, number) for csc in (1, 2) for number in (1, 2, 3)]
        for n, (csc, number) in enumerate(frames):
            now = turn * 0.1 + n * 0.01
            supervisor.take(received("B2V_Ucell", now + 60, FrameNo=number, CSCNo=csc), now)
    message = measured(supervisor, "B2V_Ucell")
    assert (message.frames, message.unmeasured, message.period.count) == (30, 0, 4 * 6)
    assert message.period.worst == pytest.approx(0.1)
    assert message.period.shortest == pytest.approx(0.1)


def test_the_three_frames_of_a_vin_are_told_apart() -> None:
    supervisor = Supervisor(PROTOCOL, "BMU")
    for n in range(9):
        supervisor.take(received("V2B_VIN", FrameNo=n % 3 + 1), n * 0.25)
    period = measured(supervisor, "V2B_VIN").period
    assert (period.count, period.shortest, period.worst) == (6, 0.75, 0.75)


def test_frames_with_ever_new_numbers_do_not_fill_the_memory() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    for n in range(5000):
        one = received("B2V_Ucell", FrameNo=n % 250, CSCNo=n // 250)
        supervisor.take(one, n * 0.001)
    taken = measured(supervisor, "B2V_Ucell")
    assert taken.frames == 5000
    assert taken.unmeasured == 5000 - 1024


def test_a_frame_of_no_csc_is_not_measured_but_reported() -> None:
    supervisor = Supervisor(PROTOCOL, "VCU")
    supervisor.take(received("B2V_Ucell", FrameNo=1, CSCNo=255), 0.0)
    taken = measured(supervisor, "B2V_Ucell")
    assert (taken.frames, taken.unmeasured) == (1, 1)
    assert [(signal.field, signal.kind) for signal in taken.signals] == [("csc_no", "invalid")]


def test_ten_million_times_lose_no_digits() -> None:
    """0.1 s with a jitter of 1 us, which a sum of squares in floats would no longer show."""
    periods = Periods()
    add = periods.add
    for gap in islice(cycle((0.100001, 0.099999)), 10_000_000):
        add(gap)
    stats = periods.stats()
    assert stats.count == 10_000_000
    assert stats.mean == pytest.approx(0.1, rel=1e-12)
    assert stats.jitter == pytest.approx(1e-6, rel=1e-6)
    assert (stats.worst, stats.shortest) == (0.100001, 0.099999)
