"""The rules about frames as such: wherever logs are cut, and against the standard's layout."""

from __future__ import annotations

from functools import reduce
from operator import xor
from pathlib import Path
from typing import Any

import pytest
import yaml
from rules.in_blocks import ALL, candump, found, result_of

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform import Status, rule_of
from typedcan.judge.rules.frames.reserved_bits import reserved_masks

CASES = Path(__file__).with_name("cases")
SPEC = Path(__file__).parents[2] / "spec" / "messages.yaml"

ST1 = "1881D0F3#F8F0000800000000"


def printed() -> dict[int, list[dict[str, Any]]]:
    """The fields of A.1 by identifier, of which one is printed with a capital X."""
    messages = yaml.safe_load(SPEC.read_text("utf-8"))["messages"]
    return {int(str(each["id"]), 0): each["signals"] for each in messages}


def test_the_reserved_bits_are_those_that_the_standard_prints() -> None:
    fields = {
        number: tuple(
            (each["start"], each["start"] + each["length"] - 1)
            for each in signals
            if each["name"] == "Reserved"
        )
        for number, signals in printed().items()
    }
    judged = {message.FRAME_ID: mask for message, mask in reserved_masks(PROTOCOL).items()}
    assert judged == {
        number: sum((1 << last + 1) - (1 << first) for first, last in reserved)
        for number, reserved in fields.items()
        if reserved
    }


def test_the_bits_that_no_field_names_are_found_one_by_one(tmp_path: Path) -> None:
    """A.1 leaves 154 bits of eight frames without a name."""
    lines: list[str] = []
    for number, signals in printed().items():
        for bit in range(64):
            data = (1 << bit).to_bytes(8, "little")
            if signals[0]["name"].endswith("Checksum"):
                data = bytes([reduce(xor, data[1:])]) + data[1:]
            lines.append(f"{len(lines)} can0 {number:08X}#{data.hex()}")
    log = candump(tmp_path / "bits.log", *lines)
    result = result_of(rule_of("unassigned-bits"), log)
    assert result.frames == 154
    assert len({each.subject.message for each in result.occurrences}) == 8


def test_a_node_that_is_not_judged_is_not_blamed_for_its_frames() -> None:
    for rule in (rule_of("frame-kind"), rule_of("frame-length"), rule_of("identifier-priority")):
        log = CASES / rule.id / "fails.log"
        assert result_of(rule, log, nodes=["BSU"]).status is Status.NOT_JUDGED


def test_foreign_frames_are_noted_whoever_is_judged() -> None:
    result = result_of(
        rule_of("foreign-frames"), CASES / "foreign-frames" / "fails.log", nodes=["CHG"]
    )
    assert {each.subject.node for each in result.occurrences} == {"CHG"}
    assert result.count == 3


@pytest.mark.parametrize("size", [7, 400, ALL])
def test_the_first_thousand_foreign_identifiers_are_listed_and_the_rest_counted(
    size: int, tmp_path: Path
) -> None:
    # In falling order, so that the first to come are not the lowest; the last three come twice.
    numbers = [*range(0x10000000 + 1004, 0x10000000 - 1, -1), *range(0x10000000, 0x10000003)]
    lines = [f"{place / 1000} can0 {number:08X}#00" for place, number in enumerate(numbers)]
    result = result_of(rule_of("foreign-frames"), candump(tmp_path / "many.log", *lines), size)
    assert result.count == len(result.occurrences) == 1000
    assert result.occurrences[0].subject.detail == "0x100003EC"
    assert result.occurrences[-1].subject.detail == "0x10000005"
    assert result.occurrences[-2].says() == "frames that the protocol does not have: 1"
    assert result.occurrences[-1].says() == (
        "frames that the protocol does not have: 1; of further identifiers: 8"
    )


def test_a_frame_from_an_unknown_address_is_foreign_where_the_message_came_as_printed(
    tmp_path: Path,
) -> None:
    lines = ["0 can0 1880D0F5#0000000000000000", "0.1 can0 1880D0F3#0000000000000000"]
    both = candump(tmp_path / "both.log", *lines)
    assert result_of(rule_of("source-address"), both).count == 0
    assert [each[0] for each in found(result_of(rule_of("foreign-frames"), both))] == ["0x1880D0F5"]
    alone = candump(tmp_path / "alone.log", lines[0])
    assert [each[0] for each in found(result_of(rule_of("source-address"), alone))] == [
        "B2V_ST0 0x1880D0F5"
    ]
    assert result_of(rule_of("foreign-frames"), alone).count == 0


def test_error_frames_and_frames_of_other_kinds_do_not_hide_those_that_are_right(
    tmp_path: Path,
) -> None:
    lines = [f"0 can0 {ST1}", "0.05 can0 20000080#0000000000000000", "0.1 can1 1881D0F3#R8"]
    log = candump(tmp_path / "mixed.log", *lines, f"0.2 can0 {ST1}", "0.3 can0 1881D0F3#00")
    assert [each[1:4] for each in found(result_of(rule_of("frame-kind"), log))] == [(0.1, 0.1, 1)]
    assert [each[1:4] for each in found(result_of(rule_of("frame-length"), log))] == [(0.3, 0.3, 1)]
    assert result_of(rule_of("frame-length"), log).examined == 3
