"""The rules about checksums and alive counters: wherever logs are cut, and beside lost frames."""

from __future__ import annotations

from pathlib import Path

import pytest
from rules.altered import database
from rules.in_blocks import ALL, candump, found, result_of

from swapcan.conform import rule_of

CASES = Path(__file__).with_name("cases")
SIZES = pytest.mark.parametrize("size", [1, 2, 7, ALL])

PROTECTED = ("V2B_CMD", "V2B_RQData", "B2V_ST1", *(f"B2V_SysCode{n}" for n in range(1, 5)))
"""Tables 1, 8, 14 and 16."""


def st1(time: float, counter: int, *, spoilt: bool = False) -> str:
    """A line of B2V_ST1; its only other byte that is not 0 is the checksum."""
    return f"{time} can0 1881D0F3#{counter ^ spoilt:02X}{counter:02X}000000000000"


@SIZES
def test_wrong_checksums_are_steps_of_the_counter_and_no_faults(size: int, tmp_path: Path) -> None:
    lines = [
        st1(0.0, 0),
        st1(0.1, 9, spoilt=True),
        st1(0.2, 9, spoilt=True),
        st1(0.3, 3),
        st1(0.4, 4, spoilt=True),
        st1(0.6, 6),  # 5 is lost
        st1(0.7, 7),
    ]
    result = result_of(rule_of("counter-sequence"), candump(tmp_path / "steps.log", *lines), size)
    assert found(result) == [
        (
            "B2V_ST1_ALIV",
            0.6,
            0.6,
            1,
            "skipped: the counter goes from 3 to 6 instead of 5",
        )
    ]
    assert result.examined == 4


@SIZES
def test_a_counter_that_stays_is_one_run_across_wrong_checksums(size: int, tmp_path: Path) -> None:
    lines = [st1(0.0, 4), st1(0.1, 4), st1(0.2, 4, spoilt=True), st1(0.3, 4), st1(0.4, 5)]
    result = result_of(rule_of("counter-sequence"), candump(tmp_path / "stays.log", *lines), size)
    assert [each[1:] for each in found(result)] == [
        (0.1, 0.3, 2, "repeated: the counter stays at 4")
    ]


@SIZES
@pytest.mark.parametrize(("pause", "count"), [(0.45, 1), (0.55, 0)])
def test_a_counter_begins_anew_after_more_than_five_periods(
    pause: float, count: int, size: int, tmp_path: Path
) -> None:
    lines = [st1(0.0, 3), st1(pause, 11, spoilt=True), st1(pause + 0.1, 12), st1(pause + 0.2, 13)]
    result = result_of(rule_of("counter-sequence"), candump(tmp_path / "pause.log", *lines), size)
    assert result.count == count


@SIZES
def test_a_counter_begins_anew_after_a_value_that_it_must_not_have(
    size: int, tmp_path: Path
) -> None:
    log = candump(tmp_path / "fifteen.log", st1(0.0, 3), st1(0.1, 15), st1(0.2, 9), st1(0.3, 10))
    assert result_of(rule_of("counter-sequence"), log, size).count == 0
    assert [each[1:4] for each in found(result_of(rule_of("counter-allowed"), log, size))] == [
        (0.1, 0.1, 1)
    ]


def test_counters_of_eight_bits_may_have_any_value_and_run_through_255(tmp_path: Path) -> None:
    lines = [f"{n} can0 18FF45F4#000000000000{n % 256:02X}00" for n in range(250, 300)]
    log = candump(tmp_path / "cooling.log", *lines)
    result = result_of(rule_of("counter-sequence"), log)
    assert (result.examined, result.count) == (50, 0)
    assert result_of(rule_of("counter-allowed"), log).examined == 0


def test_each_byte_counts_for_each_checksum_and_only_where_the_standard_states_one(
    tmp_path: Path,
) -> None:
    lines = [
        f"{8 * number + byte} can0 {message.frame_id:08X}#{1 << 8 * byte:016X}"
        for number, message in enumerate(database().messages)
        for byte in range(8)
    ]
    result = result_of(rule_of("checksum"), candump(tmp_path / "bytes.log", *lines))
    assert {(each.subject.message, each.frames) for each in result.occurrences} == {
        (name, 8) for name in PROTECTED
    }
