"""Judging messages that are found by their PGN: those of their sender, from whatever identifier."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import can
import pytest
from rules.recorded import block_of

from typedcan.databases.dbc import read_dbc
from typedcan.dynamic import typed_protocol
from typedcan.judge import Judge, Judgement
from typedcan.model.protection import Counter
from typedcan.model.protocol import SendType

GROUPS = read_dbc(Path(__file__).parents[1] / "fixtures" / "databases" / "groups.dbc")


def judged(frames: list[can.Message], *, addresses: bool = True) -> Judgement:
    """What is found of Fault, which Brake sends every second, counting; from 0x0B, or any."""
    (group,) = (each for each in GROUPS.messages if each.name == "Fault")
    sent = dataclasses.replace(
        group,
        frame_id=0x18FEC2FE,
        period=1000,
        send_type=SendType.CYCLIC,
        counter=Counter(signal="FaultCode", modulus=256),
    )
    model = dataclasses.replace(GROUPS, messages=(sent,))
    if not addresses:
        model = dataclasses.replace(
            model, nodes=tuple(dataclasses.replace(node, address=None) for node in model.nodes)
        )
    judge = Judge(typed_protocol(model))
    for start in range(0, len(frames), 7):
        judge.feed(block_of(frames[start : start + 7]))
    return judge.finish()


def frames(source: int, begin: float = 0.0, count: int = 20, length: int = 8) -> list[can.Message]:
    return [
        can.Message(
            timestamp=1000.0 + begin + number,
            arbitration_id=0x18FEC200 | source,
            data=bytes((number, *[0] * (length - 1))),
            channel="can0",
        )
        for number in range(count)
    ]


def found(judgement: Judgement) -> dict[str, int]:
    return {result.rule.id: result.count for result in judgement.results if result.count}


def together(*several: list[can.Message]) -> list[can.Message]:
    return sorted((each for frames in several for each in frames), key=lambda each: each.timestamp)


def test_others_that_send_the_same_pgn_are_neither_judged_nor_foreign() -> None:
    others = frames(0x21, -0.3), frames(0x22, 0.31, 7)  # one before the sender
    judgement = judged(together(frames(0x0B), *others))
    assert found(judgement) == {}
    assert judgement.frames["Fault"] == 20


@pytest.mark.parametrize("addresses", [True, False])
def test_the_sender_is_judged_whatever_others_send(addresses: bool) -> None:  # noqa: FBT001
    """Without an address in the database the sender is who comes first."""
    own = [*frames(0x0B)[:7], *frames(0x0B)[8:]]
    judgement = judged(together(own, frames(0x21, 0.3)), addresses=addresses)
    assert found(judgement) == {"counter-sequence": 1, "period-gap": 1}
    assert judgement.frames["Fault"] == 19


def test_a_frame_that_is_too_short_is_told_as_one_of_the_message() -> None:
    judgement = judged(together(frames(0x0B), frames(0x0B, 20.0, 1, length=7)))
    assert found(judgement)["frame-length"] == 1
    assert "foreign-frames" not in found(judgement)


def test_other_identifiers_are_foreign_still() -> None:
    other = [
        can.Message(timestamp=1000.5, arbitration_id=0x18FEC30B, data=bytes(8), channel="can0")
    ]
    assert found(judged(together(frames(0x0B), other))) == {"foreign-frames": 1}
