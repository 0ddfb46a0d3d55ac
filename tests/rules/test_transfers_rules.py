"""The rules about values that take several frames, beyond their case folders."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from pathlib import Path

import pytest
from rules.in_blocks import candump, essence, found, result_of
from rules.recorded import recorded, written

from swapcan.conform import Rule, Status, judge_log, rule_of
from swapcan.rules.texts import RULES as TEXTS

CASES = Path(__file__).with_name("cases")

RULES = (
    *TEXTS,
    *map(rule_of, ("cells-complete", "cells-order", "probes-complete", "probes-order")),
    rule_of("frame-numbers"),
)
BY_ID = {rule.id: rule for rule in RULES}
COMPLETE, ORDER = BY_ID["cells-complete"], BY_ID["cells-order"]

Key = tuple[int, int]
"""CSC and frame number."""

Turn = tuple[float, Key]


def pack(*frames: int) -> list[Key]:
    """The keys of CSCs with so many frames each."""
    return [(csc, n) for csc, count in enumerate(frames, 1) for n in range(1, count + 1)]


def cycles(keys: Sequence[Key], count: int, begin: float = 0.0, share: float = 1.0) -> list[Turn]:
    """Cycles of 100 ms, the frames of each within a share of it."""
    step = 0.1 * share / len(keys)
    return [
        (begin + 0.1 * cycle + step * place, key)
        for cycle in range(count)
        for place, key in enumerate(keys)
    ]


def log_of(path: Path, turns: Iterable[Turn]) -> Path:
    return candump(
        path,
        *(f"{time:.6f} can0 18C1D0F3#{n:02X}{csc:02X}000D000D000D" for time, (csc, n) in turns),
    )


def faults(rule: Rule, log: Path) -> list[tuple[str, str]]:
    """About what, and the first word of what is said."""
    return [(subject, said.split()[0]) for subject, *_, said in found(result_of(rule, log))]


def named(key: Key) -> str:
    return f"B2V_Ucell CSC {key[0]} frame {key[1]}"


def test_all_that_simulated_nodes_transfer_is_right(tmp_path: Path) -> None:
    frames = recorded("ask@2s", seconds=4.0, nodes=("BMU", "VCU"))
    judgement = judge_log(written(frames, tmp_path / "asked.log"), rules=RULES)
    assert {result.rule.id: result.status for result in judgement.results} == dict.fromkeys(
        BY_ID, Status.PASSED
    )


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("share", [1.0, 0.05], ids=["spread", "in bursts"])
@pytest.mark.parametrize(
    "keys", [pack(4, 4), pack(4, 1, 3, 1), pack(*[4] * 18)], ids=["2x4", "mixed", "18x4"]
)
def test_each_lost_frame_is_found_and_nothing_else(
    tmp_path: Path, keys: list[Key], share: float, seed: int
) -> None:
    chance = random.Random(seed)
    turns = cycles(keys, 40, share=share)[chance.randrange(len(keys)) :]
    inside = range(3 * len(keys), len(turns) - len(keys))
    lost = sorted(chance.sample(inside, 60))
    left = [turn for place, turn in enumerate(turns) if place not in lost]
    log = log_of(tmp_path / "a.log", left)
    expected = [(named(turns[place][1]), "missing") for place in lost]
    assert sorted(faults(COMPLETE, log)) == sorted(expected)
    assert faults(ORDER, log) == []
    assert essence(result_of(COMPLETE, log, 101)) == essence(result_of(COMPLETE, log))


@pytest.mark.parametrize("count", [2, 3, 7, 8, 9])
def test_one_lost_frame_in_four_is_found_from_the_begin_of_a_log_on(
    tmp_path: Path, count: int
) -> None:
    turns = cycles(pack(*[1] * count), 60)
    left = [turn for place, turn in enumerate(turns) if place % 4 != 2]
    result = result_of(COMPLETE, log_of(tmp_path / "a.log", left))
    always_lost = {turns[place][1] for place in range(2, len(turns), 4)} - {key for _, key in left}
    expected = sum(
        place % 4 == 2 and turns[place][1] not in always_lost for place in range(len(turns))
    )
    assert expected - 2 * count <= result.count <= expected


def test_a_pack_with_another_layout_after_a_swap_is_learnt_anew(tmp_path: Path) -> None:
    turns = cycles(pack(4, 4), 5)[:-3] + cycles(pack(2, 2, 2), 5, begin=60.0)
    log = log_of(tmp_path / "a.log", turns)
    assert result_of(COMPLETE, log).status is Status.PASSED
    assert result_of(ORDER, log).status is Status.PASSED


def test_a_short_pause_between_two_cycles_is_no_loss(tmp_path: Path) -> None:
    turns = cycles(pack(4, 4), 4) + cycles(pack(4, 4), 4, begin=0.7)
    assert faults(COMPLETE, log_of(tmp_path / "a.log", turns)) == []


def test_a_csc_that_falls_silent_is_missing_in_every_cycle(tmp_path: Path) -> None:
    turns = cycles(pack(2, 2), 5) + cycles([(1, 1), (1, 2)], 5, begin=0.5)
    turns += cycles(pack(2, 2), 2, begin=1.0)
    log = log_of(tmp_path / "a.log", turns)
    assert sorted(faults(COMPLETE, log)) == [
        *[(named((2, 1)), "missing")] * 5,
        *[(named((2, 2)), "missing")] * 5,
    ]


def test_a_pack_that_sends_frame_1_of_all_cscs_first_is_complete_but_not_in_order(
    tmp_path: Path,
) -> None:
    keys = sorted(pack(4, 4, 4), key=lambda key: key[1])
    turns = cycles(keys, 20)
    del turns[3 * 12 + 5]  # CSC 3 frame 2: fourth cycle, sixth turn
    log = log_of(tmp_path / "a.log", turns)
    assert faults(COMPLETE, log) == [(named((3, 2)), "missing")]
    assert faults(ORDER, log) == [(named((1, 2)), "comes")]


def test_frames_that_overtake_each_other_are_complete_but_not_in_order(tmp_path: Path) -> None:
    turns = cycles(pack(4, 4), 10)
    turns[43:45] = [(turns[43][0], (2, 1)), (turns[44][0], (1, 4))]
    log = log_of(tmp_path / "a.log", turns)
    assert faults(COMPLETE, log) == []
    assert faults(ORDER, log) == [(named((1, 4)), "came")]


def test_a_frame_that_comes_twice_is_no_loss_of_others(tmp_path: Path) -> None:
    turns = cycles(pack(4, 4), 10)
    at_once = (turns[42][0] + 0.001, turns[42][1])  # in the sixth cycle, its third frame
    later = (turns[60][0] + 0.030, turns[60][1])  # after the next two frames
    log = log_of(tmp_path / "a.log", sorted([*turns, at_once, later]))
    assert faults(COMPLETE, log) == [(named((1, 3)), "came"), (named((2, 1)), "came")]


def test_a_frame_of_no_csc_of_the_pack_is_not_waited_for_again(tmp_path: Path) -> None:
    turns = cycles(pack(4, 4), 30)
    stray = [(0.305, (9, 1)), (2.505, (9, 1))]
    log = log_of(tmp_path / "a.log", sorted([*turns, *stray]))
    assert faults(COMPLETE, log) == []


def test_a_csc_that_joins_later_belongs_to_the_cycle_from_then_on(tmp_path: Path) -> None:
    turns = cycles(pack(2, 2), 5) + cycles(pack(2, 2, 2), 10, begin=0.5)
    lost = turns.pop(20 + 7 * 6 + 4)
    log = log_of(tmp_path / "a.log", turns)
    assert lost[1] == (3, 1)
    assert faults(COMPLETE, log) == [(named((3, 1)), "missing")]
    assert essence(result_of(COMPLETE, log, 7)) == essence(result_of(COMPLETE, log))


def vin_frames(*numbers: int, begin: float = 5.0) -> list[str]:
    return [
        f"{begin + 0.005 * place:.3f} can0 18E1F3D0#{number:02X}31313131313131"
        for place, number in enumerate(numbers)
    ]


@pytest.mark.parametrize(
    ("numbers", "broken"),
    [
        pytest.param((1, 2, 3, 1, 2, 3), [], id="twice"),
        pytest.param((2, 1, 3), ["2", "1, 3"], id="out of order"),
        pytest.param((1, 2, 2, 3), ["1, 2, 2, 3"], id="repeated"),
        pytest.param((1, 1, 2, 3), ["1"], id="begun again"),
        pytest.param((3, 1, 2, 3), ["3"], id="a last one alone"),
        pytest.param((0, 1, 2), ["0", "1, 2"], id="numbered from 0"),
        pytest.param((1, 2), ["1, 2"], id="incomplete at the end"),
    ],
)
def test_a_broken_vin_is_one_occurrence(
    tmp_path: Path, numbers: tuple[int, ...], broken: list[str]
) -> None:
    end = "9 can0 1802F3D0#0000000000000000"
    log = candump(tmp_path / "a.log", "0 can0 123#", *vin_frames(*numbers), end)
    said = [text for *_, text in found(result_of(BY_ID["vin-transfer"], log))]
    assert said == [f"frames {each} in place of 1, 2, 3" for each in broken]


def test_wrong_characters_of_a_vin_are_found_wherever_they_stand(tmp_path: Path) -> None:
    good, lines = "1M8GDM9AXKP042788", list[str]()
    for place in range(17):
        vin = (good[:place] + "*" + good[place + 1 :]).encode().ljust(21, b"\0")
        lines += [
            f"{place + 0.1 * n:.1f} can0 18E1F3D0#{n + 1:02X}{vin[7 * n : 7 * n + 7].hex()}"
            for n in range(3)
        ]
    result = result_of(BY_ID["vin-characters"], candump(tmp_path / "a.log", *lines))
    assert [(start, said.split(",")[0]) for _, start, _, _, said in found(result)] == [
        (round(place + 0.1 * (place // 7), 6), f"character {place + 1} is 0x2A")
        for place in range(17)
    ]


def code_frame(number: int, content: str) -> str:
    """A frame of the pack code with the right checksum, from bytes 1 to 7."""
    data, checksum = bytes.fromhex(content), 0
    for byte in data:
        checksum ^= byte
    return f"can0 18E{number}D0F3#{checksum:02X}{data.hex()}"


def test_characters_of_the_pack_code_are_not_judged_before_its_length_is_known(
    tmp_path: Path,
) -> None:
    bad = code_frame(4, "FFFFFFFFFFFFFF")
    log = candump(
        tmp_path / "a.log", f"0 {bad}", f"1 {code_frame(1, 'A8303132333435')}", f"2 {bad}"
    )
    result = result_of(BY_ID["pack-code-characters"], log)
    assert found(result) == [
        (
            "B2V_SysCode4",
            2.0,
            2.0,
            1,
            "character 21 of 21 is 0xFF, allowed are 0 to 9 and A to Z in ASCII",
        )
    ]
    assert result.examined == 2


@pytest.mark.parametrize(("silence", "count"), [(4.0, 1), (6.0, 0)])
def test_another_pack_code_takes_a_bmu_that_was_away(
    tmp_path: Path, silence: float, count: int
) -> None:
    beats = [0.0, 1.0, 2.0, 2.0 + silence, 3.0 + silence, 7.0 + silence]
    log = candump(
        tmp_path / "a.log",
        *(f"{time} can0 1881D0F3#0000000000000000" for time in beats[:3]),
        f"2.1 {code_frame(1, 'C1303132333435')}",
        *(f"{time} can0 1881D0F3#0000000000000000" for time in beats[3:]),
        f"{8 + silence} {code_frame(1, 'C1303132333436')}",
    )
    result = result_of(BY_ID["pack-code-constant"], log)
    assert result.count == count
    assert essence(result_of(BY_ID["pack-code-constant"], log, 1)) == essence(result)
