"""Judging by what a model says: a protocol of 11-bit identifiers, and one that only a DBC gives."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

import can
import cantools
import pytest
from cantools.database.can import Database
from rules.in_blocks import broken, candump
from rules.recorded import block_of
from transfer.rack import rack

import typedcan
from dbcspec.config import find_config
from dbcspec.project import load
from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.judge import Judge, JudgeError, Judgement, judge_log, rules_for
from typedcan.judge.report import to_csv, to_html, to_json, to_junit
from typedcan.transfer import split
from typedcan.wire.codec import Codec
from typedcan.wire.protocol import Protocol

FIXTURES = Path(__file__).parents[1] / "fixtures"
DBC = """VERSION ""
NS_ :
BS_:
BU_: ECU Display
BO_ 256 Engine: 8 ECU
 SG_ Engine_Speed : 0|16@1+ (0.25,0) [0|8000] "rpm" Display
 SG_ Engine_Gear : 16|4@1+ (1,0) [0|15] "" Display
BO_ 2566844926 Lamp: 2 Display
 SG_ Lamp_On : 0|2@1+ (1,0) [0|3] "" ECU
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_ BO_ "GenMsgSendType" ENUM "Cyclic";
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_DEF_DEF_ "GenMsgSendType" "Cyclic";
BA_ "GenMsgCycleTime" BO_ 256 20;
BA_ "GenMsgSendType" BO_ 256 0;
VAL_ 256 Engine_Gear 0 "Neutral" 1 "First" 2 "Second" ;
VAL_ 2566844926 Lamp_On 0 "Off" 1 "On" ;
"""

Frames = list[can.Message]


@pytest.fixture(scope="module")
def second() -> Protocol:
    """Of 11-bit identifiers, with an alive counter and a transfer of its own."""
    return typed_protocol(load(find_config(FIXTURES / "second")).protocol)


def frame(time: float, number: int, data: bytes, **more: object) -> can.Message:
    return can.Message(
        timestamp=time,
        arbitration_id=number,
        data=data,
        is_extended_id=False,
        channel="can0",
        **more,  # type: ignore[arg-type]
    )


def crc8_sae_j1850(data: bytes) -> int:
    """As the catalogue has it: polynomial 0x1D, initial and final value 0xFF."""
    crc = 0xFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1 ^ 0x1D if crc & 0x80 else crc << 1) & 0xFF
    return crc ^ 0xFF


def status(count: int, speed: int) -> bytes:
    rest = bytes([count % 16, *speed.to_bytes(2, "little"), 0, 0, 0, 0])
    return bytes([crc8_sae_j1850(rest), *rest])


def drive(seconds: float = 20.0) -> Frames:
    """Both nodes as they should be."""
    frames = []
    for tick in range(round(10 * seconds)):
        time = tick / 10
        frames.append(frame(time, 0x101, status(tick, 100 + tick)))
        frames.append(frame(time + 0.001, 0x201, bytes([tick // 50 % 2, *bytes(7)])))
        if tick % 10 == 0:
            number = 1 + tick // 10 % 2
            frames.append(frame(time + 0.002, 0x102, bytes([number, 65, 66, *bytes(5)])))
    return frames


def judged(protocol: Protocol, frames: Iterable[can.Message]) -> Judgement:
    judge = Judge(protocol)
    judge.feed(block_of(sorted(frames, key=lambda each: each.timestamp)))
    return judge.finish()


def without(frames: Frames, number: int, begin: float, end: float) -> Frames:
    return [
        each
        for each in frames
        if each.arbitration_id != number or not begin <= each.timestamp <= end
    ]


def with_status(change: Callable[[int, bytes], bytes]) -> Callable[[Frames], Frames]:
    def alter(frames: Frames) -> Frames:
        altered = []
        for place, each in enumerate(frames):
            if each.arbitration_id == 0x101:
                data = change(place, bytes(each.data))
                each = frame(each.timestamp, 0x101, data)  # noqa: PLW2901
            altered.append(each)
        return altered

    return alter


def test_what_keeps_to_the_second_protocol_breaks_no_rule(second: Protocol) -> None:
    judgement = judged(second, drive())
    assert broken(judgement) == set()
    assert judgement.verdict.name == "CONFORMS"
    assert judgement.seen == ("AAA", "BBB")
    assert [each.message for each in judgement.periods] == ["A_STATUS", "A_SERIAL", "B_CMD"]
    assert judgement.load[0].bit_rate == 500_000


@pytest.mark.parametrize(
    ("rule", "alter"),
    [
        ("period-short", lambda frames: [*frames, frame(4.03, 0x201, bytes(8))]),
        ("period-gap", lambda frames: without(frames, 0x201, 4.0, 4.15)),
        ("node-awake", lambda frames: without(frames, 0x201, 4.0, 14.0)),
        ("message-missing", lambda frames: without(frames, 0x102, 0.0, 20.0)),
        (
            "counter-sequence",
            with_status(lambda place, data: status(3, 500) if place == 84 else data),
        ),
        ("value-range", with_status(lambda place, data: status(data[1], 3001))),
        (
            "code-defined",
            lambda frames: [
                *without(frames, 0x201, 4.0, 4.05),
                frame(4.0, 0x201, bytes([2, *bytes(7)])),
            ],
        ),
        (
            "frame-kind",
            lambda frames: [*frames, frame(4.05, 0x201, b"", is_remote_frame=True)],
        ),
        ("frame-length", lambda frames: [*frames, frame(4.05, 0x201, bytes(7))]),
        (
            "unassigned-bits",
            lambda frames: [
                *without(frames, 0x201, 4.0, 4.05),
                frame(4.0, 0x201, b"\0\0\4" + bytes(5)),
            ],
        ),
        ("foreign-frames", lambda frames: [*frames, frame(4.0, 0x301, bytes(8))]),
        ("error-frames", lambda frames: [*frames, frame(4, 0, b"", is_error_frame=True)]),
    ],
)
def test_a_planted_fault_is_found_by_its_rule_and_by_no_other(
    second: Protocol, rule: str, alter: Callable[[Frames], Frames]
) -> None:
    assert broken(judged(second, alter(drive()))) == {rule}


def test_identifiers_without_addresses_are_no_j1939(second: Protocol) -> None:
    ids = {rule.id for rule in rules_for(second)}
    assert not ids & {"identifier-priority", "source-address"}


def test_a_database_file_alone_gives_rules(tmp_path: Path) -> None:
    path = tmp_path / "truck.dbc"
    path.write_text(DBC, "ascii")
    protocol = typed_protocol(read_dbc(path))
    reference = cantools.database.load_string(DBC, "dbc")
    assert isinstance(reference, Database)

    def engine(time: float, gear: int) -> can.Message:
        data = reference.encode_message("Engine", {"Engine_Speed": 800, "Engine_Gear": gear})
        return frame(time, 256, data)

    frames = [engine(tick / 50, tick // 100 % 3) for tick in range(500)]
    frames.append(
        can.Message(timestamp=5.0, arbitration_id=0x18FEF1FE, data=b"\1\0", channel="can0")
    )
    assert broken(judged(protocol, frames)) == set()
    wrong = [*frames[:300], engine(6.0, 7), *frames[301:]]
    judgement = judged(protocol, wrong)
    assert broken(judgement) == {"code-defined"}
    (found,) = judgement.result("code-defined").occurrences
    assert found.subject == ("ECU", "Engine", "Engine_Gear", "")
    assert found.says() == "code 7 has no meaning; defined are 0, 1, 2"
    assert judgement.load == ()  # the file states no bit rate
    for text in (to_json, to_junit, to_csv):
        assert "Engine_Gear" in text([judgement], "en")
    assert "truck" in to_html([judgement], [()], "en", {})


@pytest.mark.parametrize(
    ("frame", "texts"),
    [
        ("100##1{00}", []),
        ("101#0000000000000000", []),
        ("100#0000000000000000", ["a classical frame; it has to be a CAN FD frame"]),
        ("100#R", ["a remote frame; it has to be a CAN FD frame"]),
        ("101##1{00}", ["a CAN FD frame; it has to be a classical data frame"]),
    ],
)
def test_frames_have_the_format_of_their_message(
    tmp_path: Path, frame: str, texts: list[str]
) -> None:
    protocol = typed_protocol(read_dbc(FIXTURES / "cases" / "mixed.dbc"))
    log = candump(tmp_path / "fd.log", f"0 can0 {frame.replace('{00}', '00' * 8)}")
    result = judge_log(Judge(protocol), log).result("frame-kind")
    assert [each.says() for each in result.occurrences] == texts


def test_frames_of_can_fd_may_be_filled_up_and_no_longer(tmp_path: Path) -> None:
    model = read_dbc(FIXTURES / "cases" / "mixed.dbc")
    fd, classic = model.messages
    protocol = typed_protocol(replace(model, messages=(replace(fd, length=9), classic)))
    lines = (f"{size / 10} can0 100##1{'00' * size}" for size in (8, 12, 16))
    log = candump(tmp_path / "fd.log", *lines)
    result = judge_log(Judge(protocol), log).result("frame-length")
    assert [each.says() for each in result.occurrences] == [
        "8 bytes instead of 9",
        "16 bytes instead of 9",
    ]


def test_a_message_of_nobody_is_judged_all_the_same(tmp_path: Path) -> None:
    path = tmp_path / "nobody.dbc"
    path.write_text(
        DBC.replace("BU_: ECU Display", "BU_: Display").replace("8 ECU", "8 Vector__XXX")
    )
    protocol = typed_protocol(read_dbc(path))
    judgement = judged(protocol, [frame(tick / 50, 256, b"\0\0\7" + bytes(5)) for tick in range(9)])
    assert broken(judgement) == {"code-defined"}
    assert judgement.nodes == ("Display", "")


def test_a_protocol_without_messages_and_nodes_has_nobody_to_judge(tmp_path: Path) -> None:
    path = tmp_path / "empty.dbc"
    path.write_text('VERSION ""\nNS_ :\nBS_:\nBU_:\n')
    with pytest.raises(JudgeError, match="nobody to judge"):
        Judge(typed_protocol(read_dbc(path)))


def test_nothing_of_this_standard_is_needed(tmp_path: Path) -> None:
    path = tmp_path / "truck.dbc"
    path.write_text(DBC, "ascii")
    log = candump(tmp_path / "truck.log", *(f"{tick / 10} can0 100#200300" for tick in range(50)))
    program = (
        "import sys; sys.modules['swapcan'] = sys.modules['dbcspec'] = None\n"
        "from pathlib import Path\n"
        "from typedcan.databases.dbc import read_dbc\n"
        "from typedcan.judge import Judge, judge_log\n"
        "from typedcan.dynamic import typed_protocol\n"
        "judge = Judge(typed_protocol(read_dbc(Path(sys.argv[1]))))\n"
        "judgement = judge_log(judge, sys.argv[2])\n"
        "print(*(r.rule.id for r in judgement.results if r.count))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(path), str(log)],
        env={**os.environ, "PYTHONPATH": str(Path(typedcan.__file__).parents[1])},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stdout, done.stderr) == ("frame-length\n", "")


def test_frames_and_groups_that_a_spec_numbers_from_0_are_no_fault() -> None:
    protocol = rack()
    codec = Codec(protocol)
    names = split(protocol.transfer("name"), "架")
    heats = split(protocol.transfer("heats"), {0: [20.0] * 4, 1: [30.0] * 3, 2: [40.0] * 2})
    frames = [
        frame(cycle * period + n * period / len(messages), each.FRAME_ID, codec.encode(each))
        for period, messages in ((0.5, names), (0.25, heats))
        for cycle in range(round(20 / period))
        for n, each in enumerate(messages)
    ]
    found = {result.rule.id: result.count for result in judged(protocol, frames).results}
    assert found["code-defined"] == 0
    assert found["frame-numbers"] == 0
    beyond = frame(20.0, names[0].FRAME_ID, bytes([3, *bytes(7)]))
    [wrong] = [
        r for r in judged(protocol, [*frames, beyond]).results if r.rule.id == "code-defined"
    ]
    assert wrong.count == 1
